//! Lyapunov functions along runs, as they are measured.
use super::{scenario, scenario_with};
use trench_scenario::{LyapunovSummary, Measures, RobotSummary, Scenario, Simulation};

/// By so much of its greatest value V may rise: where a robot crosses the edge of a zone, at which the force jumps, a step errs by a
/// thousandth of V or less.
const SLIGHT: f64 = 1e-3;

/// The robots of a run, or of one until it diverges.
fn along(file: &Scenario) -> Vec<RobotSummary> {
    let (mut simulation, mut measures, mut samples) = (Simulation::new(file).unwrap(), Measures::new(file), Vec::new());
    let steps = (file.timing.duration / file.timing.step).round() as u64;
    for step in 0..=steps {
        if step > 0 {
            simulation.step().unwrap();
        }
        simulation.sample(true, &mut samples).unwrap();
        measures.take(file, &simulation, &samples);
        if measures.diverged().is_some() {
            break;
        }
    }
    measures.summary(file, &samples).cases.into_iter().flat_map(|case| case.robots).collect()
}

fn falls(told: &LyapunovSummary) -> bool {
    told.greatest_rise <= SLIGHT * told.greatest && told.last < 0.5 * told.greatest
}

/// V of A.10, A.12 and A.18 along the runs of 5.6, 6.5 and 7.10: less what leaders, robots ahead and obstacles bring in it never rises, and
/// it ends far below where it was.
#[test]
fn lyapunov_functions_fall_along_runs() {
    for name in ["5.6.yaml", "6.5.yaml", "7.10.yaml", "7.10_obstacles.yaml"] {
        for robot in along(&scenario(name)) {
            let told = robot.lyapunov.unwrap();
            assert!(falls(&told), "{name}, {}: {told:?}", robot.name);
            assert!(told.greatest_rate_of_law <= 1e-9, "{name}, {}: {told:?}", robot.name);
        }
    }
}

/// Where steps are too coarse, or a chain whips, V rises, and that is seen: by the laws' own formula it falls all the time.
#[test]
fn a_lyapunov_function_that_rises_is_told() {
    for (name, changes, least) in [
        ("5.6.yaml", [("step: 0.002 ", "step: 2.0 "), ("record_every: 0.02 ", "record_every: 2.0 ")], 30),
        ("4.4.4.yaml", [("step: 0.001 ", "step: 0.5 "), ("record_every: 0.02 ", "record_every: 0.5 ")], 4),
        ("7.10_obstacles.yaml", [("damping: 5.0 ", "damping: 2.0 "), ("duration: ", "duration: ")], 6),
    ] {
        let told: Vec<LyapunovSummary> =
            along(&scenario_with(name, &changes)).iter().map(|robot| robot.lyapunov.unwrap()).collect();
        assert!(told.iter().all(|told| told.greatest_rate_of_law <= 1e-9), "{name}: {told:?}");
        let rising = told.iter().filter(|told| !falls(told) && told.greatest_rise > 10.0 * SLIGHT * told.greatest);
        assert!(rising.count() >= least, "{name}: {told:?}");
    }
}
