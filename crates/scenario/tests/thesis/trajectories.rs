//! 4.4.1 and 4.4.2: what the text says of the trajectories in Fig. 4.9 to 4.20, and the numbers that its errata give.

use super::scenario;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use trench_formation::stability::{entire_cosine_integral, sine_integral};
use trench_scenario::{Sample, Scenario, Simulation};

/// A robot's way to the goal point.
#[derive(Debug, Clone, Copy)]
struct Way {
    /// m.
    length: f64,
    /// By how much its heading has turned in total, rad.
    turning: f64,
    /// By how much the bearing of the goal point has, rad.
    sweep: f64,
    /// Whether it has ever been in another quadrant than the one that it begins at the edge of.
    leaves: bool,
    /// omega/v where the robot is a millimetre from the goal point, 1/m.
    curvature: f64,
    /// m, at the end.
    error: f64,
}

/// The ways of all robots, by seat.
fn ways(scenario: &Scenario) -> Vec<Way> {
    let mut simulation = Simulation::new(scenario).unwrap();
    let (mut samples, mut before) = (Vec::new(), Vec::<Sample>::new());
    simulation.sample(false, &mut before).unwrap();
    let starts = before.clone();
    let mut ways =
        vec![Way { length: 0.0, turning: 0.0, sweep: 0.0, leaves: false, curvature: 0.0, error: 0.0 }; before.len()];
    let step = scenario.timing.step;
    for _ in 0..(scenario.timing.duration / step).round() as u64 {
        simulation.step().unwrap();
        simulation.sample(false, &mut samples).unwrap();
        for (index, way) in ways.iter_mut().enumerate() {
            let (now, last, start) = (&samples[index], &before[index], &starts[index]);
            way.length += 0.5 * step * (now.speed.abs() + last.speed.abs());
            way.turning += 0.5 * step * (now.turn_rate.abs() + last.turn_rate.abs());
            // The goal point is the origin, so that bearings keep their digits however near it is.
            way.sweep += last.position.perp(&now.position).atan2(last.position.dot(&now.position));
            way.leaves |= way.sweep.abs() > FRAC_PI_2;
            if last.deviation > 1e-3 {
                way.curvature = (now.turn_rate / now.speed).abs();
            }
            way.error = now.deviation;
            assert!(start.deviation == 1.0);
        }
        before.clone_from(&samples);
    }
    ways
}

/// By cases, four robots each; twice as long as in the file, since with lambda = 5 robots turn for long after they have come near.
fn by_case(name: &str) -> Vec<Vec<Way>> {
    let mut scenario = scenario(name);
    scenario.timing.duration *= 2.0;
    ways(&scenario).chunks(4).map(<[Way]>::to_vec).collect()
}

/// Si(phi0) under (3.9), Si(2 phi0)/2 under (3.10), by which lambda is multiplied: 43.5 and 39.3 degrees.
const SWEEPS: [(&str, f64); 2] = [("3.9", 43.5), ("3.10", 39.3)];

/// The lower lambda, the shorter the way and the less the turning; only with lambda = 5 does a robot come into another quadrant; all arrive.
#[test]
fn lower_gain_ratios_go_shorter_ways_and_turn_less() {
    for (law, sweep) in SWEEPS {
        let cases = by_case(&format!("4.4.1_law_{law}.yaml"));
        for pair in cases.windows(2) {
            for (lower, higher) in pair[0].iter().zip(&pair[1]) {
                assert!(lower.length < higher.length && lower.turning < higher.turning, "{law}: {lower:?} {higher:?}");
            }
        }
        for (case, lambda) in cases.iter().zip([0.2, 1.0, 5.0]) {
            for way in case {
                assert!(way.error < 0.01, "{law}, {lambda}: {way:?}");
                assert_eq!(way.leaves, lambda == 5.0, "{law}, {lambda}: {way:?}");
                // Degrees, to the digit that the errata give.
                assert!((way.sweep.abs().to_degrees() / lambda - sweep).abs() < 0.05, "{law}, {lambda}: {way:?}");
            }
        }
        let swept = cases[2][0].sweep.abs().to_degrees();
        let expected = if law == "3.9" { 217.4 } else { 196.3 };
        assert!((swept - expected).abs() < 0.05, "{law}: {swept}");
        let exact = if law == "3.9" { sine_integral(FRAC_PI_4) } else { 0.5 * sine_integral(FRAC_PI_2) };
        assert!((cases[1][0].sweep.abs() - exact).abs() < 1e-6, "{law}");
    }
}

