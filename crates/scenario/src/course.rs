//! A Lyapunov function along a run, as it is measured.

use crate::summary::LyapunovSummary;

/// Of a robot's law. V may change by what its law says, by the power that leader, robots ahead and obstacles bring in as they move
/// (`trench_formation::agent::Powers`), and not otherwise: what is left of V(t) - integral of that power must fall.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course {
    /// The greatest value, and the greatest rate by the law's formula.
    greatest: [f64; 2],
    /// V and the power brought in a step ago, and whether something drew the robot then; none where V has been another function.
    last: Option<([f64; 2], bool)>,
    /// V less what was brought in since it is this function, from 0 on, and the least of that.
    own: [f64; 2],
    /// The greatest rate of that between two steps, and by how much it rose at most above any value before.
    risen: [f64; 2],
}

impl Course {
    pub(crate) fn new() -> Self {
        Self { greatest: [f64::NEG_INFINITY; 2], last: None, own: [0.0; 2], risen: [f64::NEG_INFINITY, 0.0] }
    }

    /// From now on V is another function.
    pub(crate) fn begin_anew(&mut self) {
        (self.last, self.own) = (None, [0.0; 2]);
    }

    /// V, its rate by the law and the power brought in, a `step` (s) after the last time. Where the attraction is suspended, or comes back,
    /// V is another function (steps (5) of 7.5.2, 7.7).
    #[inline]
    pub(crate) fn take(&mut self, [value, rate, power]: [f64; 3], step: f64, drawn: bool) {
        self.greatest = [self.greatest[0].max(value), self.greatest[1].max(rate)];
        match self.last {
            Some(([before, brought], was_drawn)) if was_drawn == drawn => {
                let change = value - before - 0.5 * step * (brought + power);
                self.own[0] += change;
                self.own[1] = self.own[1].min(self.own[0]);
                self.risen = [self.risen[0].max(change / step), self.risen[1].max(self.own[0] - self.own[1])];
            }
            _ => self.begin_anew(),
        }
        self.last = Some(([value, power], drawn));
    }

    pub(crate) fn summary(&self, last: f64) -> LyapunovSummary {
        let [greatest, greatest_rate_of_law] = self.greatest;
        let [rate, greatest_rise] = self.risen;
        let greatest_rate = (rate > f64::NEG_INFINITY).then_some(rate);
        LyapunovSummary { greatest, last, greatest_rate, greatest_rise, greatest_rate_of_law }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(values: impl IntoIterator<Item = [f64; 2]>) -> LyapunovSummary {
        let mut course = Course::new();
        for [value, power] in values {
            course.take([value, -1.0, power], 0.5, true);
        }
        course.summary(0.0)
    }

    #[test]
    fn what_rises_is_told_whatever_the_formula_says() {
        let told = along([[3.0, 0.0], [1.0, 0.0], [1.5, 0.0], [1.25, 0.0], [2.0, 0.0]]);
        assert_eq!((told.greatest_rate, told.greatest_rise, told.greatest_rate_of_law), (Some(1.5), 1.0, -1.0));
    }

    #[test]
    fn what_is_brought_in_does_not_count() {
        let told = along([[1.0, 2.0], [2.0, 2.0], [3.5, 2.0]]);
        assert_eq!((told.greatest_rate, told.greatest_rise), (Some(1.0), 0.5));
    }

    #[test]
    fn another_function_begins_anew() {
        let mut course = Course::new();
        course.take([1.0, 0.0, 0.0], 0.5, true);
        course.take([9.0, 0.0, 0.0], 0.5, false);
        course.begin_anew();
        course.take([20.0, 0.0, 0.0], 0.5, false);
        let told = course.summary(0.0);
        assert_eq!((told.greatest_rate, told.greatest_rise, told.greatest), (None, 0.0, 20.0));
    }
}
