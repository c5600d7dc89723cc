//! A robot seen from its goal point, (3.6)-(3.8).
use super::{Pose, Twist, wrap};
use crate::Vector2;

/// Polar coordinates of a robot about its goal point: Fig. 3.3 with the origin moved to the goal point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Polar {
    /// r: "distance to target", metres.
    pub distance: f64,
    /// phi: "misalignment angle" from the direction towards the goal point to the heading, radians in (-pi, pi].
    pub misalignment: f64,
}

/// Time derivatives of [`Polar`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolarRates {
    /// dr/dt, m/s.
    pub distance: f64,
    /// d(phi)/dt, rad/s.
    pub misalignment: f64,
}

impl Polar {
    /// Coordinates of a robot at `pose` about the point `goal` (frame `map`). phi = pi + theta - varphi of the thesis,
    /// varphi the bearing of the robot from the goal, is theta minus the bearing of the goal from the robot.
    /// On the goal itself no direction exists and phi is 0.
    pub fn of(pose: Pose, goal: Vector2<f64>) -> Self {
        let towards = goal - pose.position();
        let distance = libm::hypot(towards.x, towards.y);
        if distance == 0.0 {
            return Self::default();
        }
        Self { distance, misalignment: wrap(pose.theta - libm::atan2(towards.y, towards.x)) }
    }

    /// (3.8): how the coordinates change while the robot moves with `twist` and the goal point rests.
    /// On the goal point phi turns with the robot alone.
    pub fn rates(self, twist: Twist) -> PolarRates {
        let sweep = if self.distance > 0.0 { twist.v / self.distance * libm::sin(self.misalignment) } else { 0.0 };
        PolarRates { distance: -twist.v * libm::cos(self.misalignment), misalignment: sweep + twist.omega }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    #[test]
    fn facing_the_goal_is_no_misalignment() {
        let polar = Polar::of(Pose::new(1.0, 0.0, PI), Vector2::zeros());
        assert_eq!(polar, Polar { distance: 1.0, misalignment: 0.0 });
        assert_eq!(Polar::of(Pose::new(1.0, 2.0, 0.7), Vector2::new(1.0, 2.0)), Polar::default());
    }

    proptest! {
        /// The thesis's own words: r = sqrt(x^2 + y^2), phi = pi + theta - varphi in the goal's frame.
        #[test]
        fn agrees_with_the_printed_form(x in -3.0..3.0_f64, y in -3.0..3.0_f64, theta in -PI..PI) {
            prop_assume!(libm::hypot(x, y) > 1e-3);
            let polar = Polar::of(Pose::new(x, y, theta), Vector2::zeros());
            prop_assert!((polar.distance - (x * x + y * y).sqrt()).abs() < 1e-14);
            prop_assert!(wrap(polar.misalignment - (PI + theta - libm::atan2(y, x))).abs() < 1e-12);
        }

        /// (3.8) is the derivative of the coordinates along an exact arc.
        #[test]
        fn rates_are_derivatives(theta in -PI..PI, v in -0.5..0.5_f64, omega in -3.0..3.0_f64) {
            let (pose, twist, goal, step) = (Pose::new(0.7, -0.4, theta), Twist { v, omega }, Vector2::new(0.1, 0.2), 1e-5);
            let rates = Polar::of(pose, goal).rates(twist);
            let (before, after) = (Polar::of(pose.advanced(twist, -step), goal), Polar::of(pose.advanced(twist, step), goal));
            let slope = (after.distance - before.distance) / (2.0 * step);
            let turn = wrap(after.misalignment - before.misalignment) / (2.0 * step);
            prop_assert!((slope - rates.distance).abs() < 1e-8);
            prop_assert!((turn - rates.misalignment).abs() < 1e-8);
        }
    }
}
