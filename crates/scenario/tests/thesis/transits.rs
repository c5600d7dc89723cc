//! Transits of nearest points along runs (Definition 7.2.1).

use super::run_scenario;
use trench_scenario::{Transits, parse};

/// A robot above y = x^2, which bends about (0, 1/2), that goes to the right.
fn transits(start: [f64; 2], motion: &str) -> Transits {
    let text = format!(
        "name: over a bend\nkind: nearest_points\nduration: 2.0\nstep: 0.001\nmethod: semi_implicit_euler\n\
         segment: {{kind: graph, expression: \"x^2\", from: -3.0, to: 3.0}}\n{motion}\
         trench: {{kind: hyperbolic, alpha: 0.05, a: 1.0}}\ndamping: 2.0\n\
         zoning: {{rho_underbar: 0.4, rho_hat: 1.0, rho: 3.0, rho_check: 6.0, rho_bar: 10.0, alpha: 0.2, beta: 0.05}}\n\
         obstacle_potential: {{pole: 0.2, cut: 0.5, strength: 0.1}}\n\
         robots:\n- {{position: {start:?}, velocity: [3.0, 0.0]}}\n"
    );
    let scenario = parse("bend.yaml", &text).unwrap();
    run_scenario(&scenario, &[]).0.cases[0].robots[0].transits.clone().unwrap()
}

/// Above the centre of curvature a robot that crosses the axis has a transit there, from one side of the parabola to the other; below it the
/// nearest point passes the vertex.
#[test]
fn a_robot_that_crosses_above_a_bend_has_one_transit() {
    let found = transits([-0.3, 2.0], "");
    assert_eq!((found.count, found.first.len()), (1, 1), "{found:?}");
    let transit = found.first[0];
    // v = 3 exp(-2 t): 0.3 m take 0.11 s, a little more with what draws it back.
    assert!(transit.place[0].abs() < 1e-6 && (1.8..2.1).contains(&transit.place[1]), "{transit:?}");
    assert!((0.1..0.13).contains(&transit.time), "{transit:?}");
    // Arc lengths lie evenly about the vertex, where half of the curve is: 9.747 m of x^2 from 0 to 3.
    let middle = 0.5 * (transit.from + transit.to);
    assert!(transit.to - transit.from > 2.0 && (middle - 9.747_088_758_608_555).abs() < 1e-6, "{transit:?} {middle}");
    assert_eq!(transits([-0.3, 0.3], "").count, 0);
}

/// The segment's own motion does not count: places are seen from its frame. There the robot stays on its side of the axis, and crosses in the map.
#[test]
fn a_segment_that_moves_on_takes_its_axis_along() {
    assert_eq!(transits([-0.3, 2.0], "segment_motion: {velocity: [3.5, 0.0]}\n").count, 0);
}
