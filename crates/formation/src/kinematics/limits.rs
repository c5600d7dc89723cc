//! Limits of the wheels as pure functions that say whether they acted.
use super::Wheels;

/// A value after a limit, and whether the limit changed it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limited<T> {
    /// What is left.
    pub value: T,
    /// Whether it differs from what was asked for.
    pub acted: bool,
}

/// Slows both wheels by one factor until neither exceeds `max_speed` (m/s): the robot keeps its path, v/omega, and is
/// late instead. (The thesis's bed clipped each wheel by itself, which bends the path.)
pub fn saturate(wheels: Wheels, max_speed: f64) -> Limited<Wheels> {
    let peak = wheels.peak();
    if peak <= max_speed {
        return Limited { value: wheels, acted: false };
    }
    Limited { value: wheels.scaled(max_speed / peak), acted: true }
}

/// What a stepper can follow without missing steps (4.6.3): it starts, stops and reverses at once below the pull-in
/// speed, and changes by a bounded acceleration above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    /// m/s; 0 for motors without this freedom.
    pub pull_in_speed: f64,
    /// m/s^2.
    pub acceleration: f64,
}

impl Ramp {
    /// The wheel speeds nearest to `wanted` that can be reached from `current` within `duration` (s).
    ///
    /// As long as some common scale of both wanted speeds is reachable, the largest one (at most 1) is taken: the
    /// curvature is the wanted one, while braking too. Otherwise each wheel goes as far as it can, and the curvature
    /// catches up with the next calls; no wheel passes what was wanted of it.
    pub fn limit(self, current: Wheels, wanted: Wheels, duration: f64) -> Limited<Wheels> {
        let left = self.followable(current.left, duration);
        let right = self.followable(current.right, duration);
        if left.contains(wanted.left) && right.contains(wanted.right) {
            return Limited { value: wanted, acted: false };
        }
        let (left_scales, right_scales) = (left.divided_by(wanted.left), right.divided_by(wanted.right));
        let scale = 1.0_f64.min(left_scales.high).min(right_scales.high);
        let value = if scale >= left_scales.low && scale >= right_scales.low {
            wanted.scaled(scale)
        } else {
            Wheels { left: left.nearest_to(wanted.left), right: right.nearest_to(wanted.right) }
        };
        Limited { value, acted: true }
    }

    /// The wheel speeds nearest to `wanted` that can be told to motors that run at `current` (m/s) for `duration` (s) without missing
    /// steps: each wheel goes as far as it can, whatever that does to the curvature.
    #[must_use]
    pub fn limit_each(self, current: Wheels, wanted: Wheels, duration: f64) -> Wheels {
        Wheels {
            left: self.followable(current.left, duration).nearest_to(wanted.left),
            right: self.followable(current.right, duration).nearest_to(wanted.right),
        }
    }

    /// The wheel speeds `duration` (s) after motors that ran at `current` were told `told`, steps missed or not. What a robot does
    /// that is told more than it can follow.
    #[must_use]
    pub fn reached(self, current: Wheels, told: Wheels, duration: f64) -> Wheels {
        Wheels {
            left: self.reachable(current.left, duration).nearest_to(told.left),
            right: self.reachable(current.right, duration).nearest_to(told.right),
        }
    }

    /// How far the centre of the robot travels at most until both wheels rest, m, when each brakes as it can, which is what
    /// [`Self::limit`] makes of a wish for rest: (v_L^2 + v_R^2)/(4 a). In a curve that is more than v^2/(2 a) of the centre.
    pub fn stopping_distance(self, current: Wheels) -> f64 {
        (current.left * current.left + current.right * current.right) / (4.0 * self.acceleration)
    }

    /// The speeds that a wheel can be told for `duration` and misses no more steps than on the ramp itself.
    ///
    /// A motor that is told `u` while it ramps from `speed` to the pull-in speed `p` within the time `(speed - p)/a` turns too far by
    /// `(speed - p)/a ((speed + p)/2 - u)`; told the ramp's next speed, by `a duration^2/2`. So a wheel that is just above `p` may be
    /// told anything within `+-p`, and one that needs all the time to come down to it only `p`: it reverses a step later.
    fn followable(self, speed: f64, duration: f64) -> Interval {
        let change = self.acceleration * duration;
        let beyond = speed.abs() - self.pull_in_speed;
        let reach = self.reachable(speed, duration);
        if beyond <= 0.0 {
            return reach;
        }
        let slowest = 0.5 * (speed.abs() + self.pull_in_speed - change * change / beyond);
        if speed > 0.0 {
            Interval { low: reach.low.max(slowest), ..reach }
        } else {
            Interval { high: reach.high.min(-slowest), ..reach }
        }
    }

