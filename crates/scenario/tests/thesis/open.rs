//! 2.1: a queue that is open at one end, under (7.13).

use super::{folder, run_scenario, scenario};
use std::fs;
use trench_scenario::{CaseSummary, parse};

const FILE: &str = "7.13_open.yaml";

/// All stand on the extension, outside of the obstacles' repulsive areas, which end at 2 m and reach from 12.06 m to 15.94 m, and in no zone 2.
fn stands_on_the_extension(case: &CaseSummary) {
    let places: Vec<[f64; 2]> = case.robots.iter().map(|robot| robot.position).collect();
    for (robot, [x, y]) in case.robots.iter().zip(&places) {
        assert!(robot.error < 1e-3 && y.abs() < 1e-3 && *x > 2.0 - 1e-3, "{places:?}");
        assert!(!(12.07..15.93).contains(x), "{places:?}");
    }
    assert!(case.in_zone_1 == Some(0.0) && case.conforms_after.is_some(), "{case:?}");
}

#[test]
fn a_team_comes_to_the_extension_of_an_open_queue() {
    stands_on_the_extension(&run_scenario(&scenario(FILE), &[]).0.cases[0]);
}

/// The same where the obstacle covers all that is of finite length: nothing else is left for the team, and the file is no mistake.
#[test]
fn obstacles_may_cover_the_finite_part_of_an_open_queue() {
    let text = fs::read_to_string(folder().join(FILE)).unwrap();
    let covered = text.replace("[-40.0, 0.0]", "[-20.0, 0.0]");
    stands_on_the_extension(&run_scenario(&parse(FILE, &covered).unwrap(), &[]).0.cases[0]);
    let error = parse(FILE, &covered.replace(", open_end: true", "")).unwrap_err().to_string();
    assert!(error.contains("cover the whole segment"), "{error}");
}
