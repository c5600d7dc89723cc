//! The colour pad on a robot's top (4.5.3, Figure 4.24): a yellow disc in front, a blue one behind, the axle's centre
//! halfway between them.

use nalgebra::Point2;

/// A robot's place in the map: its axle's centre and heading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose2 {
    /// m
    pub x: f64,
    /// m
    pub y: f64,
    /// rad, in (-pi, pi]
    pub theta: f64,
}

/// The pad's dimensions and those of the robot under it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pad {
    /// Diameter of both discs, m.
    pub disc_diameter: f64,
    /// Between the discs' centres, m.
    pub disc_spacing: f64,
    /// The discs above the floor, m.
    pub height: f64,
    /// Diameter of the robot's body, m.
    pub body_diameter: f64,
}

impl Pad {
    /// The test bed's robots.
    pub const NOMINAL: Self = Self { disc_diameter: 0.065, disc_spacing: 0.077, height: 0.10, body_diameter: 0.16 };

    /// The centres of the yellow and the blue disc of a robot, m, at the pad's height.
    #[must_use]
    pub fn discs(&self, pose: Pose2) -> [Point2<f64>; 2] {
        let half = 0.5 * self.disc_spacing;
        let (dx, dy) = (half * libm::cos(pose.theta), half * libm::sin(pose.theta));
        [Point2::new(pose.x + dx, pose.y + dy), Point2::new(pose.x - dx, pose.y - dy)]
    }

    /// The pose of the robot whose discs' centres are at `yellow` and `blue`, over the full circle of headings.
    #[must_use]
    pub fn pose(yellow: Point2<f64>, blue: Point2<f64>) -> Pose2 {
        Pose2 {
            x: 0.5 * (yellow.x + blue.x),
            y: 0.5 * (yellow.y + blue.y),
            theta: libm::atan2(yellow.y - blue.y, yellow.x - blue.x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn pose_inverts_discs(x in 0.0..3.0_f64, y in 0.0..2.0_f64, theta in -3.0..3.0_f64) {
            let [yellow, blue] = Pad::NOMINAL.discs(Pose2 { x, y, theta });
            let back = Pad::pose(yellow, blue);
            prop_assert!((back.x - x).abs() + (back.y - y).abs() + (back.theta - theta).abs() < 1e-12);
        }
    }
}
