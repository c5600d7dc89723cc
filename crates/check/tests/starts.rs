//! Where robots of scenarios begin, and how fast.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
use trench_check::{Verdict, scenario};

/// The verdicts of a check on a scenario file.
fn judged(text: &str, check: &str) -> Vec<Verdict> {
    let verdicts = scenario("it", &trench_scenario::parse("it.yaml", text).unwrap());
    verdicts.into_iter().filter(|verdict| verdict.check == check).collect()
}

/// A shipped scenario with parts of its text replaced.
fn shipped(name: &str, replaced: &[(&str, &str)]) -> String {
    let path = format!("{}/../../config/scenarios/{name}", env!("CARGO_MANIFEST_DIR"));
    replaced.iter().fold(std::fs::read_to_string(path).unwrap(), |text, (old, new)| {
        assert!(text.contains(old), "{old:?} must stand in {name}");
        text.replace(old, new)
    })
}

/// The one verdict of a check: whether it holds, whether it is a note, and parts of what was found.
fn check(text: &str, name: &str, (holds, note): (bool, bool), parts: &[&str]) {
    let [verdict] = &judged(text, name)[..] else { panic!("{:#?}", judged(text, name)) };
    assert_eq!((verdict.holds, verdict.note), (holds, note), "{verdict:#?}");
    for part in parts {
        assert!(verdict.finding.contains(part), "{part:?} in {verdict:#?}");
    }
}

/// r10 of Table 6.1, and where it is 15.27 m from its leader.
const NEAR: &str = "{position: [0.7206, -1.0582], velocity: [0.6721, -0.6983]}";
const FAR: &str = "{position: [-9.0, -8.0], velocity: [0, 0]}";
const FULL: &str = "full_acceleration: 1.0e+4";

/// As chains were run (docs/check.md): with full acceleration they whip, with forces like the trench's they do not.
#[test]
fn followers_that_zone_5_draws() {
    let begins = "r10 begins 15.27 m from its leader r9, beyond rho_check = 13 m";
    let remedies =
        "begin within 12.69 m, or make rho and rho_check 2.578 m larger, or make zoning.full_acceleration 66.3";
    assert_eq!(judged(&shipped("7.10.yaml", &[]), "starts"), []);
    check(
        &shipped("7.10.yaml", &[(NEAR, FAR)]),
        "starts",
        (false, false),
        &[begins, "makes it 216.2 m/s fast", remedies],
    );
    // Law (6.1).
    assert_eq!(judged(&shipped("6.5.yaml", &[]), "starts"), []);
    let beside = shipped("6.5.yaml", &[(NEAR, "{position: [-4.0, 16.0]}")]);
    check(&beside, "starts", (false, false), &["r10 begins 14.06 m from its leader r9"]);
    let bounded = |full: &str| {
        let full = format!("full_acceleration: {full}");
        shipped("7.10.yaml", &[(NEAR, FAR), (FULL, &full)])
    };
    // The trench pulls with 10 m/s^2.
    for full in ["10.1", "20.0", "50.0", "66.3"] {
        check(&bounded(full), "starts", (true, false), &["outside of zone 2"]);
    }
    check(&bounded("100.0"), "starts", (true, true), &["bounces", "in zone 2", "some whipped"]);
    check(&bounded("500.0"), "starts", (false, false), &["through zone 2"]);
}

/// Beside the pole zone 4 draws as hard; limits bound what it makes of a robot.
#[test]
fn followers_beside_the_pole_and_within_limits() {
    let at = |x: f64, besides: &str| {
        format!(
            "\
name: two
kind: nearest_points
duration: 1.0
step: 0.001
method: semi_implicit_euler
segment: {{kind: line, points: [[0, 0], [40, 0]]}}
trench: {{kind: hyperbolic, alpha: 10.0, a: 1.0}}
damping: 5.0
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2}}
obstacle_potential: {{pole: 1.0, cut: 2.0, strength: 10.0, m: 2}}
{besides}robots:
- {{position: [3, 4]}}
- {{position: [{x}, 4]}}
"
        )
    };
    assert_eq!(judged(&at(15.5, ""), "starts"), []);
    check(&at(15.99, ""), "starts", (true, true), &["r2 begins 12.99 m from its leader r1, close to the pole"]);
    check(&at(17.0, ""), "starts", (false, false), &["r2 begins 14 m"]);
    let limits = "limits: {speed: 4.0, acceleration: 20.0}\n";
    check(&at(17.0, limits), "starts", (true, false), &["limits.acceleration = 20 m/s^2", "makes it 4 m/s fast"]);
}
