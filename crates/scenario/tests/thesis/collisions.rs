//! Robots that obstacles do not stop are told, however thin the obstacle and however long a step's way.
use super::run_scenario;
use trench_scenario::{CaseSummary, parse};

/// A robot that is drawn to the origin far harder than anything repels it, by some metres a step, from `start`.
fn drawn(start: &str, obstacles: &str) -> CaseSummary {
    let text = format!(
        "{{name: t, kind: nearest_points, duration: 2.0, step: 0.01, method: semi_implicit_euler, tolerance: 0.05,
          segment: {{kind: line, points: [[-60.0, 0.0], [60.0, 0.0]]}},
          trench: {{kind: quadratic, alpha: 400.0}}, damping: 40.0,
          zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2}},
          obstacles: {obstacles}, clearance: 0.5, encroaching: nothing,
          obstacle_potential: {{pole: 0.01, cut: 0.02, strength: 1.0e-9, m: 2, edge: continuous, full_acceleration: 1.0e-3}},
          robots: [{{position: {start}}}]}}"
    );
    let file = parse("own.yaml", &text).unwrap_or_else(|error| panic!("{error}"));
    run_scenario(&file, &[]).0.cases.remove(0)
}

/// What is told of a case, and its least gaps.
fn told(case: &CaseSummary) -> (Vec<String>, Vec<f64>) {
    let collisions = case.collisions.iter().map(ToString::to_string).collect();
    (collisions, case.obstacles.iter().map(|obstacle| obstacle.least_gap).collect())
}

#[test]
fn a_wall_is_not_crossed_between_two_steps_unseen() {
    let case = drawn("[0.0, 50.0]", "[{walls: [[-5.0, 20.0], [5.0, 20.0]]}, {walls: [[5.0, 30.0], [9.0, 30.0]]}]");
    assert!(case.conforms_after.is_some(), "{case:?}");
    let (collisions, gaps) = told(&case);
    assert_eq!(collisions, ["r1 went through obstacle 1 at 0.100 s"]);
    // Abreast of the end of the second wall it is at no step.
    assert!(gaps[0] == 0.0 && (gaps[1] - 5.0).abs() < 1e-12, "{gaps:?}");
}

#[test]
fn obstacles_with_an_inside_are_gone_through_or_into() {
    let (collisions, gaps) = told(&drawn("[0.0, 50.0]", "[{disc: [0.0, 20.0], radius: 0.1}]"));
    assert_eq!((&*collisions, gaps), (&["r1 went through obstacle 1 at 0.100 s".to_owned()][..], vec![0.0]));
    let (collisions, gaps) = told(&drawn("[0.0, 50.0]", "[{disc: [0.0, 20.0], radius: 6.0}]"));
    assert_eq!(collisions, ["r1 went into obstacle 1 at 0.080 s"]);
    assert!(gaps[0] < -4.0 && gaps[0] > -6.0, "{gaps:?}");
}

#[test]
fn obstacles_go_over_robots() {
    for (obstacle, expected) in [
        ("{walls: [[-10.0, -5.0], [-10.0, 5.0]], velocity: [30.0, 0.0]}", "r1 went through obstacle 1 at 0.360 s"),
        ("{disc: [-10.0, 0.0], radius: 1.0, velocity: [30.0, 0.0]}", "r1 went into obstacle 1 at 0.330 s"),
        ("{disc: [-10.0, 0.0], radius: 0.1, velocity: [90.0, 0.0]}", "r1 went through obstacle 1 at 0.130 s"),
    ] {
        assert_eq!(told(&drawn("[0.3, 0.0]", &format!("[{obstacle}]"))).0, [expected], "{obstacle}");
    }
    let beside = told(&drawn("[0.3, 0.0]", "[{walls: [[-10.0, 0.5], [-10.0, 5.0]], velocity: [30.0, 0.0]}]"));
    assert!(beside.0.is_empty() && (beside.1[0] - 0.5).abs() < 1e-6, "{beside:?}");
}

#[test]
fn each_time_is_counted_and_the_first_is_told() {
    let case = drawn("[0.0, 50.0]", "[{walls: [[-5.0, 20.0], [5.0, 20.0]], velocity: [0.0, 30.0]}]");
    assert_eq!(told(&case).0, ["r1 went through obstacle 1 at 0.090 s"]);
    // The robot goes through the wall, and the wall then over the robot.
    let text = "[{walls: [[-5.0, 0.05], [5.0, 0.05]], velocity: [0.0, -0.04]}]";
    let case = drawn("[0.0, 50.0]", text);
    assert!(case.collisions.len() == 1 && case.collisions[0].times == 2, "{case:?}");
}
