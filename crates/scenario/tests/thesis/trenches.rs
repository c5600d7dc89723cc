//! A.9: trenches that are made of their damping.

use super::{assert_near, refusal, run_scenario, run_with, scenario, scenario_with};
use trench_formation::Vector2;
use trench_formation::trench::{Damping, Trench};
use trench_scenario::{GoalLaw, Task};

const FILE: &str = "A.9_critical.yaml";

/// Components of r1 and r2 along the way on which they start from rest, of one case, at so many times.
fn components(case: usize, times: &[f64]) -> Vec<[f64; 2]> {
    let (_, kept) = run_with(FILE, times);
    let of = |samples: Vec<trench_scenario::Sample>| {
        let along = |index: usize, direction: [f64; 2]| {
            let sample = &samples[2 * case + index];
            (sample.position - sample.goal.unwrap()).dot(&Vector2::from(direction))
        };
        [along(0, [1.0, 0.0]), along(1, [0.0, -1.0])]
    };
    kept.into_iter().map(of).collect()
}

/// Corollary A.9.1: Phi = K^2/8 of the law's own damping, and no robot overshoots; with beta > alpha in the trench they do (errata of A.9).
#[test]
fn critically_damped_trenches_do_not_overshoot() {
    let times: Vec<f64> = (0..=800).map(|index| 0.05 * f64::from(index)).collect();
    for (case, overshoots) in [(0, false), (1, false), (2, false), (3, true), (4, true)] {
        let components = components(case, &times);
        assert_eq!(components.len(), times.len());
        for robot in 0..2 {
            let least = components.iter().map(|both| both[robot]).fold(f64::INFINITY, f64::min);
            assert_eq!(least < -1e-6, overshoots, "case {case}, r{}: {least}", robot + 1);
            assert_eq!(least < -1e-12, overshoots, "case {case}, r{}: {least}", robot + 1);
        }
        if !overshoots {
            assert!(components.windows(2).all(|pair| pair[1][0] < pair[0][0]), "case {case} turns back");
        }
        assert!(components.last().unwrap()[0].abs() < 0.2, "case {case} arrives");
    }
}

/// Example A.9.1 with C = 2 is x'' + 2 x' + x = 0: from rest x = x0 (1 + t) e^(-t).
#[test]
fn constant_damping_has_its_closed_form() {
    for (time, both) in [1.0_f64, 3.0, 6.0].iter().zip(components(0, &[1.0, 3.0, 6.0])) {
        let share = (1.0 + time) * (-time).exp();
        assert_near(both, &[2.0 * share, 0.5 * share], 1e-9);
    }
}

/// What stands in the file is Phi = K^2/8 and the law's damping, unless the law names another one.
#[test]
fn damping_in_and_potential_out() {
    let Task::GoalTracking(task) = scenario(FILE).task else { panic!("goal tracking") };
    for (index, case) in task.cases.iter().enumerate() {
        let GoalLaw::Trench(law) = &case.law else { panic!("a trench") };
        for x in [0.1, 0.7, 1.0, 2.5] {
            let share = if index < 3 { 1.0 } else { 1.5 };
            let (integral, k) = (share * law.damping.integral(x), share * law.damping.coefficient(x));
            assert!((law.trench.value(x) - 0.125 * integral * integral).abs() < 1e-12, "{}", case.name);
            assert!((law.trench.slope(x) - 0.25 * integral * k).abs() < 1e-12, "{}", case.name);
        }
    }
}

/// A damping that is written down, as a formula or a table, is as good as a built-in one, in the law and in its trench; and one that no example
/// of A.9 is, does not overshoot either.
#[test]
fn written_dampings_are_damped_critically_too() {
    let built_in = "{kind: trench, trench: {kind: critical, damping: {kind: hyperbolic, alpha: 2.0, a: 0.5}}}";
    let written = |damping: &str| format!("{{kind: trench, trench: {{kind: critical, damping: {damping}}}}}");
    let run = |law: &str| {
        let times: Vec<f64> = (0..=400).map(|index| 0.1 * f64::from(index)).collect();
        run_scenario(&scenario_with(FILE, &[(built_in, law)]), &times).1
    };
    let along = |samples: &Vec<trench_scenario::Sample>| samples[2].position.x - samples[2].goal.unwrap().x;
    let formula = run(&written("{kind: expression, coefficient: \"2*abs(x)/sqrt(x^2 + 0.25)\"}"));
    for (samples, expected) in formula.iter().zip(run(built_in)) {
        assert!((along(samples) - along(&expected)).abs() < 1e-9);
    }
    for damping in
        ["{kind: expression, coefficient: \"1 + exp(-x^2)\"}", "{kind: table, coefficient: [[0, 0.5], [1, 2], [3, 1]]}"]
    {
        let way: Vec<f64> = run(&written(damping)).iter().map(along).collect();
        assert!(way[0] == 2.0 && way.iter().all(|x| *x > -1e-9), "{damping}: {way:?}");
        assert!(way[way.len() - 1] < 0.2, "{damping}: {way:?}");
    }
}

#[test]
fn dampings_that_are_none_are_refused() {
    let check = |old: &str, new: &str, expected: &[&str]| {
        let error = refusal(FILE, old, new);
        assert!(expected.iter().all(|part| error.contains(part)), "{error}");
    };
    let constant = "damping: {kind: constant, coefficient: 2.0}}}";
    check(
        constant,
        "damping: {kind: constant, coefficient: 0.0}}}",
        &["A.9_critical.yaml:15", "coefficient", "above 0"],
    );
    check(constant, "damping: {kind: linear, coefficient: 2.0}}}", &["kind", "linear"]);
    check(constant, "damping: {kind: constant}}}", &["coefficient"]);
    let written = |coefficient: &str| format!("damping: {{kind: expression, coefficient: \"{coefficient}\"}}}}}}");
    check(constant, &written("x"), &["damping.coefficient", "must be positive but at 0 (Corollary A.9.1)"]);
    check(constant, &written("1/abs(x)"), &["damping.coefficient", "is not finite at x = 0"]);
    check(constant, &written("2 + sign(sqrt(2) - abs(x))"), &["trench", "a kink that points upward"]);
    let table = "damping: {kind: table, coefficient: [[0, 1], [2, 0]]}}}";
    check(constant, table, &["damping.coefficient", "the damping is 0 1/s at x = 2"]);
    check("{kind: critical, damping: {kind: constant, coefficient: 2.0}}", "{kind: conic, alpha: 2.0}", &["damping"]);
}
