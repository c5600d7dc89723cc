//! What is measured of robots after every step, wherever it stands.

use crate::Sample;
use crate::course::{ALL, LANES, Moments};
use trench_formation::kinematics::PointState;
use trench_formation::simulate::{ChainSimulation, Outcome};
use trench_formation::trench::AnyTrench;
use wide::f64x4;

/// All robots at one time, in the order of [`Scenario::seats`](crate::Scenario::seats).
pub(crate) trait Robots {
    /// Robots side by side; the last of them where there are fewer from `first` to before `end`, of which there is one at least.
    fn seen(&self, first: usize, end: usize) -> Seen;

    /// Those of a team, which stand together from `first` to before `end`. What is not kept as points is copied into `copies`.
    fn points<'a>(&'a self, first: usize, end: usize, copies: &'a mut Vec<PointState>) -> &'a [PointState];
}

/// Robots side by side, at one time.
pub(crate) struct Seen {
    /// m, frame `map`.
    pub(crate) x: f64x4,
    pub(crate) y: f64x4,
    /// See [`Sample::deviation`], m.
    pub(crate) deviation: f64x4,
    /// See [`Sample::lyapunov`] and [`Sample::power`].
    pub(crate) lyapunov: Moments,
}

impl Robots for [Sample] {
    fn seen(&self, first: usize, end: usize) -> Seen {
        let samples = lanes(first, end).map(|index| &self[index]);
        let laws = samples.map(|sample| sample.lyapunov.unwrap_or_default());
        let position = samples.map(|sample| sample.position);
        Seen {
            x: f64x4::new(position.map(|position| position.x)),
            y: f64x4::new(position.map(|position| position.y)),
            deviation: f64x4::new(samples.map(|sample| sample.deviation)),
            lyapunov: Moments {
                values: [laws.map(|law| law[0]), laws.map(|law| law[1]), samples.map(|sample| sample.power)]
                    .map(f64x4::new),
                told: bits(samples.map(|sample| sample.lyapunov.is_some())),
                drawn: bits(samples.map(|sample| sample.goal.is_some())),
            },
        }
    }

    fn points<'a>(&'a self, first: usize, end: usize, copies: &'a mut Vec<PointState>) -> &'a [PointState] {
        copies.clear();
        copies.extend(self[first..end].iter().map(|sample| PointState::at_rest(sample.position)));
        copies
    }
}

/// What the step itself has left: of thousands of robots nothing is copied.
impl Robots for ChainSimulation<AnyTrench> {
    #[inline(always)]
    fn seen(&self, first: usize, end: usize) -> Seen {
        let whole = (
            self.robots().get(first..).and_then(<[PointState]>::first_chunk::<LANES>),
            self.deviations().get(first..).and_then(<[f64]>::first_chunk::<LANES>),
            self.outcomes().get(first..).and_then(<[Outcome]>::first_chunk::<LANES>),
        );
        if let (Some(robots), Some(deviations), Some(outcomes)) = whole {
            return of_chain(robots, *deviations, outcomes, ALL);
        }
        let at = lanes(first, end);
        let told = !self.outcomes().is_empty();
        let outcomes = at.map(|index| self.outcomes().get(index).copied().unwrap_or_default());
        let (robots, deviations) = (at.map(|index| self.robots()[index]), at.map(|index| self.deviations()[index]));
        of_chain(&robots, deviations, &outcomes, if told { ALL } else { 0 })
    }

    #[inline]
    fn points<'a>(&'a self, first: usize, end: usize, _: &'a mut Vec<PointState>) -> &'a [PointState] {
        &self.robots()[first..end]
    }
}

#[inline(always)]
fn of_chain(robots: &[PointState; LANES], deviations: [f64; LANES], outcomes: &[Outcome; LANES], told: u8) -> Seen {
    let position = robots.each_ref().map(|robot| robot.position);
    let of = |value: fn(&Outcome) -> f64| f64x4::new(outcomes.each_ref().map(value));
    Seen {
        x: f64x4::new(position.map(|position| position.x)),
        y: f64x4::new(position.map(|position| position.y)),
        deviation: f64x4::new(deviations),
        lyapunov: Moments {
            values: [
                of(|outcome| outcome.steered.lyapunov),
                of(|outcome| outcome.steered.lyapunov_rate),
                of(|outcome| outcome.power),
            ],
            told,
            drawn: bits(outcomes.each_ref().map(|outcome| outcome.attraction.is_some())),
        },
    }
}

/// Indices from `first` to before `end`, the last one again where there are too few.
fn lanes(first: usize, end: usize) -> [usize; LANES] {
    core::array::from_fn(|lane| (first + lane).min(end - 1))
}

/// A bit for each lane.
#[inline(always)]
pub(crate) fn bits(lanes: [bool; LANES]) -> u8 {
    let [a, b, c, d] = lanes.map(u8::from);
    a | b << 1 | c << 2 | d << 3
}
