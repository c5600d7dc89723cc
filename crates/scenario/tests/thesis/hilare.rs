//! 3.1: Hilare robots under a law for double integrators, through T1 and T2.

use super::{refusal, run_scenario, run_with, scenario_with};
use trench_scenario::{Sample, Scenario};

const FILE: &str = "3.1_hilare.yaml";
const ROBOTS: usize = 4;

/// The largest distances of the hands of a case from the double integrators, of their places and velocities, seen every half second.
fn largest(scenario: &Scenario, case: usize) -> f64 {
    let times: Vec<f64> = (1..=24).map(|half| 0.5 * f64::from(half)).collect();
    let (_, kept) = run_scenario(scenario, &times);
    assert_eq!(kept.len(), times.len());
    let apart = |samples: &Vec<Sample>| {
        let of = |robot: usize| {
            let (point, hand) = (&samples[robot], &samples[ROBOTS * case + robot]);
            (hand.position - point.position).norm().max((hand.velocity - point.velocity).norm())
        };
        (0..ROBOTS).map(of).fold(0.0, f64::max)
    };
    kept.iter().map(apart).fold(0.0, f64::max)
}

/// (3.4): the hand is the double integrator, up to what the integration of either leaves: an error of order four, which halving the step
/// divides by sixteen, and which is below a micrometre at the file's step.
#[test]
fn hands_follow_the_double_integrator_within_the_integration_error() {
    for case in [1, 2] {
        let at = |step: &str| largest(&scenario_with(FILE, &[("step: 0.002 ", &format!("step: {step} "))]), case);
        let [coarse, fine] = ["0.01", "0.005"].map(at);
        assert!((10.0..26.0).contains(&(coarse / fine)), "case {case}: {coarse} {fine}");
        let shipped = at("0.002");
        assert!(shipped < 1e-6, "case {case}: {shipped}");
    }
}

/// As a robot's computer would do it: forces held for a step. The error is of order one, and halves with the step.
#[test]
fn held_forces_keep_hands_near_the_double_integrator() {
    let at = |step: &str| {
        let changes = [("step: 0.002 ", &*format!("step: {step} ")), ("method: rk4 ", "method: exact ")];
        largest(&scenario_with(FILE, &changes), 2)
    };
    let [coarse, fine] = [at("0.002"), at("0.001")];
    assert!((1.6..2.4).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!(fine < 0.05, "{fine}");
}

/// All converge as the double integrators do, and bodies come to look where their hands go: the internal dynamics (3.3) are stable for a
/// reference that moves forward.
#[test]
fn the_run_converges_as_that_of_double_integrators() {
    let (summary, kept) = run_with(FILE, &[0.0, 12.0]);
    let [point, printed, offset] = &summary.cases[..] else { panic!("{summary:?}") };
    for robot in 0..ROBOTS {
        let expected = &point.robots[robot];
        assert!(expected.error < 0.01, "{expected:?}");
        for case in [printed, offset] {
            let found = &case.robots[robot];
            assert!((found.error - expected.error).abs() < 1e-6, "{found:?} {expected:?}");
            let (when, wanted) = (found.conforms_after.unwrap(), expected.conforms_after.unwrap());
            assert!((when - wanted).abs() <= 0.002 + 1e-9, "{found:?} {expected:?}");
        }
    }
    let off = |sample: &Sample| {
        let (sine, cosine) = sample.heading.sin_cos();
        (cosine * sample.velocity.y - sine * sample.velocity.x)
            .atan2(cosine * sample.velocity.x + sine * sample.velocity.y)
            .abs()
    };
    // omega = |r'| sin(angle)/L: within a radian it follows the direction of the motion, which turns by up to 0.25 rad/s, with a lag of
    // L/|r'| = 0.2 s.
    assert!(kept[0][ROBOTS..].iter().any(|sample| off(sample) > 1.5), "some look elsewhere at the start");
    assert!(kept[1][ROBOTS..].iter().all(|sample| off(sample) < 0.25 * 0.2 * 1.5), "{:?}", kept[1]);
}

#[test]
fn bodies_that_are_none_are_refused() {
    for (old, new, expected) in [
        ("hand_offset: 0.2}                     #", "hand_offset: 0.0} #", "T1 has no inverse"),
        ("mass: 4.0, inertia: 0.05, hand", "mass: 0.0, inertia: 0.05, hand", "plant.mass"),
        ("{kind: hilare, mass: 4.0, inertia: 0.05, hand", "{kind: car, mass: 4.0, inertia: 0.05, hand", "car"),
    ] {
        let error = refusal(FILE, old, new);
        assert!(error.contains(expected), "{error}");
    }
}
