//! What the thesis's algorithm does beyond the printed runs: 7.10 by all steps of 7.5.2 and at the rate of a camera, Remark 6.4.1.
use crate::{Measures, Sample, Simulation, assert_near, leader_distances, run, scenario};
use trench_formation::Vector2;
use trench_scenario::{CaseSummary, Task};

/// Where the robots of 7.10 with obstacles come to rest on the whole segment; r3, on fragments, 8 mm farther at the end of its own, and all behind it.
const PLACES: [f64; 10] = [100.0, 92.940, 86.872, 79.811, 72.751, 65.690, 58.630, 51.569, 44.509, 37.448];

/// Of r2 within its four walls, m.
const START: Vector2<f64> = Vector2::new(1.5, 1.2);

/// Nobody in zone 1 or nearer than rho_underbar to an obstacle, everybody on the segment in the neutral zone of its leader.
fn assert_formed(case: &CaseSummary) {
    assert_near(case.robots.iter().map(|robot| robot.position[0]), &PLACES, 0.02);
    assert!(case.in_zone_1 == Some(0.0) && case.closest_pair.is_some_and(|apart| apart > 3.5), "{case:?}");
    assert!(case.obstacles.iter().all(|obstacle| obstacle.least_gap > 1.0), "{case:?}");
    assert!(case.robots.iter().all(|robot| robot.error < 1e-6), "{case:?}");
    assert!(leader_distances(case).iter().all(|distance| (4.0..=10.0).contains(distance)), "{case:?}");
    assert!(case.conforms_after.is_some() && case.neutral_after.is_some_and(|since| since < 130.0), "{case:?}");
}

/// Steps (1) to (3) in full: obstacles and robots ahead leave fragments, on which every robot comes to rest.
#[test]
fn chain_of_7_10_on_fragments() {
    let file = scenario("7.10_fragments.yaml");
    let mut simulation = Simulation::new(&file).unwrap();
    let (mut measures, mut samples) = (Measures::new(&file), Vec::<Sample>::new());
    for _ in 0..(file.timing.duration / file.timing.step).round() as u64 {
        simulation.step().unwrap();
        simulation.sample(false, &mut samples).unwrap();
        measures.take(&file, &simulation, &samples);
    }
    assert_formed(&measures.summary(&file, &samples).cases[0]);
    // Nothing of the discs' repulsion reaches what draws anybody: 2 m from each outline, 3 m from its centre.
    let Task::Nearest(task, _) = &file.task else { panic!("{file:?}") };
    for sample in &samples {
        let gap = |goal| task.obstacles.iter().map(move |disc| disc.shape.outline().approach(goal).gap);
        assert!(gap(sample.goal.unwrap()).all(|gap| gap > task.potential.cut() - 1e-6), "{sample:?}");
    }
}

/// Invariant 10: known states up to 33 ms old, steps of 1 ms.
#[test]
fn chain_of_7_10_at_camera_rate() {
    assert_formed(&run("7.10_camera_rate.yaml"));
}

/// Remark 6.4.1: the trench is off while the robot is held and has no way out, and comes back with the way.
#[test]
fn recovery_of_6_4_1() {
    let file = scenario("6.4.1_recovery.yaml");
    let mut simulation = Simulation::new(&file).unwrap();
    let (mut samples, mut off, mut fastest) = (Vec::new(), Vec::new(), 0.0_f64);
    for _ in 0..(file.timing.duration / file.timing.step).round() as u64 {
        simulation.step().unwrap();
        simulation.sample(false, &mut samples).unwrap();
        if samples[1].goal.is_none() {
            off.push(simulation.time());
            // Nothing but damping and the walls, which are far: it stands.
            assert!((samples[1].position - START).norm() < 0.01, "{samples:?}");
        }
        fastest = fastest.max(samples[1].velocity.norm());
    }
    assert!(off.len() > 1000 && off.iter().all(|time| *time < 3.0), "{} ms, last at {:?} s", off.len(), off.last());
    // It is led out, not thrown: pull over damping is 0.4 m/s.
    assert!(fastest < 0.5, "{fastest}");
    let case = run("6.4.1_recovery.yaml");
    assert!(case.robots[1].error < 1e-3 && case.robots[1].position[0] > 6.0, "{case:?}");
    assert!(case.obstacles.iter().all(|wall| wall.least_gap > 0.5) && case.in_zone_1 == Some(0.0), "{case:?}");
}
