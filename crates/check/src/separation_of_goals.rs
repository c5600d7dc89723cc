//! Whether robots that track goal points have room at them (5.4, 5.6).

use crate::Verdict;
use crate::scenario::named;
use crate::separation::{Nearest, Needed, separation};
use crate::verdict::number;
use core::f64::consts::{FRAC_PI_2, PI};
use trench_formation::simulate::WaveGoals;
use trench_scenario::GoalTracking;

/// Two goal points where they are nearest to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    /// From 0 on.
    indices: [usize; 2],
    /// m.
    distance: f64,
    /// s; none: they are as near all the time.
    at: Option<f64>,
}

/// Of each case, as bodies are the cases' own; nothing of one robot.
pub(crate) fn separation_of_goals(subject: &str, task: &GoalTracking, duration: f64, tolerance: f64) -> Vec<Verdict> {
    let Some(Pair { indices: [one, other], distance, at }) = nearest(&task.goals, task.robots.len(), duration) else {
        return Vec::new();
    };
    let who = format!("goal points of r{} and r{}", one + 1, other + 1);
    let finding = match at {
        Some(time) => format!("{who} come to {} m of each other, at {time:.2} s", number(distance)),
        None => format!("{who} are {} m apart", number(distance)),
    };
    let of_case = |case: &trench_scenario::GoalCase| {
        let needed = Needed::of(case.bounds.and_then(|bounds| bounds.radius), tolerance);
        // Neighbours are that far apart along x alone.
        let remedy = format!("make goals.spacing {}, which is enough on any wave", needed.or_more());
        separation(&named(subject, &case.name), needed, Nearest { distance, finding: finding.clone(), remedy })
    };
    task.cases.iter().map(of_case).collect()
}

/// The two that come nearest in the run of a duration (s).
///
/// Exact: with the pair's phase theta in its middle, d places apart, dx = d spacing and dy = 2 A sin(kappa dx/2) cos theta, and theta runs evenly.
/// As no distance is below |dx|, pairs farther apart along x than the nearest one need no look.
fn nearest(goals: &WaveGoals, robots: usize, duration: f64) -> Option<Pair> {
    let mut found: Option<Pair> = None;
    for places in 1..robots {
        let along = places as f64 * goals.spacing.abs();
        if found.is_some_and(|pair| pair.distance <= along) {
            break;
        }
        let across = 2.0 * (goals.amplitude * libm::sin(0.5 * goals.wave_number * along)).abs();
        for index in 0..robots - places {
            let middle = goals.first - (index as f64 + 0.5 * places as f64) * goals.spacing;
            let phase = goals.wave_number * middle + goals.phase;
            let (cosine, at) = least_cosine(phase, goals.wave_number * goals.speed, duration);
            let distance = libm::hypot(along, across * cosine);
            if found.is_none_or(|pair| distance < pair.distance) {
                let at = at.filter(|_| across > 0.0);
                found = Some(Pair { indices: [index, index + places], distance, at });
            }
        }
    }
    found
}

/// The least |cos(phase + rate t)| (rad, rad/s) of a run, and when; no time where it never changes.
fn least_cosine(phase: f64, rate: f64, duration: f64) -> (f64, Option<f64>) {
    let size = |time: f64| libm::cos(phase + rate * time).abs();
    if rate == 0.0 {
        return (size(0.0), None);
    }
    // How far it is to the next zero, the way that the phase goes.
    let ahead = rate.signum() * (FRAC_PI_2 - phase);
    let time = (ahead - PI * libm::floor(ahead / PI)) / rate.abs();
    if time <= duration {
        return (0.0, Some(time));
    }
    let time = if size(duration) < size(0.0) { duration } else { 0.0 };
    (size(time), Some(time))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All pairs, 4000 times.
    fn sampled(goals: &WaveGoals, robots: usize, duration: f64) -> f64 {
        let pairs = || (0..robots).flat_map(|one| (0..one).map(move |other| (one, other)));
        let distance = |time: f64, (one, other): (usize, usize)| {
            (goals.at(one, time).position - goals.at(other, time).position).norm()
        };
        let times = (0..=4000_u32).map(|look| duration * f64::from(look) / 4000.0);
        times.flat_map(|time| pairs().map(move |pair| distance(time, pair))).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_least_distance_is_exact() {
        let wave = WaveGoals { first: 42.0, spacing: 3.0, speed: 1.0, amplitude: 1.0, wave_number: 0.5, phase: 0.0 };
        for (goals, duration) in [
            (wave, 8.0),
            (wave, 0.3),
            (WaveGoals { speed: -0.7, spacing: -0.4, ..wave }, 20.0),
            (WaveGoals { speed: 0.0, phase: 0.8, ..wave }, 20.0),
            // Steep: not neighbours, but those half a wave apart come nearest.
            (WaveGoals { amplitude: 40.0, spacing: 0.5, wave_number: 2.0, ..wave }, 0.2),
            (WaveGoals { amplitude: 40.0, spacing: 0.5, wave_number: 2.0, speed: 0.0, ..wave }, 1.0),
            (WaveGoals { amplitude: 5.0, spacing: 0.1, wave_number: 3.0, ..wave }, 9.0),
            (WaveGoals { amplitude: 0.0, ..wave }, 9.0),
            (WaveGoals { spacing: 0.0, ..wave }, 9.0),
        ] {
            let (pair, least) = (nearest(&goals, 9, duration).unwrap(), sampled(&goals, 9, duration));
            assert!(pair.distance <= least + 1e-12, "{goals:?}: {pair:?}, {least}");
            assert!(pair.distance >= least - 1e-3 * (1.0 + goals.amplitude), "{goals:?}: {pair:?}, {least}");
            // And it is so, then.
            let [one, other] = pair.indices.map(|index| goals.at(index, pair.at.unwrap_or(0.0)).position);
            assert!(((one - other).norm() - pair.distance).abs() < 1e-9, "{goals:?}: {pair:?}");
        }
        assert_eq!(nearest(&wave, 1, 8.0), None);
    }
}
