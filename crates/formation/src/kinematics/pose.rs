//! Posture and velocity of a unicycle, (3.5).
use super::wrap;
use crate::Vector2;

/// The posture p = (x, y, theta) of 3.1.2 in frame `map`: the centre between the wheels and the heading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Heading, radians in (-pi, pi].
    pub theta: f64,
}

/// The velocity of a robot in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Twist {
    /// Forward speed v, m/s.
    pub v: f64,
    /// Turn rate omega, rad/s, counter-clockwise.
    pub omega: f64,
}

impl Twist {
    /// A robot at rest.
    pub const ZERO: Self = Self { v: 0.0, omega: 0.0 };

    /// Whether both parts are finite numbers.
    pub fn is_finite(self) -> bool {
        self.v.is_finite() && self.omega.is_finite()
    }
}

impl Pose {
    /// A pose whose heading is wrapped.
    pub fn new(x: f64, y: f64, theta: f64) -> Self {
        Self { x, y, theta: wrap(theta) }
    }

    /// (x, y).
    pub fn position(self) -> Vector2<f64> {
        Vector2::new(self.x, self.y)
    }

    /// The unit vector the robot faces.
    pub fn heading(self) -> Vector2<f64> {
        Vector2::new(libm::cos(self.theta), libm::sin(self.theta))
    }

    /// The exact solution of (3.5) after `duration` (s) of constant `twist`: an arc, or a line when omega is 0.
    #[must_use]
    pub fn advanced(self, twist: Twist, duration: f64) -> Self {
        let half_turn = 0.5 * twist.omega * duration;
        // The chord of the arc, which points half the turn away from the old heading; its length is v t sin(h)/h,
        // written so that a vanishing turn needs no case of its own beyond h = 0.
        let shrink = if half_turn == 0.0 { 1.0 } else { libm::sin(half_turn) / half_turn };
        let chord = twist.v * duration * shrink;
        let direction = self.theta + half_turn;
        Self::new(
            self.x + chord * libm::cos(direction),
            self.y + chord * libm::sin(direction),
            self.theta + 2.0 * half_turn,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    #[test]
    fn a_quarter_of_a_circle() {
        let end = Pose::default().advanced(Twist { v: PI / 2.0, omega: PI / 2.0 }, 1.0);
        assert!((end.x - 1.0).abs() < 1e-15 && (end.y - 1.0).abs() < 1e-15 && (end.theta - PI / 2.0).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn two_halves_make_a_whole(theta in -PI..PI, v in -1.0..1.0_f64, omega in -20.0..20.0_f64, dt in 0.0..1.0_f64) {
            let start = Pose::new(0.3, -0.2, theta);
            let twist = Twist { v, omega };
            let whole = start.advanced(twist, dt);
            let halves = start.advanced(twist, dt / 2.0).advanced(twist, dt / 2.0);
            prop_assert!((whole.position() - halves.position()).norm() < 1e-12);
            prop_assert!(wrap(whole.theta - halves.theta).abs() < 1e-12);
        }

        #[test]
        fn no_jump_where_the_arc_becomes_a_line(omega in -1e-7..1e-7_f64) {
            let arc = Pose::default().advanced(Twist { v: 0.3, omega }, 1.0);
            let line = Pose::default().advanced(Twist { v: 0.3, omega: 0.0 }, 1.0);
            prop_assert!((arc.position() - line.position()).norm() < 1e-7);
        }
    }
}
