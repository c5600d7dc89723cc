//! Motion of a robot with two wheels (3.1): exact while both turn at constant speed.

use std::f64::consts::{PI, TAU};
use trench_optics::Pose2;

/// The pose after the wheels rolled `left` and `right` m, `half_axle` m from the centre: a step along a circular arc.
#[must_use]
pub fn rolled(pose: Pose2, left: f64, right: f64, half_axle: f64) -> Pose2 {
    let (length, turn) = (0.5 * (left + right), 0.5 * (right - left) / half_axle);
    // The chord of the arc: its length by sin(x)/x of the half turn, its direction halfway between the headings.
    let half = 0.5 * turn;
    let chord = if half.abs() < 1e-4 { length * (1.0 - half * half / 6.0) } else { length * libm::sin(half) / half };
    let (sin, cos) = libm::sincos(pose.theta + half);
    Pose2 { x: pose.x + chord * cos, y: pose.y + chord * sin, theta: wrapped(pose.theta + turn) }
}

/// The angle in (-pi, pi].
#[must_use]
pub fn wrapped(angle: f64) -> f64 {
    // Nearly every angle is one already.
    if angle.abs() < 3.0 {
        return angle;
    }
    let wrapped = angle - TAU * ((angle + PI) / TAU).floor();
    if wrapped <= -PI { PI } else { wrapped }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn many_steps_end_where_one_does(theta in -3.0..3.0f64, left in -0.3..0.3f64, right in -0.3..0.3f64) {
            let start = Pose2 { x: 1.0, y: -2.0, theta };
            let once = rolled(start, left, right, 0.06);
            let often = (0..1000).fold(start, |pose, _| rolled(pose, left / 1000.0, right / 1000.0, 0.06));
            prop_assert!((once.x - often.x).abs() + (once.y - often.y).abs() < 1e-10);
            prop_assert!(wrapped(once.theta - often.theta).abs() < 1e-10);
        }
    }

    #[test]
    fn a_quarter_circle() {
        // Radius 0.3 m: the left wheel rolls 0.24 pi/2 m, the right one 0.36 pi/2 m.
        let end = rolled(Pose2::default(), 0.12 * PI, 0.18 * PI, 0.06);
        assert!((end.x - 0.3).abs() < 1e-12 && (end.y - 0.3).abs() < 1e-12 && (end.theta - 0.5 * PI).abs() < 1e-12);
    }

    #[test]
    fn angles_wrap() {
        for (angle, expected) in [(0.0, 0.0), (PI, PI), (-PI, PI), (3.5, 3.5 - TAU), (-7.0, -7.0 + TAU)] {
            assert!((wrapped(angle) - expected).abs() < 1e-12, "{angle}");
        }
    }
}
