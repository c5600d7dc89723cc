//! Where a robot was in the last moments: what a camera with a shutter needs.

use crate::unicycle::wrapped;
use crate::world::STEP;
use std::collections::VecDeque;
use trench_optics::Pose2;

/// Steps that are remembered.
const LENGTH: usize = 256;

/// A robot's true state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Truth {
    /// In the map.
    pub pose: Pose2,
    /// Forward speed, m/s.
    pub v: f64,
    /// Turning speed, rad/s.
    pub omega: f64,
}

/// The states of the last [`LENGTH`] steps.
#[derive(Debug, Clone)]
pub(crate) struct History {
    newest: u64,
    states: VecDeque<Truth>,
}

impl History {
    pub(crate) fn new(start: u64, state: Truth) -> Self {
        let mut states = VecDeque::with_capacity(LENGTH);
        states.push_back(state);
        Self { newest: start, states }
    }

    /// Adds the state one step after the newest.
    pub(crate) fn push(&mut self, state: Truth) {
        if self.states.len() == LENGTH {
            self.states.pop_front();
        }
        self.states.push_back(state);
        self.newest += STEP;
    }

    /// The state at a time, between two steps by interpolation, outside what is remembered the nearest.
    pub(crate) fn at(&self, time: u64) -> Truth {
        let back = self.newest.saturating_sub(time);
        let (steps, rest) = ((back / STEP) as usize, (back % STEP) as f64 / STEP as f64);
        let last = self.states.len().saturating_sub(1);
        let state = |steps: usize| self.states.get(last.saturating_sub(steps)).copied().unwrap_or_default();
        let (late, early) = (state(steps), state(steps + 1));
        let blend = |late: f64, early: f64| late + rest * (early - late);
        Truth {
            pose: Pose2 {
                x: blend(late.pose.x, early.pose.x),
                y: blend(late.pose.y, early.pose.y),
                theta: wrapped(late.pose.theta + rest * wrapped(early.pose.theta - late.pose.theta)),
            },
            v: blend(late.v, early.v),
            omega: blend(late.omega, early.omega),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_and_holds_the_ends() {
        let state = |x: f64, theta: f64| Truth { pose: Pose2 { x, y: 0.0, theta }, v: x, omega: 0.0 };
        let mut history = History::new(5 * STEP, state(0.0, 3.1));
        history.push(state(1.0, 3.1));
        history.push(state(2.0, -3.1));
        let check = |time: u64, x: f64, theta: f64| {
            let truth = history.at(time);
            assert!((truth.pose.x - x).abs() < 1e-9 && wrapped(truth.pose.theta - theta).abs() < 1e-9, "{truth:?}");
        };
        check(0, 0.0, 3.1);
        check(5 * STEP + STEP / 4, 0.25, 3.1);
        check(6 * STEP, 1.0, 3.1);
        check(6 * STEP + STEP / 2, 1.5, std::f64::consts::PI);
        check(100 * STEP, 2.0, -3.1);
        for _ in 0..1000 {
            history.push(state(9.0, 0.0));
        }
        assert_eq!((history.at(0).pose.x, history.states.len()), (9.0, LENGTH));
    }
}
