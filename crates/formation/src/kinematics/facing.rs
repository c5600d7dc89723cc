//! Turns a robot at rest the way its formation faces.
//!
//! The laws of chapters 3 to 8 place a point, and leave open which way the robot faces there: on which side of a point before
//! its axle a robot comes to rest hangs on how it came. A differential robot cannot turn about that point on the spot; it
//! turns the short way towards where its axle must be, forwards or backwards, drives there straight, and turns to the heading. Its middle
//! stays within the distance from axle to point of that point.

use super::{Pose, Twist, wrap};
use crate::Vector2;
use core::f64::consts::FRAC_PI_2;

/// rad, from which on it is worth while.
const WORTH: f64 = 0.1;
/// rad, to which a turn is done.
const TURNED: f64 = 0.03;
/// m, to which the way is done.
const THERE: f64 = 0.002;
/// rad/s, of a turn at least and at most: between what steppers follow smoothly and what they start with.
const TURNS: (f64, f64) = (0.3, 0.8);
/// m/s, of the way at least and at most.
const DRIVES: (f64, f64) = (0.018, 0.05);
/// 1/s, by which either slows down towards its end, and a drive keeps its direction.
const GAIN: f64 = 2.0;

/// Such a manoeuvre under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facing {
    /// m, map: where the point before the axle is, and comes back to.
    point: Vector2<f64>,
    /// m, map: where the middle of the axle must be.
    middle: Vector2<f64>,
    /// rad, map: how the robot is to face.
    heading: f64,
    stage: Stage,
}

/// What is done now.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    /// Turns to face so, rad, from where it drives.
    Towards(f64),
    /// Drives, facing so.
    Along(f64),
    /// Turns to the heading.
    Home,
}

impl Facing {
    /// For a robot at `pose` whose law has placed the point `look_ahead` metres before its axle, which is to face along `heading`
    /// (rad, map). None if it does.
    pub fn begin(pose: Pose, look_ahead: f64, heading: f64) -> Option<Self> {
        if wrap(heading - pose.theta).abs() <= WORTH {
            return None;
        }
        let point = pose.position() + look_ahead * pose.heading();
        let middle = point - look_ahead * Pose::new(0.0, 0.0, heading).heading();
        let way = middle - pose.position();
        let stage = if way.norm() <= THERE { Stage::Home } else { Stage::Towards(nearer(pose.theta, way)) };
        Some(Self { point, middle, heading: wrap(heading), stage })
    }

    /// Where the point that the law has placed is, and comes back to, m, map.
    pub fn point(&self) -> Vector2<f64> {
        self.point
    }

    /// What is to be done at `pose`; none when all is done.
    pub fn twist(&mut self, pose: Pose) -> Option<Twist> {
        loop {
            match self.stage {
                Stage::Towards(direction) => match turn(pose.theta, direction) {
                    None => self.stage = Stage::Along(direction),
                    twist => return twist,
                },
                Stage::Along(direction) => {
                    let left = (self.middle - pose.position()).dot(&Pose::new(0.0, 0.0, direction).heading());
                    if left.abs() > THERE {
                        let v = eased(left, DRIVES);
                        return Some(Twist { v, omega: GAIN * wrap(direction - pose.theta) });
                    }
                    self.stage = Stage::Home;
                }
                Stage::Home => return turn(pose.theta, self.heading),
            }
        }
    }
}

/// The direction of `way` or the opposite one, whichever is nearer to `theta`, rad.
fn nearer(theta: f64, way: Vector2<f64>) -> f64 {
    let direction = libm::atan2(way.y, way.x);
    if wrap(direction - theta).abs() > FRAC_PI_2 { wrap(direction + core::f64::consts::PI) } else { direction }
}

/// A turn on the spot from `theta` to `direction`; none if that is done.
fn turn(theta: f64, direction: f64) -> Option<Twist> {
    let left = wrap(direction - theta);
    (left.abs() > TURNED).then(|| Twist { v: 0.0, omega: eased(left, TURNS) })
}

/// A speed towards what is left, slower near its end.
fn eased(left: f64, (least, most): (f64, f64)) -> f64 {
    (GAIN * left.abs()).clamp(least, most).copysign(left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STEP: f64 = 1.0 / 30.0;

    proptest! {
        /// From any pose, to any heading: in ten seconds, to 3 mm and 0.04 rad, and never farther from the point than the axle was.
        #[test]
        fn a_robot_faces_as_it_shall_with_its_point_where_it_was(
            (x, y, theta) in (-2.0..2.0_f64, -2.0..2.0_f64, -3.2..3.2_f64), heading in -9.0..9.0_f64, look_ahead in prop_oneof![Just(0.0), 0.01..0.1_f64],
        ) {
            let mut pose = Pose::new(x, y, theta);
            let point = pose.position() + look_ahead * pose.heading();
            let Some(mut facing) = Facing::begin(pose, look_ahead, heading) else {
                prop_assert!(wrap(heading - theta).abs() <= WORTH + 1e-9);
                return Ok(());
            };
            prop_assert_eq!(facing.point(), point);
            let mut steps = 0;
            while let Some(twist) = facing.twist(pose) {
                pose = pose.advanced(twist, STEP);
                prop_assert!((pose.position() - point).norm() <= look_ahead + 0.004);
                steps += 1;
                prop_assert!(steps < 400, "{facing:?} at {pose:?}");
            }
            prop_assert!((pose.position() + look_ahead * pose.heading() - point).norm() < 0.003 + 0.04 * look_ahead);
            prop_assert!(wrap(heading - pose.theta).abs() < 0.04);
        }
    }
}
