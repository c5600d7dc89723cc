//! Law (3.13) for a goal point that moves: its velocity fed forward.
//!
//! With e from the robot to the goal point, the robot should move with w = v_goal + K1 e. The angle phi is measured from
//! the direction psi of w (for a resting goal point that is the direction towards it), and
//!
//! v = |w| cos phi,  omega = psi' - K2 phi - K4 sin 2 phi,  K4 = (K3 - K1)/2.
//!
//! Then phi' = omega - psi' = -K2 phi - K4 sin 2 phi, which is (4.8) to the letter: the stable zone of 4.3 holds for
//! moving goal points unchanged. The error obeys e' = -K1 e + w_n, w_n the part of w across the heading,
//! |w_n| = |w| |sin phi|: a stable system driven by a term that phi takes to 0, so e vanishes, without the lag
//! |v_goal|/K1 of the thesis's experiments. For a resting goal point psi' = -K1 sin phi cos phi, and the law is (3.13).
use super::{DeadBand, Lyapunov, Robust};
use crate::Vector2;
use crate::kinematics::{Pose, Twist, wrap};

/// The law's gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracking {
    /// K1, K2 and K3 of (3.13).
    pub gains: Robust,
    /// Where the robot rests. Compared with |w|/K1, the distance at which (3.13) would want the same speed: for a moving
    /// goal point it also covers the moments at which the wanted velocity has no direction.
    pub dead_band: DeadBand,
}

/// A goal point in frame `map`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalMotion {
    /// Metres.
    pub position: Vector2<f64>,
    /// m/s.
    pub velocity: Vector2<f64>,
    /// m/s^2.
    pub acceleration: Vector2<f64>,
}

impl GoalMotion {
    /// A goal point that does not move.
    pub fn at_rest(position: Vector2<f64>) -> Self {
        Self { position, velocity: Vector2::zeros(), acceleration: Vector2::zeros() }
    }

    /// The point after `time` (s) of constant acceleration.
    #[must_use]
    pub fn after(self, time: f64) -> Self {
        Self {
            position: self.position + time * (self.velocity + 0.5 * time * self.acceleration),
            velocity: self.velocity + time * self.acceleration,
            ..self
        }
    }
}

/// What the law says and what a monitor wants to know of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracked {
    /// The command.
    pub twist: Twist,
    /// |e|, metres.
    pub distance: f64,
    /// phi, radians; 0 while the robot rests in the dead band.
    pub misalignment: f64,
    /// V = (|e|^2 + phi^2)/2 and its derivative along the commanded motion, the goal point's motion included.
    pub lyapunov: Lyapunov,
    /// Whether the robot rests in the dead band: hand it back with the next call.
    pub holding: bool,
}

impl Tracking {
    /// The command for a robot at `pose`; `holding` is what the last call returned, false at first.
    pub fn track(&self, pose: Pose, goal: GoalMotion, holding: bool) -> Tracked {
        self.track_within(pose, goal, holding, f64::INFINITY)
    }

    /// [`Self::track`] at no more than `max_speed` (m/s): |w| is cut, not the command, and psi' is that of the slower motion, so
    /// that phi still obeys (4.8) exactly. A goal point that is slower than `max_speed` is still caught.
    pub fn track_within(&self, pose: Pose, goal: GoalMotion, holding: bool, max_speed: f64) -> Tracked {
        let Robust { k1, .. } = self.gains;
        let error = goal.position - pose.position();
        let distance = libm::hypot(error.x, error.y);
        let wanted = goal.velocity + k1 * error;
        let speed = libm::hypot(wanted.x, wanted.y);
        if speed == 0.0 || self.dead_band.holds(speed / k1, holding) {
            let lyapunov = Lyapunov { value: 0.5 * distance * distance, rate: error.dot(&goal.velocity) };
            return Tracked { twist: Twist::ZERO, distance, misalignment: 0.0, lyapunov, holding: true };
        }
        let misalignment = wrap(pose.theta - libm::atan2(wanted.y, wanted.x));
        let v = speed.min(max_speed) * libm::cos(misalignment);
        let error_rate = goal.velocity - v * pose.heading();
        let wanted_rate = goal.acceleration + k1 * error_rate;
        let direction_rate = wanted.perp(&wanted_rate) / (speed * speed);
        let misalignment_rate = self.gains.misalignment_rate(misalignment);
        let lyapunov = Lyapunov {
            value: 0.5 * (distance * distance + misalignment * misalignment),
            rate: error.dot(&error_rate) + misalignment * misalignment_rate,
        };
        let twist = Twist { v, omega: direction_rate + misalignment_rate };
        Tracked { twist, distance, misalignment, lyapunov, holding: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::Polar;
    use crate::laws::PointLaw;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    const LAW: Tracking =
        Tracking { gains: Robust { k1: 0.8, k2: 2.0, k3: 3.0 }, dead_band: DeadBand { hold: 0.004, resume: 0.008 } };

    proptest! {
        #[test]
        fn is_3_13_for_a_resting_goal_point(x in -2.0..2.0_f64, y in -2.0..2.0_f64, theta in -PI..PI) {
            prop_assume!(libm::hypot(x, y) > 0.01);
            let pose = Pose::new(x, y, theta);
            let tracked = LAW.track(pose, GoalMotion::at_rest(Vector2::zeros()), false);
            let polar = Polar::of(pose, Vector2::zeros());
            let expected = LAW.gains.twist(polar);
            prop_assert!((tracked.twist.v - expected.v).abs() < 1e-12);
            prop_assert!((tracked.twist.omega - expected.omega).abs() < 1e-11);
            let lyapunov = Lyapunov::of(polar, expected);
            prop_assert!((tracked.lyapunov.value - lyapunov.value).abs() < 1e-12);
            prop_assert!((tracked.lyapunov.rate - lyapunov.rate).abs() < 1e-10);
        }

        /// A point on a circle is caught from anywhere, and followed without lag.
        #[test]
        fn catches_a_turning_point(x in -1.0..1.0_f64, y in -1.0..1.0_f64, theta in -PI..PI) {
            let (radius, rate, step) = (0.5, 0.2, 0.01);
            let (mut pose, mut holding, mut last) = (Pose::new(x, y, theta), false, f64::INFINITY);
            for tick in 0..3000 {
                let (sin, cos) = libm::sincos(rate * f64::from(tick) * step);
                let goal = GoalMotion {
                    position: radius * Vector2::new(cos, sin),
                    velocity: radius * rate * Vector2::new(-sin, cos),
                    acceleration: -radius * rate * rate * Vector2::new(cos, sin),
                };
                let tracked = LAW.track(pose, goal, holding);
                (holding, last) = (tracked.holding, tracked.distance);
                pose = pose.advanced(tracked.twist, step);
            }
            prop_assert!(last < 1e-3, "{last}");
        }

        /// At rest under 1 mm of noise the robot neither turns nor drives.
        #[test]
        fn no_spinning_at_rest(noise in proptest::collection::vec((-1e-3..1e-3_f64, -1e-3..1e-3_f64), 50)) {
            let mut holding = true;
            for (x, y) in noise {
                let tracked = LAW.track(Pose::new(0.003 + x, y, 1.0), GoalMotion::at_rest(Vector2::zeros()), holding);
                holding = tracked.holding;
                prop_assert_eq!(tracked.twist, Twist::ZERO);
            }
        }
    }
}
