//! How much damping a chain among obstacles needs (7.10, docs/theory/chapter7.md).
use super::{assert_near, run, run_scenario, scenario_with};

/// k = 3 keeps the chain of 7.10 off the poles of the discs, 1 m from their edges, but not out of zone 1, which begins at 1 m.
#[test]
fn three_is_too_little_among_obstacles() {
    for (name, closest, in_zone_1, nearest) in [
        ("7.10_obstacles.yaml", 0.558, 0.015, 1.133),
        ("7.10_camera_rate.yaml", 0.498, 0.013, 1.130),
        ("7.10_fragments.yaml", 0.545, 0.014, 1.133),
    ] {
        let case = run_scenario(&scenario_with(name, &[("damping: 5.0 ", "damping: 3.0 ")]), &[]).0.cases.remove(0);
        assert_near(case.closest_pair, &[closest], 1e-3);
        assert_near([case.in_zone_1.unwrap()], &[in_zone_1], 1e-6);
        let gap = case.obstacles.iter().map(|obstacle| obstacle.least_gap).fold(f64::INFINITY, f64::min);
        assert_near([gap], &[nearest], 0.001);
    }
}

/// k = 5 does.
#[test]
fn five_keeps_everybody_out_of_zone_1() {
    for name in ["7.10_obstacles.yaml", "7.10_camera_rate.yaml", "7.10_fragments.yaml"] {
        let case = run(name);
        assert!(
            case.in_zone_1 == Some(0.0) && case.closest_pair.is_some_and(|closest| closest > 3.5),
            "{name}: {case:?}"
        );
    }
}
