//! The velocity at which a law goes on from tick to tick.

use trench_core::RosTime;
use trench_formation::Vector2;

/// A gap between ticks after which the velocity of the last one says nothing, s.
const FORGET: f64 = 0.2;

/// What the steered point's velocity is between two ticks. A tick may come early (an emergency stop that ends) or late (the
/// watchdog): the law goes on from where it has come to, not from where the next tick was expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reference {
    pub(crate) from: RosTime,
    /// s
    pub(crate) duration: f64,
    /// m/s, map.
    pub(crate) start: Vector2<f64>,
    pub(crate) end: Vector2<f64>,
}

impl Reference {
    /// The velocity at `time`, while it says something.
    pub(crate) fn at(&self, time: RosTime) -> Option<Vector2<f64>> {
        let elapsed = time.seconds_since(self.from);
        let share = (elapsed / self.duration).clamp(0.0, 1.0);
        (elapsed <= FORGET).then(|| self.start + share * (self.end - self.start))
    }

    /// The robot is told something else, at a constant velocity.
    pub(crate) fn replaced(self, velocity: Vector2<f64>) -> Self {
        Self { start: velocity, end: velocity, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn early_and_late_ticks() {
        let reference =
            Reference { from: RosTime(0), duration: 0.04, start: Vector2::zeros(), end: Vector2::new(0.2, 0.0) };
        let check = |seconds: f64, expected: Option<f64>| {
            let velocity = reference.at(RosTime(0).plus_seconds(seconds)).map(|velocity| velocity.x);
            assert_eq!(velocity, expected, "{seconds}");
        };
        check(0.0, Some(0.0));
        check(0.01, Some(0.05));
        check(0.04, Some(0.2));
        check(0.09, Some(0.2));
        check(0.3, None);
    }
}
