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
    assert!(case.in_zone_1 == 0.0 && case.closest_pair.unwrap() > 1.5, "{case:?}");
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
