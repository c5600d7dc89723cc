//! What is measured of robots after every step, wherever it stands.

use crate::Sample;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::ChainSimulation;
use trench_formation::trench::AnyTrench;

/// All robots at one time, in the order of [`Scenario::seats`](crate::Scenario::seats).
pub(crate) trait Robots {
    /// m, frame `map`.
    fn position(&self, index: usize) -> Vector2<f64>;

    /// See [`Sample::deviation`], m.
    fn deviation(&self, index: usize) -> f64;

    /// V, its rate by the law and the power that is brought in, see [`Sample::lyapunov`] and [`Sample::power`].
    fn lyapunov(&self, index: usize) -> Option<[f64; 3]>;

    /// Whether something draws it.
    fn is_drawn(&self, index: usize) -> bool;

    /// Those of a team, which stand together from `first` to before `end`. What is not kept as points is copied into `copies`.
    fn points<'a>(&'a self, first: usize, end: usize, copies: &'a mut Vec<PointState>) -> &'a [PointState];
}

impl Robots for [Sample] {
    fn position(&self, index: usize) -> Vector2<f64> {
        self[index].position
    }

    fn deviation(&self, index: usize) -> f64 {
        self[index].deviation
    }

    fn lyapunov(&self, index: usize) -> Option<[f64; 3]> {
        let Sample { lyapunov, power, .. } = self[index];
        lyapunov.map(|[value, rate]| [value, rate, power])
    }

    fn is_drawn(&self, index: usize) -> bool {
        self[index].goal.is_some()
    }

    fn points<'a>(&'a self, first: usize, end: usize, copies: &'a mut Vec<PointState>) -> &'a [PointState] {
        copies.clear();
        copies.extend(self[first..end].iter().map(|sample| PointState::at_rest(sample.position)));
        copies
    }
}

/// What the step itself has left: of thousands of robots nothing is copied.
impl Robots for ChainSimulation<AnyTrench> {
    #[inline]
    fn position(&self, index: usize) -> Vector2<f64> {
        self.robots()[index].position
    }

    #[inline]
    fn deviation(&self, index: usize) -> f64 {
        self.deviations()[index]
    }

    #[inline]
    fn lyapunov(&self, index: usize) -> Option<[f64; 3]> {
        let outcome = self.outcomes().get(index)?;
        Some([outcome.steered.lyapunov, outcome.steered.lyapunov_rate, outcome.power])
    }

    #[inline]
    fn is_drawn(&self, index: usize) -> bool {
        self.outcomes().get(index).is_some_and(|outcome| outcome.attraction.is_some())
    }

    #[inline]
    fn points<'a>(&'a self, first: usize, end: usize, _: &'a mut Vec<PointState>) -> &'a [PointState] {
        &self.robots()[first..end]
    }
}
