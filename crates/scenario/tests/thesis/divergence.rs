//! Runs that diverge are said to, with the moment and the robot.
use super::scenario_with;
use trench_scenario::{DivergedSummary, Measures, Simulation};

/// Runs a changed file until it diverges.
fn diverged(name: &str, changes: &[(&str, &str)]) -> Option<DivergedSummary> {
    let file = scenario_with(name, changes);
    let (mut simulation, mut measures, mut samples) =
        (Simulation::new(&file).unwrap(), Measures::new(&file), Vec::new());
    for _ in 0..(file.timing.duration / file.timing.step).round() as u64 {
        simulation.step().unwrap();
        simulation.sample(true, &mut samples).unwrap();
        measures.take(&file, &simulation, &samples);
        if measures.diverged().is_some() {
            break;
        }
    }
    let summary = measures.summary(&file, &samples);
    assert_eq!(summary.diverged.as_ref(), measures.diverged());
    summary.diverged
}

#[test]
fn steps_that_are_too_coarse_are_told() {
    for (name, changes) in [
        (
            "8.4_queue.yaml",
            &[
                ("step: 0.01 ", "step: 1.0 "),
                ("record_every: 0.05 ", "record_every: 1.0 "),
                ("[-1.0, -2.0]", "[-8.0, -12.0]"),
            ][..],
        ),
        ("4.4.4.yaml", &[("step: 0.001 ", "step: 0.5 "), ("record_every: 0.02 ", "record_every: 0.5 ")]),
        ("6.5.yaml", &[("step: 0.01 ", "step: 0.1 "), ("damping: 2.0 ", "damping: 100.0 ")]),
    ] {
        let told = diverged(name, changes).unwrap_or_else(|| panic!("{name} did not diverge"));
        assert!(told.time > 0.0 && told.distance > told.limit && told.limit >= 1000.0, "{name}: {told:?}");
        assert!(told.robot.starts_with('r') || told.robot.contains("_r"), "{told:?}");
    }
}

/// What only whips, or comes late, has not diverged.
#[test]
fn what_is_slow_or_rough_has_not_diverged() {
    for (name, changes) in
        [("4.4.4.yaml", &[][..]), ("5.6.yaml", &[]), ("9.1_bent_corridor.yaml", &[("duration: ", "duration: 5.0 # ")])]
    {
        assert_eq!(diverged(name, changes), None, "{name}");
    }
}
