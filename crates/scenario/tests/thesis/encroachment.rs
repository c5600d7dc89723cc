//! Walls that lie along the segment at the reach of their repulsion: round numbers, at which searches by halving would hang.
use super::{folder, scenario_with};
use trench_scenario::{Measures, Scenario, Simulation, parse};

/// Runs for some steps; whether something of the segment was left for all robots all the time.
fn stays_free(file: &Scenario, steps: u32) -> bool {
    let (mut simulation, mut measures, mut samples) = (Simulation::new(file).unwrap(), Measures::new(file), Vec::new());
    for _ in 0..steps {
        simulation.step().unwrap();
        simulation.sample(true, &mut samples).unwrap();
        measures.take(file, &simulation, &samples);
    }
    measures
        .summary(file, &samples)
        .cases
        .iter()
        .flat_map(|case| &case.robots)
        .all(|robot| robot.no_fragment_since.is_none())
}

/// Fig. 7.11 with the lower face at y = 1.0, where the cut is 1.0 and the segment y = 0, and a little off it.
#[test]
fn faces_at_the_reach_leave_the_segment() {
    for face in ["1.0", "1.000001", "0.999999", "1.000000001", "0.999999999"] {
        let corners = format!("[-3.0, {face}], [3.0, {face}]");
        let file = scenario_with("7.11.yaml", &[("[-3.0, 2.0], [3.0, 2.0]", &corners)]);
        assert!(stays_free(&file, 50), "{face}");
    }
}

/// At the scale of the test bed, with a wall that moves along itself at the reach and is looked at anew each tick.
#[test]
fn a_wall_that_moves_along_the_segment_at_the_reach() {
    let text = "name: bed\nkind: nearest_points\nduration: 10.0\nstep: 0.001\nmethod: semi_implicit_euler\nrecord_every: 0.05\n\
        steps_per_tick: 33\nsegment: {kind: line, points: [[0.3, 0.5], [2.3, 0.5]]}\n\
        trench: {kind: hyperbolic, alpha: 0.5, a: 0.2}\ndamping: 2.0\n\
        zoning: {rho_underbar: 0.2, rho_hat: 0.26, rho: 0.34, rho_check: 0.45, rho_bar: 1.2, alpha: 0.001, beta: 0.002, m: 2, \
        full_acceleration: 0.6}\nobstacles:\n\
        - {polygon: [[1.0, 0.76], [1.3, 0.76], [1.3, 1.0], [1.0, 1.0]], velocity: [0.001, 0.0]}\nclearance: 0.3\n\
        obstacle_potential: {pole: 0.14, cut: 0.26, strength: 0.002, m: 2, full_acceleration: 0.6}\n\
        encroaching: obstacles\nrobots:\n- {position: [0.6, 0.9]}\n";
    let name = folder().join("bed.yaml").display().to_string();
    assert!(stays_free(&parse(&name, text).unwrap(), 10_000));
}
