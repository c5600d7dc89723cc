//! Lyapunov functions along a run, as they are measured.

use crate::summary::LyapunovSummary;
use wide::f64x4;

/// How many robots are looked at side by side.
pub(crate) const LANES: usize = 4;
/// A bit for each of them.
pub(crate) const ALL: u8 = (1 << LANES) - 1;

/// Of the laws of robots side by side. V may change by what its law says, by the power that leader, robots ahead and obstacles bring in as
/// they move (`trench_formation::agent::Powers`), and not otherwise: what is left of V(t) - integral of that power must fall.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Courses {
    /// The greatest value, and the greatest rate by the law's formula.
    greatest: [f64x4; 2],
    /// V and the power brought in a step ago.
    last: [f64x4; 2],
    /// V less what was brought in since it is this function, from 0 on, and the least of that.
    own: [f64x4; 2],
    /// The greatest change of that from one step to the next, and by how much it rose at most above any value before.
    risen: [f64x4; 2],
    /// Whether something drew a robot a step ago, and whether V was told then: where not, V has been another function.
    drawn: u8,
    told: u8,
}

/// V, its rate by the law and the power that is brought in, of robots side by side: where V is `told`, and whether something draws them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moments {
    pub(crate) values: [f64x4; 3],
    pub(crate) told: u8,
    pub(crate) drawn: u8,
}

impl Courses {
    pub(crate) fn new() -> Self {
        let (lowest, zero) = (f64x4::splat(f64::NEG_INFINITY), f64x4::splat(0.0));
        Self { greatest: [lowest; 2], last: [zero; 2], own: [zero; 2], risen: [lowest, zero], drawn: 0, told: 0 }
    }

    /// From now on V of the robot in a lane is another function.
    pub(crate) fn begin_anew(&mut self, lane: usize) {
        self.told &= !(1 << lane);
    }

    /// A `step` (s) after the last time. Where the attraction is suspended, or comes back, V is another function (steps (5) of 7.5.2, 7.7).
    #[inline]
    pub(crate) fn take(&mut self, Moments { values, told, drawn }: Moments, step: f64) {
        let goes_on = told & self.told & !(drawn ^ self.drawn);
        if (told, goes_on) == (ALL, ALL) {
            self.go_on(values, step);
        } else {
            let (before, zero) = (*self, f64x4::splat(0.0));
            self.go_on(values, step);
            let (known, same) = (mask(told), mask(goes_on));
            let or = |mask: f64x4, new: [f64x4; 2], old: [f64x4; 2]| {
                [mask.bitselect(new[0], old[0]), mask.bitselect(new[1], old[1])]
            };
            self.greatest = or(known, self.greatest, before.greatest);
            self.own = or(same, self.own, [zero; 2]);
            self.risen = or(same, self.risen, before.risen);
        }
        (self.told, self.drawn) = (told, drawn);
    }

    /// Where V is the same function as before.
    #[inline(always)]
    fn go_on(&mut self, [value, rate, power]: [f64x4; 3], step: f64) {
        let [before, brought] = self.last;
        let change = value - before - f64x4::splat(0.5 * step) * (brought + power);
        self.own[0] += change;
        self.own[1] = less(self.own[0], self.own[1]);
        self.last = [value, power];
        let (greatest, rises) = ([value, rate], [change, self.own[0] - self.own[1]]);
        let is_above = |new: [f64x4; 2], so_far: [f64x4; 2]| new[0].simd_gt(so_far[0]) | new[1].simd_gt(so_far[1]);
        // Most often none is, and then nothing is written of thousands of robots.
        if (is_above(greatest, self.greatest) | is_above(rises, self.risen)).any() {
            let above = |new: [f64x4; 2], so_far: [f64x4; 2]| [greater(new[0], so_far[0]), greater(new[1], so_far[1])];
            self.greatest = above(greatest, self.greatest);
            self.risen = above(rises, self.risen);
        }
    }

    /// Of the robot in a lane, whose V is `last` at the end, after steps of `step` (s).
    pub(crate) fn summary(&self, lane: usize, last: f64, step: f64) -> LyapunovSummary {
        let of = |values: &[f64x4; 2]| values.map(|values| values.as_array()[lane]);
        let [greatest, greatest_rate_of_law] = of(&self.greatest);
        let [change, greatest_rise] = of(&self.risen);
        let greatest_rate = (change > f64::NEG_INFINITY).then_some(change / step);
        LyapunovSummary { greatest, last, greatest_rate, greatest_rise, greatest_rate_of_law }
    }
}

/// The greater of each two; the second, where they are equal or the first is no number.
#[inline(always)]
pub(crate) fn greater(value: f64x4, so_far: f64x4) -> f64x4 {
    value.fast_max(so_far)
}

/// The less of each two; the second, where they are equal or the first is no number.
#[inline(always)]
pub(crate) fn less(value: f64x4, so_far: f64x4) -> f64x4 {
    value.fast_min(so_far)
}

/// All bits of the lanes that have one.
fn mask(lanes: u8) -> f64x4 {
    f64x4::new(core::array::from_fn(|lane| f64::from_bits(if lanes & (1 << lane) == 0 { 0 } else { u64::MAX })))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(values: [f64; 3], drawn: bool) -> Moments {
        Moments { values: values.map(f64x4::splat), told: ALL, drawn: if drawn { ALL } else { 0 } }
    }

    fn along(values: impl IntoIterator<Item = [f64; 2]>) -> LyapunovSummary {
        let mut courses = Courses::new();
        for [value, power] in values {
            courses.take(moments([value, -1.0, power], true), 0.5);
        }
        courses.summary(1, 0.0, 0.5)
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
        let mut courses = Courses::new();
        courses.take(moments([1.0, 0.0, 0.0], true), 0.5);
        courses.take(moments([9.0, 0.0, 0.0], false), 0.5);
        (0..LANES).for_each(|lane| courses.begin_anew(lane));
        courses.take(moments([20.0, 0.0, 0.0], false), 0.5);
        let told = courses.summary(3, 0.0, 0.5);
        assert_eq!((told.greatest_rate, told.greatest_rise, told.greatest), (None, 0.0, 20.0));
    }

    #[test]
    fn each_has_its_own() {
        let mut courses = Courses::new();
        courses.take(moments([1.0, -1.0, 0.0], true), 0.5);
        courses.take(Moments { drawn: 0b1101, told: 0b1011, ..moments([3.0, -2.0, 0.0], true) }, 0.5);
        let rates = [0, 1, 2, 3].map(|lane| courses.summary(lane, 3.0, 0.5).greatest_rate);
        assert_eq!(rates, [Some(4.0), None, None, Some(4.0)]);
        assert_eq!([0, 1, 2, 3].map(|lane| courses.summary(lane, 3.0, 0.5).greatest), [3.0, 3.0, 1.0, 3.0]);
    }
}