    /// The speeds that a wheel can have after `duration`: one that comes down to the pull-in speed within the time has its freedom
    /// from there on.
    fn reachable(self, speed: f64, duration: f64) -> Interval {
        let change = self.acceleration * duration;
        let (low, high) = (speed - change, speed + change);
        Interval {
            low: if low <= self.pull_in_speed { low.min(-self.pull_in_speed) } else { low },
            high: if high >= -self.pull_in_speed { high.max(self.pull_in_speed) } else { high },
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    fn nearest_to(self, value: f64) -> f64 {
        value.max(self.low).min(self.high)
    }

    /// All s with s * divisor in the interval; a zero divisor allows every s or none.
    fn divided_by(self, divisor: f64) -> Self {
        if divisor == 0.0 {
            return if self.contains(0.0) {
                Self { low: f64::NEG_INFINITY, high: f64::INFINITY }
            } else {
                Self { low: f64::INFINITY, high: f64::NEG_INFINITY }
            };
        }
        let (a, b) = (self.low / divisor, self.high / divisor);
        Self { low: a.min(b), high: a.max(b) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STEPPER: Ramp = Ramp { pull_in_speed: 0.08, acceleration: 0.5 };

    fn check(current: (f64, f64), wanted: (f64, f64), expected: (f64, f64), acted: bool) {
        let wheels = |(left, right)| Wheels { left, right };
        let limited = STEPPER.limit(wheels(current), wheels(wanted), 0.04);
        assert!((limited.value.left - expected.0).abs() < 1e-12, "{limited:?}");
        assert!((limited.value.right - expected.1).abs() < 1e-12, "{limited:?}");
        assert_eq!(limited.acted, acted);
    }

    #[test]
    fn each_wheel_goes_as_far_as_it_can() {
        let (current, told) = (Wheels { left: 0.2, right: 0.1 }, Wheels { left: -0.15, right: 0.15 });
        let reached = STEPPER.reached(current, told, 0.04);
        assert!((reached.left - 0.18).abs() < 1e-12 && (reached.right - 0.12).abs() < 1e-12, "{reached:?}");
        assert_eq!(STEPPER.reached(reached, reached, 0.0), reached);
    }

    #[test]
    fn ramps() {
        check((0.0, 0.0), (0.08, -0.08), (0.08, -0.08), false);
        check((0.0, 0.0), (0.1, 0.2), (0.04, 0.08), true);
        check((0.2, 0.2), (-0.2, -0.2), (0.18, 0.18), true);
        check((0.081, 0.081), (-0.2, -0.2), (-0.08, -0.08), true);
        check((0.09, 0.09), (-0.2, -0.2), (0.065, 0.065), true);
        check((-0.09, -0.09), (0.2, 0.2), (-0.065, -0.065), true);
        check((0.1, 0.1), (-0.2, -0.2), (0.08, 0.08), true);
        check((0.2, 0.2), (0.0, 0.0), (0.18, 0.18), true);
        check((0.2, 0.2), (0.1, 0.2), (0.18, 0.2), true);
    }

    #[test]
    fn saturation_keeps_the_curvature() {
        let limited = saturate(Wheels { left: 0.2, right: -0.6 }, 0.3);
        assert!((limited.value.left - 0.1).abs() < 1e-15 && (limited.value.right + 0.3).abs() < 1e-15);
        assert!(limited.acted);
        assert!(!saturate(Wheels { left: 0.3, right: -0.3 }, 0.3).acted);
    }

    proptest! {
        /// The path of a stop is no longer than said, and for wheels that turn one way no shorter either.
        #[test]
        fn stopping_distance_is_the_path_of_a_stop(left in -0.3..0.3_f64, right in -0.3..0.3_f64) {
            let motor = Ramp { pull_in_speed: 0.0, acceleration: 0.5 };
            let (mut wheels, mut path, step) = (Wheels { left, right }, 0.0, 1e-3);
            let expected = motor.stopping_distance(wheels);
            while wheels != Wheels::ZERO {
                path += 0.5 * (wheels.left + wheels.right).abs() * step;
                wheels = motor.limit(wheels, Wheels::ZERO, step).value;
            }
            prop_assert!(path <= expected + 5e-4);
            prop_assert!(left * right < 0.0 || path >= expected - 5e-4);
        }

        #[test]
        fn every_step_is_followable_and_the_wish_is_reached(
            l in -0.3..0.3_f64, r in -0.3..0.3_f64, wl in -0.3..0.3_f64, wr in -0.3..0.3_f64,
        ) {
            let (mut current, wanted) = (Wheels { left: l, right: r }, Wheels { left: wl, right: wr });
            for _ in 0..40 {
                let next = STEPPER.limit(current, wanted, 0.04).value;
                for (from, to) in [(current.left, next.left), (current.right, next.right)] {
                    let beyond = (to.abs() - 0.08).max(0.0) - (from.abs() - 0.08).max(0.0);
                    prop_assert!(beyond.abs() <= 0.02 + 1e-12);
                    prop_assert!(from * to >= 0.0 || to.abs() <= 0.08 + 1e-12);
                }
                current = next;
            }
            prop_assert!((current.left - wl).abs() < 1e-9 && (current.right - wr).abs() < 1e-9);
        }
    }
}
