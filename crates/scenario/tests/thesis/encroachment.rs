//! Walls that lie along the segment at the reach of their repulsion: round numbers, at which searches by halving would hang.
use super::{folder, run_scenario, scenario_with};
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

/// A circle of which obstacles leave 7 m about the point where it begins, where a robot needs 5 m: as on the same arc.
#[test]
fn a_fragment_across_the_beginning_of_a_circle_is_one() {
    let ends = ["{kind: circle, ", "{kind: arc, start_angle: -3.0, sweep: 6.0, "].map(|segment| {
        let text = format!(
            "{{name: t, kind: nearest_points, duration: 5.0, step: 0.002, method: semi_implicit_euler, tolerance: 0.05,
              segment: {segment} centre: [0.0, 0.0], radius: 10.0}}, trench: {{kind: hyperbolic, alpha: 10.0, a: 1.0}}, damping: 5.0,
              zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2,
                edge: continuous, full_acceleration: 1.0e+3}},
              obstacles: [{{polygon: [[-12.0, -12.0], [8.4, -12.0], [8.4, 12.0], [-12.0, 12.0]]}}], clearance: 1.0,
              obstacle_potential: {{pole: 0.0, cut: 1.0, strength: 10.0, m: 2, edge: continuous}}, encroaching: obstacles,
              seeking: {{room: 5.0, transit_margin: 0.01, settled_distance: 0.05, settled_speed: 0.05}},
              robots: [{{position: [14.0, 0.5]}}]}}"
        );
        let file = parse("own.yaml", &text).unwrap_or_else(|error| panic!("{error}"));
        let case = run_scenario(&file, &[]).0.cases.remove(0);
        assert_eq!((case.robots[0].no_fragment_since, case.conforms_after.is_some()), (None, true), "{case:?}");
        (case.conforms_after, case.robots[0].position.map(|along| (along * 1e9).round()))
    });
    assert_eq!(ends[0], ends[1]);
}
