//! Remark 6.4.1 where Phi and Psi cancel: local minima of (6.1) without obstacles.

use super::{refusal, run, run_scenario, scenario_with};

const FILE: &str = "6.4.1_cancellation.yaml";
const REMEDIES: &str = "remedies:";

/// Everybody comes to the segment, out of all zones 2, into the neutral zone of its leader.
#[test]
fn who_rests_where_trench_and_zones_cancel_gets_on() {
    let case = run(FILE);
    assert!(case.conforms_after.is_some_and(|time| time < 45.0), "{case:?}");
    assert!(case.neutral_after.is_some_and(|time| time < 45.0), "{case:?}");
    assert!(case.in_zone_1 == Some(0.0) && case.closest_pair.unwrap() > 1.5, "{case:?}");
    for (index, robot) in case.robots.iter().enumerate() {
        for other in &case.robots[..index] {
            assert!((robot.position[0] - other.position[0]).abs() > 3.9, "{case:?}");
        }
    }
}

/// Without remedies r3 conforms between r1 and r2, 3 m from each, in zone 2 of both for good: what 6.4 calls a local minimum.
#[test]
fn without_remedies_it_rests_there() {
    let without = [(REMEDIES, "# "), ("  {radius: 0.1", "# {radius: 0.1"), ("semi_implicit_euler", "rk4")];
    let (summary, _) = run_scenario(&scenario_with(FILE, &without), &[]);
    let case = &summary.cases[0];
    let third = &case.robots[2];
    assert!((third.position[0] - 3.0).abs() < 1e-3 && third.position[1].abs() < 1e-6, "{third:?}");
    assert!(case.neutral_after.is_none() && case.conforms_after.is_some(), "{case:?}");
}

/// Two robots head-on: a push straight against the attraction is turned aside under (6.1), too, of a leader as of others.
#[test]
fn pushes_of_robots_ahead_are_turned_aside_under_6_1() {
    let two = [
        (REMEDIES, "sidesteps: true # "),
        ("  {radius: 0.1", "# {radius: 0.1"),
        ("- {position: [6.0, 0.0]}\n- {position: [2.8, 6.0]}\n- {position: [0.0, 10.0]}", "- {position: [0.0, 7.0]}"),
    ];
    let (summary, _) = run_scenario(&scenario_with(FILE, &two), &[]);
    assert!(summary.cases[0].conforms_after.is_some_and(|time| time < 10.0), "{summary:?}");
    let (stuck, _) = run_scenario(&scenario_with(FILE, &[two[0], two[1], two[2], ("sidesteps: true", "# ")]), &[]);
    assert!(stuck.cases[0].robots[1].error > 1.0, "{stuck:?}");
}

/// The controllers' core gives what (6.1) alone gives, to rounding.
#[test]
fn the_core_simulates_6_5_alike() {
    let euler = ("method: rk4", "method: semi_implicit_euler");
    let run = |changes: &[(&str, &str)]| run_scenario(&scenario_with("6.5.yaml", changes), &[]).0.cases.remove(0);
    let (plain, core) = (run(&[euler]), run(&[euler, ("damping: 2.0 ", "sidesteps: false\ndamping: 2.0 ")]));
    for (one, other) in plain.robots.iter().zip(&core.robots) {
        let far = (one.position[0] - other.position[0]).hypot(one.position[1] - other.position[1]);
        assert!(far < 1e-9, "{one:?} {other:?}");
    }
    assert_eq!(plain.neutral_after, core.neutral_after);
}

#[test]
fn robots_that_remember_do_not_suit_rk4() {
    let error = refusal(FILE, "semi_implicit_euler", "rk4");
    assert!(error.contains("method = rk4") && error.contains("write semi_implicit_euler"), "{error}");
}

/// Two obstacles before the segment, for one robot between them that the pull of its trench does not bring through.
fn before_a_gap(obstacles: &str, duration: f64) -> trench_scenario::CaseSummary {
    let text = format!(
        "name: gap
kind: nearest_points
duration: {duration}
step: 0.002
method: semi_implicit_euler
record_every: 0.1
segment: {{kind: line, points: [[0.0, 0.0], [40.0, 0.0]]}}
trench: {{kind: hyperbolic, alpha: 10.0, a: 1.0}}
damping: 5.0
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2}}
clearance: 2.0
obstacle_potential: {{pole: 1.0, cut: 2.0, strength: 10.0, m: 2, edge: jump}}
encroaching: obstacles
obstacles: {obstacles}
remedies: {{radius: 0.1, patience: 1.0, arrived: 0.05, rising: 0.5}}
sidesteps: true
robots: [{{position: [20.2, 14.0]}}]
"
    );
    let scenario = trench_scenario::parse("gap.yaml", &text).unwrap();
    run_scenario(&scenario, &[]).0.cases.remove(0)
}

/// A gap that bodies pass and the repulsion on both sides does not let pass: the robot goes round, of discs at once, of long walls by their ends.
#[test]
fn who_cannot_pass_a_gap_goes_round() {
    let discs = "[{disc: [17.75, 6.0], radius: 1.0}, {disc: [22.25, 6.0], radius: 1.0}]";
    let case = before_a_gap(discs, 60.0);
    assert!(case.conforms_after.is_some(), "{case:?}");
    for gap in [2.1, 3.0] {
        let (left, right) = (20.0 - 0.5 * gap, 20.0 + 0.5 * gap);
        let walls = format!(
            "[{{polygon: [[0.0, 3.0], [{left}, 3.0], [{left}, 5.0], [0.0, 5.0]]}}, {{polygon: [[{right}, 3.0], [40.0, 3.0], [40.0, 5.0], [{right}, 5.0]]}}]"
        );
        let case = before_a_gap(&walls, 130.0);
        assert!(case.conforms_after.is_some(), "{gap}: {case:?}");
        assert!(case.obstacles.iter().all(|obstacle| obstacle.least_gap > 1.5), "{gap}: {case:?}");
    }
}
