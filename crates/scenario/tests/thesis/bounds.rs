//! Laws within what robots can do (9.2), with the safety filter that ends them.

use super::{assert_near, leader_distances, scenario, scenario_with, text};
use trench_scenario::{CaseSummary, Measures, Sample, Scenario, Simulation, Summary, parse};

/// 9.2: what the robots can do, 1.2 m/s and 5 m/s^2, is never exceeded; bodies of 0.5 m touch nothing, and the chain stands in its order.
#[test]
fn bounded_chain_of_9_2() {
    let case = run_within("9.2_bounded.yaml", [1.2, 5.0]);
    assert_near(case.robots[0].position, &[100.0, 100.0], 0.1);
    assert!(case.obstacles.len() == 4 && case.obstacles.iter().all(|obstacle| obstacle.least_gap > 0.5), "{case:?}");
    // From outside they come to the edge of the neutral zone, where the continuous force of the zones fades out (chapter 7 of docs/theory).
    assert!(leader_distances(&case).iter().all(|distance| (4.0..=10.2).contains(distance)), "{case:?}");
    let along: Vec<f64> = case.robots.iter().map(|robot| robot.position[0] + robot.position[1]).collect();
    assert!(along.windows(2).all(|pair| pair[0] > pair[1]), "{along:?}");
}

/// (6.1) by the controllers' core, with limits and the safety filter.
#[test]
fn bounded_chain_of_6_5() {
    let case = run_within("6.5_bounded.yaml", [1.2, 3.0]);
    assert_near(case.robots[0].position, &[70.0, 70.0], 0.1);
    assert!(leader_distances(&case).iter().all(|distance| (4.0..=10.2).contains(distance)), "{case:?}");
}

/// (5.1) and (5.2) behind moving goal points, and (5.3), for which the same goal points rest: bodies that begin beside each other do not touch,
/// and all come to their goal points.
#[test]
fn bounded_tracking_of_5_6() {
    for speed in [1.0, 0.0] {
        let (old, new) = ("speed: 1.0                 # m/s\n  amplitude", format!("speed: {speed:?}\n  amplitude"));
        let scenario = scenario_with("5.6_bounded.yaml", &[(old, &new)]);
        // Goal points on their wave: up to hypot(1, 0.5) m/s and 0.25 m/s^2.
        let ([fastest, hardest], summary) = hardest(&scenario);
        assert!(fastest <= 2.0 + speed * 1.25_f64.sqrt() + 1e-9, "{fastest} m/s");
        assert!(hardest <= 5.0 + 0.25 * speed + 1e-6, "{hardest} m/s^2");
        assert_eq!(summary.cases.len(), 2);
        for case in &summary.cases {
            assert!(case.closest_pair.unwrap() >= 1.0, "{}: bodies come within {:?} m", case.label, case.closest_pair);
            assert!(case.robots.iter().all(|robot| robot.error < 0.1), "{case:?}");
        }
    }
}

/// Two robots that have to change places: without the filter their bodies touch, with it they pass each other and come to their goal points.
#[test]
fn without_the_filter_bodies_that_change_places_touch() {
    let text = text("5.6_bounded.yaml");
    let kept = text.lines().filter(|line| !line.starts_with("- {error:") && !line.starts_with("- {figure:"));
    let kept = kept.filter(|line| !line.starts_with("figures:"));
    let robots = ["- {error: [-3.0, 0.3]}", "- {error: [3.0, -0.3]}"];
    let with = kept.chain(robots).collect::<Vec<_>>().join("\n");
    let without: Vec<&str> = with.lines().filter(|line| !line.contains("safety:")).collect();
    for (text, touch) in [(&with, false), (&without.join("\n"), true)] {
        let (_, summary) = hardest(&parse("5.6_bounded.yaml", text).unwrap());
        for case in &summary.cases {
            assert_eq!(case.closest_pair.unwrap() < 1.0, touch, "{}: {:?}", case.label, case.closest_pair);
            assert!(case.robots.iter().all(|robot| robot.error < 0.1), "{case:?}");
        }
    }
}

/// A run whose robots never are faster and never accelerate harder than this (m/s, m/s^2), nor come into each other's zone 1, and end on the segment.
fn run_within(name: &str, [speed, acceleration]: [f64; 2]) -> CaseSummary {
    let (hardest, mut summary) = hardest(&scenario(name));
    assert!(hardest[0] <= speed + 1e-9 && hardest[1] <= acceleration + 1e-6, "{hardest:?}");
    let case = summary.cases.remove(0);
    assert!(case.robots.iter().all(|robot| robot.error < 0.1), "{case:?}");
    assert!(case.in_zone_1 == Some(0.0) && case.closest_pair.unwrap() > 1.0, "{case:?}");
    case
}

/// A run, and the greatest speed and acceleration that any robot had in it (m/s, m/s^2).
fn hardest(scenario: &Scenario) -> ([f64; 2], Summary) {
    let (mut simulation, mut measures) = (Simulation::new(scenario).unwrap(), Measures::new(scenario));
    let (mut samples, mut before) = (Vec::new(), Vec::<Sample>::new());
    let (step, mut hardest) = (scenario.timing.step, [0.0_f64; 2]);
    for _ in 0..=(scenario.timing.duration / step).round() as u64 {
        simulation.sample(false, &mut samples).unwrap();
        measures.take(scenario, &simulation, &samples);
        for (now, before) in samples.iter().zip(&before) {
            hardest[0] = hardest[0].max(now.velocity.norm());
            hardest[1] = hardest[1].max((now.velocity - before.velocity).norm() / step);
        }
        before.clone_from(&samples);
        simulation.step().unwrap();
    }
    (hardest, measures.summary(scenario, &samples))
}
