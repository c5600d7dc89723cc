//! Remarks 6.2.1 and 8.4.1 for chains of chapters 6 and 7: rho_bar is where links end.

use super::{refusal, run, run_scenario, scenario_with};
use trench_scenario::CaseSummary;

const FILE: &str = "6.2.1_lost_chain.yaml";

fn changes(case: &CaseSummary) -> Vec<(&str, &str)> {
    case.changes.iter().map(|change| (&*change.robot, change.change)).collect()
}

/// r2 finds its leader, and the chain behind it comes along; r4 does so once more after its link was broken. Nobody touches anybody.
#[test]
fn a_chain_that_has_lost_its_leader_comes_to_it() {
    let case = run(FILE);
    assert_eq!(changes(&case), [("r2", "lost"), ("r2", "follows"), ("r4", "retargets"), ("r4", "follows")]);
    assert!(case.changes[0].time == 0.0 && (50.0..50.1).contains(&case.changes[2].time), "{:?}", case.changes);
    assert!(case.closest_pair.unwrap() > 0.7 && case.in_zone_1 == Some(0.0), "{case:?}");
    for robot in &case.robots[1..] {
        assert!(robot.error < 0.05 && robot.leader_distance.unwrap() < 10.05, "{robot:?}");
    }
}

/// Nothing draws a robot to a leader that it does not hear: it goes to its own point, as slowly as without a chain, whatever simulates it.
#[test]
fn beyond_rho_bar_nothing_draws() {
    let far = ("[26.0026, 29.7094], velocity: [0.0153, 0.0056]", "[-100.0, 129.7]");
    let core = [("method: rk4", "method: semi_implicit_euler"), ("damping: 2.0 ", "sidesteps: false\ndamping: 2.0 ")];
    for changed in [vec![far], vec![far, core[0], core[1]]] {
        let scenario = scenario_with("6.5.yaml", &changed);
        let (summary, kept) = run_scenario(&scenario, &[0.5, 1.0, 2.0, 4.0, 8.0]);
        let case = &summary.cases[0];
        assert_eq!(changes(case), [("r2", "lost")]);
        assert!(case.robots[1].leader_distance_range.unwrap()[0] > 30.0, "{:?}", case.robots[1]);
        assert!(case.closest_pair.unwrap() > 1.0, "{case:?}");
        // The trench pulls with 10 m/s^2 at most, and k = 2.
        assert!(kept.iter().flatten().all(|sample| sample.velocity.norm() < 6.0), "{kept:?}");
    }
}

/// Chains of chapter 7 do the same.
#[test]
fn chains_of_chapter_7_have_links_too() {
    let robots = "- {position: [26.0026, 29.7094], velocity: [0.0153, 0.0056]}";
    let far = (robots, "- {position: [90.0, 95.0]}");
    let recovery = ("team_goal:", "recovery: {speed: 3.0}\nteam_goal:");
    let lost = run_scenario(&scenario_with("7.10.yaml", &[far]), &[]).0.cases.remove(0);
    assert_eq!(changes(&lost), [("r2", "lost")]);
    assert!(lost.robots[1].leader_distance.unwrap() > 30.0, "{lost:?}");
    let scenario = scenario_with("7.10.yaml", &[far, recovery]);
    let found = run_scenario(&scenario, &[]).0.cases.remove(0);
    assert_eq!(changes(&found), [("r2", "lost"), ("r2", "follows")]);
    assert!(found.robots[1].leader_distance.unwrap() <= 10.0, "{found:?}");
}

/// A robot that does not hear its leader keeps clear of it as of everybody ahead: r2 goes to where r1 stands, and r4 to where r3 waits.
#[test]
fn who_is_not_heard_is_avoided() {
    let scenario = scenario_with(FILE, &[("{robot: r4, from: 50.0, to: 60.0}", "{robot: r2, from: 50.0, to: 70.0}")]);
    let case = run_scenario(&scenario, &[]).0.cases.remove(0);
    assert_eq!(changes(&case), [("r2", "lost"), ("r2", "follows"), ("r2", "retargets"), ("r2", "follows")]);
    assert!(case.closest_pair.unwrap() > 0.7 && case.in_zone_1 == Some(0.0), "{case:?}");
}

#[test]
fn what_is_no_recovery() {
    let error = refusal(FILE, "{speed: 1.5}", "{speed: 0.0}");
    assert!(error.contains("recovery.speed") && error.contains("not positive"), "{error}");
    let error = refusal(FILE, "robot: r4", "robot: r9");
    assert!(error.contains("broken_links[0].robot") && error.contains("is not in this scenario"), "{error}");
    let error = refusal("7.14.yaml", "clearance:", "recovery: {speed: 1.0}\nclearance:");
    assert!(error.contains("has no team goal to go to"), "{error}");
}
