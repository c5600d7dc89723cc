//! Scenario files as they are shipped, judged.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
use trench_check::{Verdict, scenario};

/// The verdicts on a shipped scenario with `old` replaced by `new`.
fn judged(name: &str, old: &str, new: &str) -> Vec<Verdict> {
    let text =
        std::fs::read_to_string(format!("{}/../../config/scenarios/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    assert!(text.contains(old), "{old:?} must stand in {name}");
    scenario(name, &trench_scenario::parse(name, &text.replace(old, new)).unwrap())
}

/// What fails of a scenario: the check and a part of what was found.
fn check(name: &str, old: &str, new: &str, expected: &[(&str, &str)]) {
    let verdicts = judged(name, old, new);
    let failed: Vec<&Verdict> = verdicts.iter().filter(|verdict| !verdict.holds).collect();
    assert_eq!(failed.len(), expected.len(), "{name}: {failed:#?}");
    for ((check, part), verdict) in expected.iter().zip(failed) {
        assert!(verdict.check == *check && verdict.finding.contains(part), "{name}: {verdict:#?}");
    }
}

#[test]
fn shipped_scenarios_hold() {
    for name in [
        "4.4.1_law_3.9.yaml",
        "4.4.4.yaml",
        "5.6.yaml",
        "6.5_k_5.yaml",
        "7.10.yaml",
        "7.10_obstacles.yaml",
        "7.11.yaml",
        "9.2_bounded.yaml",
    ] {
        check(name, "", "", &[]);
        assert!(!judged(name, "", "").is_empty(), "{name}");
    }
}

/// 4.4.3 is about gains outside of the stable zone, and the checker finds them.
#[test]
fn gains_out_of_the_zone() {
    check("4.4.3_case_one.yaml", "", "", &[("gains", "18.8")]);
    check("4.4.3_case_two.yaml", "", "", &[("gains", "24.8")]);
}

#[test]
fn chains_that_do_not_fit() {
    check("7.10.yaml", "[100.0, 100.0]]", "[5.0, 5.0]]", &[("room", "4 places, but there are 10 robots")]);
    check(
        "7.10.yaml",
        "{position: [0.7206, -1.0582]",
        "{position: [-30.0, -1.0582]",
        &[("connection", "r10 begins 31.79")],
    );
    check("7.10.yaml", "damping: 2.0", "damping: 1.0", &[("damping", "the chain whips")]);
    check(
        "9.2_bounded.yaml",
        "acceleration: 5.0}",
        "acceleration: 4.0}",
        &[("limits", "up to 5 m/s^2, but robots have 4")],
    );
    check(
        "9.2_bounded.yaml",
        "{body_radius: 0.5}",
        "{body_radius: 1.5}",
        &[("zones", "bodies touch at 3 m"), ("clearance", "robots are 3 m wide")],
    );
}