/// Fig. 4.10 and 4.12: with lambda below the critical 1 paths end straight, at it with 2 |phi0|/r0 e^(-Cin phi0) or e^(-Cin(2 phi0)/2), above
/// they wind up.
#[test]
fn paths_end_straight_below_the_critical_gain_ratio_and_wind_up_above() {
    for (law, cin) in [("3.9", entire_cosine_integral(FRAC_PI_4)), ("3.10", 0.5 * entire_cosine_integral(FRAC_PI_2))] {
        let cases = by_case(&format!("4.4.1_law_{law}.yaml"));
        let critical = FRAC_PI_2 * libm::exp(-cin);
        for ((low, at), high) in cases[0].iter().zip(&cases[1]).zip(&cases[2]) {
            let [low, at, high] = [low, at, high].map(|robot| robot.curvature);
            assert!(low < 0.01 * at, "{law}: {low}");
            assert!((at / critical - 1.0).abs() < 0.01, "{law}: {at} {critical}");
            assert!(high > 10.0 * at, "{law}: {high}");
        }
    }
}

/// Fig. 4.13 and 4.14: under (3.9), case A, a robot turns a bit more than under (3.10), case B.
#[test]
fn the_direct_law_turns_a_bit_more() {
    let cases = by_case("4.4.1_comparison.yaml");
    for (a, b) in [(0, 2), (1, 3)] {
        for (direct, nominal) in cases[a].iter().zip(&cases[b]) {
            let more = direct.turning / nominal.turning;
            assert!(more > 1.0 && more < 1.25, "a bit: {more}");
        }
    }
}

/// The four starts differ by quarter turns about the goal point alone.
#[test]
fn the_four_trajectories_are_one() {
    for name in ["4.4.1_law_3.9.yaml", "4.4.1_law_3.10.yaml", "4.4.1_comparison.yaml"] {
        for case in by_case(name) {
            for way in &case {
                let same = |a: f64, b: f64| (a - b).abs() < 1e-9 * (1.0 + a.abs());
                let first = case[0];
                assert!(same(way.length, first.length) && same(way.turning, first.turning), "{name}: {case:?}");
                assert!(same(way.sweep, first.sweep), "{name}: {case:?}");
            }
        }
    }
}

/// 4.4.2, Fig. 4.15 to 4.20: for one gain ratio one path, whatever the gains; another one for another ratio.
#[test]
fn one_path_a_gain_ratio() {
    let mut paths = Vec::new();
    for (law, _) in SWEEPS {
        for lambda in ["0.2", "1", "5"] {
            let name = format!("4.4.2_law_{law}_lambda_{lambda}.yaml");
            let scenario = scenario(&name);
            // Gains like 1, 2 and 4: the same place after 4, 2 and 1 s, on the way and near its end.
            let kept = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0].map(|time| at(&scenario, time));
            for robot in 0..4 {
                for start in 0..=4 {
                    let place = |case: usize| kept[start + 2 - case][4 * case + robot];
                    let [first, second, third] = [0, 1, 2].map(place);
                    assert!(
                        (first - second).norm() < 1e-8 && (second - third).norm() < 1e-8,
                        "{name}: {first} {second} {third}"
                    );
                    assert!(first.norm() < 1.0, "{name}: it has gone nowhere");
                }
            }
            paths.push(kept[2][0]);
        }
    }
    for (index, path) in paths.iter().enumerate() {
        assert!(paths[..index].iter().all(|other| (path - other).norm() > 1e-3), "{paths:?}");
    }
}

/// Where all robots are after so many seconds.
fn at(scenario: &Scenario, time: f64) -> Vec<trench_formation::Vector2<f64>> {
    let mut simulation = Simulation::new(scenario).unwrap();
    for _ in 0..(time / scenario.timing.step).round() as u64 {
        simulation.step().unwrap();
    }
    let mut samples = Vec::new();
    simulation.sample(false, &mut samples).unwrap();
    samples.iter().map(|sample| sample.position).collect()
}
