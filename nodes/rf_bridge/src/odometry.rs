//! Wheel odometry from the counters of steps in telemetry.

use trench_radio::{METRES_PER_STEP, Telemetry};

/// Where the steps say the robot is, from where it was first heard.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct WheelOdometry {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) theta: f64,
    /// m/s
    pub(crate) v: f64,
    /// rad/s
    pub(crate) omega: f64,
    last: Option<Counters>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Counters {
    steps: [i32; 2],
    uptime_ms: u32,
}

impl WheelOdometry {
    /// Takes a report. One from a robot that was switched on again moves nothing.
    pub(crate) fn update(&mut self, report: &Telemetry, half_axle: f64) {
        let now = Counters { steps: [report.steps_left, report.steps_right], uptime_ms: report.uptime_ms };
        let last = self.last.replace(now);
        let Some(last) = last.filter(|last| last.uptime_ms < now.uptime_ms) else {
            (self.v, self.omega) = (0.0, 0.0);
            return;
        };
        let [left, right] =
            [0, 1].map(|wheel| f64::from(now.steps[wheel].wrapping_sub(last.steps[wheel])) * METRES_PER_STEP);
        let (length, turn) = (0.5 * (left + right), 0.5 * (right - left) / half_axle);
        // The chord of an arc lies halfway between the headings; over a tenth of a second it is as long as the arc to
        // a hundredth, which is beyond what steps tell.
        let (sin, cos) = libm::sincos(self.theta + 0.5 * turn);
        self.x += length * cos;
        self.y += length * sin;
        self.theta = libm::remainder(self.theta + turn, 2.0 * std::f64::consts::PI);
        let seconds = f64::from(now.uptime_ms - last.uptime_ms) * 1e-3;
        (self.v, self.omega) = (length / seconds, turn / seconds);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(uptime_ms: u32, steps_left: i32, steps_right: i32) -> Telemetry {
        Telemetry { uptime_ms, steps_left, steps_right, ..Telemetry::default() }
    }

    #[test]
    fn adds_up_steps_across_wraps_and_restarts() {
        let mut odometry = WheelOdometry::default();
        odometry.update(&report(1000, i32::MAX, i32::MAX), 0.06);
        assert_eq!((odometry.x, odometry.v), (0.0, 0.0));
        odometry.update(&report(1100, i32::MIN + 99, i32::MIN + 99), 0.06);
        assert!((odometry.x - 100.0 * METRES_PER_STEP).abs() < 1e-12 && odometry.theta == 0.0);
        assert!((odometry.v - 1000.0 * METRES_PER_STEP).abs() < 1e-12);
        odometry.update(&report(50, 0, 0), 0.06);
        assert!((odometry.x - 100.0 * METRES_PER_STEP).abs() < 1e-12 && odometry.v == 0.0);
        odometry.update(&report(150, -100, 100), 0.06);
        assert!((odometry.theta - 100.0 * METRES_PER_STEP / 0.06).abs() < 1e-12);
    }
}
