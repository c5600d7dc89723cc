//! A wheel's stepper motor: what it does when it is told a speed (4.5.2, 4.6.3).
//!
//! A stepper follows at once as long as old and new speed are within its pull-in speed, in either direction. Beyond,
//! rotor and robot must be accelerated: the wheel follows at a ramp, and every step that the motor is told to make and
//! the wheel does not make (or makes without being told, when stopping) is lost. Real motors may fall to standstill
//! altogether when told too much; this model is kinder, and counts.

use trench_radio::METRES_PER_STEP;

/// What the motors can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motor {
    /// MRKIT's.
    Stepper {
        /// Up to this wheel speed in m/s changes are instant.
        pull_in: f64,
        /// Beyond it the wheel speed changes by this much, m/s^2.
        ramp: f64,
    },
    /// Follows any speed at once.
    Ideal,
}

impl Motor {
    /// The test bed's: pull-in speed 0.08 m/s, ramp 0.5 m/s^2.
    pub const HONEST: Self = Self::Stepper { pull_in: 0.08, ramp: 0.5 };

    /// The wheel speed after `dt` seconds of being told `told`, in m/s.
    #[must_use]
    pub fn next_speed(self, speed: f64, told: f64, dt: f64) -> f64 {
        let Self::Stepper { pull_in, ramp } = self else { return told };
        let (slow, told_slow) = (speed.abs() <= pull_in, told.abs() <= pull_in);
        if slow && told_slow {
            return told;
        }
        if slow {
            // Starts with what it can pull in, then ramps up.
            let from = if speed * told > 0.0 { speed.abs().max(pull_in) } else { pull_in };
            return (from + ramp * dt).min(told.abs()).copysign(told);
        }
        if told_slow || speed * told < 0.0 {
            // Ramps down into the pull-in range; from there the next step goes anywhere.
            return (speed.abs() - ramp * dt).max(pull_in.min(speed.abs())).copysign(speed);
        }
        speed + (told - speed).clamp(-ramp * dt, ramp * dt)
    }
}

/// One wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Wheel {
    /// Speed over the floor, m/s.
    pub speed: f64,
    /// Steps it was told to make, forwards positive.
    pub steps: f64,
    /// Steps told and not made, or made and not told.
    pub lost: f64,
}

impl Wheel {
    /// Turns for `dt` seconds while told `told` m/s and missing a share of its steps, and gives the distance in m.
    pub fn turn(&mut self, motor: Motor, told: f64, missing: f64, dt: f64) -> f64 {
        self.speed = motor.next_speed(self.speed, told, dt);
        self.steps += told * dt / METRES_PER_STEP;
        let made = self.speed * (1.0 - missing);
        self.lost += (told - made).abs() * dt / METRES_PER_STEP;
        made * dt
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DT: f64 = 0.001;

    /// The speeds of the next milliseconds.
    fn run(from: f64, told: f64, milliseconds: usize) -> (f64, Wheel) {
        let mut wheel = Wheel { speed: from, ..Wheel::default() };
        let distance = (0..milliseconds).map(|_| wheel.turn(Motor::HONEST, told, 0.0, DT)).sum();
        (distance, wheel)
    }

    #[test]
    fn instant_within_the_pull_in_speed() {
        for (from, told) in [(0.0, 0.08), (0.0, -0.0162), (0.08, -0.08), (-0.05, 0.0)] {
            let (distance, wheel) = run(from, told, 10);
            assert!((distance - told * 0.01).abs() < 1e-15 && wheel.lost == 0.0, "{from} {told}");
        }
    }

    #[test]
    fn ramps_beyond_it_and_loses_steps() {
        let (_, wheel) = run(0.0, 0.28, 200);
        assert!((wheel.speed - 0.18).abs() < 1e-9);
        let (_, wheel) = run(0.0, 0.28, 401);
        assert!((wheel.speed - 0.28).abs() < 1e-9);
        // The area between 0.28 and the ramp: 0.2^2 / (2 0.5) m.
        assert!((wheel.lost * METRES_PER_STEP - 0.04).abs() < 2e-4, "{}", wheel.lost * METRES_PER_STEP);
    }

    #[test]
    fn missed_steps_are_counted_and_not_made() {
        let mut wheel = Wheel::default();
        let distance: f64 = (0..1000).map(|_| wheel.turn(Motor::HONEST, 0.08, 0.25, DT)).sum();
        assert!((distance - 0.06).abs() < 1e-12, "{distance}");
        assert!((wheel.lost * METRES_PER_STEP - 0.02).abs() < 1e-12, "{}", wheel.lost);
    }

    #[test]
    fn stops_on_the_ramp() {
        let (distance, wheel) = run(0.3, 0.0, 1000);
        assert_eq!(wheel.speed, 0.0);
        // (0.3^2 - 0.08^2) / (2 0.5) m on the ramp, then at once.
        assert!((distance - 0.0836).abs() < 3e-4, "{distance}");
    }

    proptest! {
        #[test]
        fn never_faster_than_the_ramp_and_always_arrives(from in -0.3..0.3f64, told in -0.3..0.3f64) {
            let mut speed = from;
            for _ in 0..2000 {
                let next = Motor::HONEST.next_speed(speed, told, DT);
                let beyond = (next.abs() - 0.08).max(0.0) - (speed.abs() - 0.08).max(0.0);
                prop_assert!(beyond.abs() <= 0.5 * DT + 1e-12, "{} to {}", speed, next);
                prop_assert!(speed * next >= 0.0 || speed.abs() <= 0.08);
                speed = next;
            }
            prop_assert!((speed - told).abs() < 1e-12);
        }
    }
}
