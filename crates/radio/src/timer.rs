//! Wheel timers: how the MRKIT robot's stepper motors are told their speed (4.5.2).
//!
//! A wheel of diameter D = 54 mm makes N = 400 steps a revolution, one every P = T 10^-6 / 2.5 seconds, so that
//! V = D pi / (N P) = 1060.288 / T in m/s with the 16-bit timer value T.

use crate::PacketError;

/// V T in m/s: wheel speed times timer value.
pub const SPEED_TIMES_TIMER: f64 = 1060.288;

/// The timer value of the fastest speed, 0.29994 m/s.
pub const TIMER_FASTEST: u16 = 3535;

/// The timer value of the slowest speed, 0.0162 m/s. A larger value stops the wheel.
pub const TIMER_SLOWEST: u16 = 65450;

/// How far one step moves the wheel, in m: V P, whatever T is.
pub const METRES_PER_STEP: f64 = SPEED_TIMES_TIMER * 1e-6 / 2.5;

/// A wheel's signed timer value: zero stands still, a negative value turns backwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WheelTimer(i32);

impl WheelTimer {
    /// Stands still.
    pub const STOP: Self = Self(0);

    /// The timer value whose speed is nearest to `speed` in m/s. Faster than the fastest gives the fastest; slower than
    /// the slowest, and whatever is not a number, stops the wheel.
    #[must_use]
    pub fn from_speed(speed: f64) -> Self {
        let magnitude = round_positive(SPEED_TIMES_TIMER / speed.abs());
        // A number that is none never turns a wheel.
        if magnitude.is_nan() || magnitude > f64::from(TIMER_SLOWEST) {
            return Self::STOP;
        }
        let timer = (magnitude as i32).max(i32::from(TIMER_FASTEST));
        Self(if speed < 0.0 { -timer } else { timer })
    }

    /// The wheel's speed in m/s.
    #[must_use]
    pub fn speed(self) -> f64 {
        if self.0 == 0 { 0.0 } else { SPEED_TIMES_TIMER / f64::from(self.0) }
    }

    /// Whether the wheel turns backwards.
    #[must_use]
    pub fn is_reverse(self) -> bool {
        self.0 < 0
    }

    /// The value in the 16 bits of the wire: zero stands still.
    #[must_use]
    pub fn magnitude(self) -> u16 {
        self.0.unsigned_abs() as u16
    }

    /// Reads the 16 bits of the wire and the direction bit.
    ///
    /// # Errors
    /// When the value asks for more than the fastest speed.
    pub fn from_wire(magnitude: u16, reverse: bool) -> Result<Self, PacketError> {
        match magnitude {
            0 => Ok(Self::STOP),
            1..TIMER_FASTEST => Err(PacketError::Timer(magnitude)),
            TIMER_FASTEST..=TIMER_SLOWEST => {
                let timer = i32::from(magnitude);
                Ok(Self(if reverse { -timer } else { timer }))
            }
            _ => Ok(Self::STOP),
        }
    }
}

/// Rounds a number that is positive, or too large for any timer, to the nearest integer.
fn round_positive(value: f64) -> f64 {
    // `f64::floor` is exact on every machine (an IEEE operation), so that no library function is needed.
    (value + 0.5).floor()
}

/// The timers of both wheels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Wheels {
    /// The left wheel's.
    pub left: WheelTimer,
    /// The right wheel's.
    pub right: WheelTimer,
}

impl Wheels {
    /// Stands still.
    pub const STOP: Self = Self { left: WheelTimer::STOP, right: WheelTimer::STOP };
}

/// The wheel speeds (left, right) in m/s of a robot whose centre moves at `v` m/s and turns at `omega` rad/s, its wheels
/// `half_axle` m from the centre.
#[must_use]
pub fn wheel_speed(v: f64, omega: f64, half_axle: f64) -> (f64, f64) {
    (v - omega * half_axle, v + omega * half_axle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn timer_values_of_speeds() {
        let check =
            |speed: f64, expected: i32| assert_eq!(WheelTimer::from_speed(speed), WheelTimer(expected), "{speed}");
        check(0.0, 0);
        check(0.2, 5301);
        check(-0.2, -5301);
        check(0.299_94, 3535);
        check(5.0, 3535);
        check(f64::NEG_INFINITY, -3535);
        check(0.016_200, 65450);
        check(0.016_199, 0);
        check(-0.001, 0);
        check(f64::NAN, 0);
    }

    #[test]
    fn limits_of_the_thesis() {
        assert!((WheelTimer::from_speed(1.0).speed() - 0.299_94).abs() < 1e-5);
        assert!((WheelTimer(65450).speed() - 0.0162).abs() < 1e-6);
        let circumference = 0.054 * std::f64::consts::PI;
        assert!((METRES_PER_STEP * 400.0 - circumference).abs() < 1e-7);
    }

    #[test]
    fn wire_values() {
        let check = |magnitude, reverse, expected| assert_eq!(WheelTimer::from_wire(magnitude, reverse), expected);
        check(0, true, Ok(WheelTimer::STOP));
        check(1, false, Err(PacketError::Timer(1)));
        check(3534, false, Err(PacketError::Timer(3534)));
        check(3535, true, Ok(WheelTimer(-3535)));
        check(65450, false, Ok(WheelTimer(65450)));
        check(65451, false, Ok(WheelTimer::STOP));
        check(u16::MAX, true, Ok(WheelTimer::STOP));
    }

    proptest! {
        #[test]
        fn quantisation_errs_by_half_a_timer_unit(speed in 0.0162..0.29994f64) {
            let timer = WheelTimer::from_speed(speed);
            let value = f64::from(timer.magnitude());
            let half_unit = SPEED_TIMES_TIMER / value - SPEED_TIMES_TIMER / (value + 0.5);
            prop_assert!((timer.speed() - speed).abs() <= half_unit * 1.001);
            prop_assert_eq!(WheelTimer::from_speed(-speed).speed(), -timer.speed());
            prop_assert_eq!(WheelTimer::from_wire(timer.magnitude(), false), Ok(timer));
        }

        #[test]
        fn any_number_gives_an_admissible_timer(bits: u64) {
            let timer = WheelTimer::from_speed(f64::from_bits(bits));
            prop_assert!(timer == WheelTimer::STOP || (TIMER_FASTEST..=TIMER_SLOWEST).contains(&timer.magnitude()));
        }
    }
}
