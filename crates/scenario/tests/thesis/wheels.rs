//! 3.1: Hilare robots that are driven by the torques of their wheels.

use super::{refusal, run_scenario, scenario_with};
use trench_scenario::{Sample, Scenario, Summary};

const FILE: &str = "3.1_wheels.yaml";
const ROBOTS: usize = 4;
/// Cases of the file.
const POINT: usize = 0;
const STRONG: usize = 1;
const WEAK: usize = 2;
const COMMANDED: usize = 3;
/// N m of the weak motors.
const MOST: f64 = 0.6;

fn run(scenario: &Scenario) -> (Summary, Vec<Vec<Sample>>) {
    let times: Vec<f64> = (1..=40).map(|half| 0.5 * f64::from(half)).collect();
    run_scenario(scenario, &times)
}

/// How far the hands of a case are from the double integrators at most, places and velocities.
fn largest(kept: &[Vec<Sample>], case: usize) -> f64 {
    let of = |samples: &Vec<Sample>, robot: usize| {
        let (point, hand) = (&samples[ROBOTS * POINT + robot], &samples[ROBOTS * case + robot]);
        (hand.position - point.position).norm().max((hand.velocity - point.velocity).norm())
    };
    kept.iter().flat_map(|samples| (0..ROBOTS).map(move |robot| of(samples, robot))).fold(0.0, f64::max)
}

/// As long as no motor saturates, the wheels make the hand a double integrator: up to the error of RK4, which halving the step divides by
/// sixteen.
#[test]
fn unsaturated_wheels_make_the_hand_a_double_integrator() {
    let at = |step: &str| {
        let (summary, kept) = run(&scenario_with(FILE, &[("step: 0.002 ", &format!("step: {step} "))]));
        for robot in &summary.cases[STRONG].robots {
            let wheels = robot.wheels.unwrap();
            assert!(wheels.saturated == 0.0 && wheels.greatest_torque > MOST, "{robot:?}");
        }
        assert!(summary.cases[POINT].robots.iter().all(|robot| robot.wheels.is_none()));
        largest(&kept, STRONG)
    };
    let [coarse, fine, shipped] = ["0.01", "0.005", "0.002"].map(at);
    assert!((10.0..26.0).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!(shipped < 1e-6, "{shipped}");
}

/// Weak motors saturate at the start, so their robots go elsewhere than the double integrators, and come to the same in the end.
#[test]
fn weak_motors_saturate_and_arrive_all_the_same() {
    let (summary, kept) = run(&scenario_with(FILE, &[]));
    let weak = &summary.cases[WEAK].robots;
    assert!(weak.iter().any(|robot| robot.wheels.unwrap().saturated > 0.05), "{weak:?}");
    assert!(largest(&kept, WEAK) > 0.1, "saturation is to be seen");
    assert!(weak.iter().all(|robot| robot.error < 0.01 && robot.wheels.unwrap().saturated < 5.0), "{weak:?}");
}

/// A robot that takes velocities, and is given the wheel speeds that the same motors would bring about each step, goes the same way: up to an
/// error of order two, which is that of the ramp between two commands.
#[test]
fn a_robot_that_takes_velocities_goes_the_way_of_its_motors() {
    let apart = |step: &str| {
        let changes = [("step: 0.002 ", &*format!("step: {step} ")), ("method: rk4 ", "method: exact ")];
        let (summary, kept) = run(&scenario_with(FILE, &changes));
        let of = |samples: &Vec<Sample>, robot: usize| {
            let (torques, speeds) = (&samples[ROBOTS * WEAK + robot], &samples[ROBOTS * COMMANDED + robot]);
            (torques.position - speeds.position).norm()
        };
        assert!(summary.cases[COMMANDED].robots.iter().all(|robot| robot.error < 0.01), "{summary:?}");
        let all = kept.iter().flat_map(|samples| (0..ROBOTS).map(move |robot| of(samples, robot)));
        all.fold(0.0, f64::max)
    };
    let [coarse, fine] = ["0.01", "0.005"].map(apart);
    assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!(fine < 0.01, "{fine}");
}

/// Motors that just have what was asked for never saturate, and the run is that without a bound, bit for bit.
#[test]
fn torque_to_spare_changes_nothing() {
    let (summary, strong) = run(&scenario_with(FILE, &[]));
    let wanted = summary.cases[STRONG].robots.iter().map(|robot| robot.wheels.unwrap().greatest_torque);
    let more = 1.01 * wanted.fold(0.0, f64::max);
    let (_, enough) = run(&scenario_with(FILE, &[("wheel_torque: 20.0", &format!("wheel_torque: {more}"))]));
    let hands = |kept: &[Vec<Sample>]| {
        let places = kept.iter().flat_map(|samples| samples[ROBOTS * STRONG..ROBOTS * WEAK].to_vec());
        places.flat_map(|sample| [sample.position.x.to_bits(), sample.position.y.to_bits()]).collect::<Vec<u64>>()
    };
    assert_eq!(hands(&strong), hands(&enough));
}

#[test]
fn wheels_that_are_none_are_refused() {
    for (old, new, expected) in [
        ("wheel_torque: 0.6}", "wheel_torque: 0.0}", "plant.wheel_torque"),
        ("half_track: 0.15,", "half_track: -0.15,", "plant.half_track"),
        ("wheel_radius: 0.05,", "wheel_radius: 0.0,", "plant.wheel_radius"),
        ("wheel_radius: 0.05,", "", "wheel_radius"),
        ("kind: wheels", "kind: hilare", "half_track"),
    ] {
        let error = refusal(FILE, old, new);
        assert!(error.contains(expected), "{error}");
    }
}
