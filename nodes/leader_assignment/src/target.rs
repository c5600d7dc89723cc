//! The target as it is believed: what it says of itself, unless that cannot be.

use crate::Carrier;
use std::fmt;
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::kinematics::wrap;
use trench_msgs::nav_msgs::Odometry;

/// A stamp may be this far ahead of our clock, s.
const CLOCK_ERROR: f64 = 0.05;

/// Largest turn between two messages beside what the turn rate explains, rad.
const TURN: f64 = 0.6;

/// What a target can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TargetLimits {
    /// m/s.
    pub speed: f64,
    /// m, between two messages, beside what its speed explains.
    pub jump: f64,
    /// s, silence after which nobody knows where it is.
    pub age: f64,
    /// Whether formations turn with it.
    pub turns: bool,
}

/// Why a message about the target is not believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TargetRefusal {
    /// A number that is none.
    NotFinite,
    /// It is this much (s) older than what is known, or than our clock by more than the age limit.
    Old(f64),
    /// From the future, s.
    Future(f64),
    /// Faster than targets are, m/s.
    Fast(f64),
    /// A jump, m.
    Jump(f64),
    /// A sudden turn, rad.
    Turn(f64),
}

impl fmt::Display for TargetRefusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the target is not believed: ")?;
        match self {
            Self::NotFinite => write!(formatter, "a number is not finite"),
            Self::Old(age) => write!(formatter, "the message is {age:.3} s too old"),
            Self::Future(ahead) => write!(formatter, "the message is {ahead:.3} s from the future"),
            Self::Fast(speed) => write!(formatter, "it says it moves at {speed:.2} m/s, more than target.speed"),
            Self::Jump(distance) => write!(formatter, "it jumped by {distance:.2} m, more than target.jump"),
            Self::Turn(angle) => write!(formatter, "it turned by {angle:.2} rad at once"),
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Known {
    heard: Steady,
    stamp: RosTime,
    carrier: Carrier,
}

/// The target, followed from message to message. What cannot be is refused, and the last believed motion goes on until it
/// is too old; then the formation stops until the target is where it was to be expected, or [`Target::forget`].
#[derive(Debug, Clone)]
pub struct Target {
    limits: TargetLimits,
    known: Option<Known>,
}

impl Target {
    /// A target that nothing is known of.
    #[must_use]
    pub fn new(limits: TargetLimits) -> Self {
        Self { limits, known: None }
    }

    /// Changes what it can do.
    pub fn set_limits(&mut self, limits: TargetLimits) {
        self.limits = limits;
    }

    /// The next message is believed wherever it is: robots are at rest, or the operator said so.
    pub fn forget(&mut self) {
        self.known = None;
    }

    /// [`Target::forget`] where it is silent already.
    pub fn forget_if_silent(&mut self, now: Steady) {
        if self.known.is_some_and(|known| now.seconds_since(known.heard) > self.limits.age) {
            self.forget();
        }
    }

    /// Hears of the target. A message without a stamp is of this moment.
    ///
    /// # Errors
    /// Why it is not believed.
    pub fn hear(&mut self, at: Times, odometry: &Odometry) -> Result<(), TargetRefusal> {
        let stamp = RosTime::from(&odometry.header.stamp);
        let stamp = if stamp.0 == 0 { at.ros } else { stamp };
        self.believe(at, stamp, carrier_of(odometry, self.limits.turns))
    }

    /// As [`Target::hear`], of a frame that is known otherwise: a robot's.
    ///
    /// # Errors
    /// Why it is not believed.
    pub fn believe(&mut self, at: Times, stamp: RosTime, carrier: Carrier) -> Result<(), TargetRefusal> {
        let TargetLimits { speed, jump, age, .. } = self.limits;
        let sum = carrier.position + carrier.velocity;
        if !(sum.x + sum.y + carrier.theta + carrier.omega).is_finite() {
            return Err(TargetRefusal::NotFinite);
        }
        let lag = at.ros.seconds_since(stamp);
        if lag < -CLOCK_ERROR {
            return Err(TargetRefusal::Future(-lag));
        }
        if lag > age {
            return Err(TargetRefusal::Old(lag));
        }
        if carrier.velocity.norm() > speed {
            return Err(TargetRefusal::Fast(carrier.velocity.norm()));
        }
        if let Some(known) = self.known {
            let elapsed = stamp.seconds_since(known.stamp);
            if elapsed < 0.0 {
                return Err(TargetRefusal::Old(-elapsed));
            }
            let expected = known.carrier.after(elapsed);
            let distance = (carrier.position - expected.position).norm();
            if distance > jump + speed * elapsed {
                return Err(TargetRefusal::Jump(distance));
            }
            let turn = wrap(carrier.theta - expected.theta).abs();
            if turn > TURN {
                return Err(TargetRefusal::Turn(turn));
            }
        }
        self.known = Some(Known { heard: at.steady, stamp, carrier });
        Ok(())
    }

    /// Its frame at `stamp`; none once it has been silent for too long.
    #[must_use]
    pub fn at(&self, now: Steady, stamp: RosTime) -> Option<Carrier> {
        let known = self.known.filter(|known| now.seconds_since(known.heard) <= self.limits.age)?;
        let elapsed = stamp.seconds_since(known.stamp).clamp(-self.limits.age, self.limits.age);
        Some(known.carrier.after(elapsed))
    }
}

/// The target's frame from its odometry; the twist of an Odometry is in the target's own frame. `turns`: whether the
/// formation's axes are the target's, or the map's.
fn carrier_of(odometry: &Odometry, turns: bool) -> Carrier {
    let orientation = &odometry.pose.pose.orientation;
    let theta = 2.0 * libm::atan2(orientation.z, orientation.w);
    let (sin, cos) = libm::sincos(theta);
    let twist = &odometry.twist.twist;
    let (ahead, aside) = (twist.linear.x, twist.linear.y);
    let position = Vector2::new(odometry.pose.pose.position.x, odometry.pose.pose.position.y);
    let velocity = Vector2::new(cos * ahead - sin * aside, sin * ahead + cos * aside);
    Carrier::moving(position, theta, velocity, twist.angular.z, turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: TargetLimits = TargetLimits { speed: 1.0, jump: 0.2, age: 0.5, turns: true };

    fn at(seconds: f64) -> Times {
        Times { ros: RosTime(0).plus_seconds(seconds), steady: Steady(0).plus_seconds(seconds) }
    }

    fn odometry(stamp: f64, x: f64, speed: f64) -> Odometry {
        let mut odometry = Odometry::default();
        odometry.header.stamp = at(stamp).ros.into();
        odometry.pose.pose.position.x = x;
        odometry.twist.twist.linear.x = speed;
        odometry
    }

    #[test]
    fn a_jump_of_ten_metres_is_not_believed() {
        let mut target = Target::new(LIMITS);
        assert_eq!(target.hear(at(1.0), &odometry(1.0, 2.0, 0.1)), Ok(()));
        let refusal = target.hear(at(1.1), &odometry(1.1, 12.0, 0.1)).unwrap_err();
        assert!(refusal.to_string().contains("jumped by 9.99 m"), "{refusal}");
        let goes_on = target.at(at(1.2).steady, at(1.2).ros).unwrap();
        assert!((goes_on.position.x - 2.02).abs() < 1e-9, "the last believed motion goes on: {goes_on:?}");
        assert!(target.at(at(1.6).steady, at(1.6).ros).is_none(), "and ends");
        target.forget();
        assert_eq!(target.hear(at(1.7), &odometry(1.7, 12.0, 0.1)), Ok(()));
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let check = |stamp: f64, x: f64, speed: f64, expected: &str| {
            let mut target = Target::new(LIMITS);
            target.hear(at(1.0), &odometry(1.0, 0.0, 0.0)).unwrap();
            let refusal = target.hear(at(1.1), &odometry(stamp, x, speed)).unwrap_err().to_string();
            assert!(refusal.contains(expected), "{refusal}");
        };
        check(0.9, 0.0, 0.0, "too old");
        check(0.2, 0.0, 0.0, "too old");
        check(2.0, 0.0, 0.0, "from the future");
        check(1.1, f64::NAN, 0.0, "not finite");
        check(1.1, 0.0, 5.0, "5.00 m/s");
    }

    #[test]
    fn a_message_without_a_stamp_is_of_now() {
        let mut target = Target::new(LIMITS);
        assert_eq!(target.hear(at(50.0), &odometry(0.0, 1.0, 0.0)), Ok(()));
        assert!(target.at(at(50.1).steady, at(50.1).ros).is_some());
    }
}
