//! The infrared range sensors of a robot: how far the next thing is along a ray.

use crate::contact::Surroundings;
use crate::ray::{Ray, View};
use trench_radio::NOTHING_IN_RANGE;

/// Directions in which the sensors look, rad from the robot's front, counter-clockwise.
pub const DIRECTIONS: [f64; 4] = [0.0, 0.5 * std::f64::consts::PI, std::f64::consts::PI, 1.5 * std::f64::consts::PI];

/// How far the sensors see, m.
pub const REACH: f64 = 0.8;

/// The readings of robot `index` in cm from its body's surface, [`NOTHING_IN_RANGE`] beyond [`REACH`].
pub(crate) fn readings(surroundings: &Surroundings<'_>, index: usize) -> [u8; DIRECTIONS.len()] {
    let Some(&pose) = surroundings.poses.get(index) else { return [NOTHING_IN_RANGE; DIRECTIONS.len()] };
    let view = View::of(surroundings, index, surroundings.radius + REACH);
    DIRECTIONS.map(|direction| {
        let (sin, cos) = libm::sincos(pose.theta + direction);
        let range = view.range(Ray { origin: [pose.x, pose.y], direction: [cos, sin] }) - surroundings.radius;
        if range.is_finite() { (100.0 * range.max(0.0) + 0.5) as u8 } else { NOTHING_IN_RANGE }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Field, Obstacle, camera};
    use trench_optics::Pose2;

    #[test]
    fn sees_robots_and_obstacles() {
        let theta = 0.5 * std::f64::consts::PI;
        let poses = [Pose2 { x: 1.0, y: 1.0, theta }, Pose2 { x: 1.0, y: 1.5, theta: 0.0 }];
        let corners = vec![[0.6, 0.0], [0.7, 0.0], [0.7, 3.0], [0.6, 3.0]];
        let wall = Obstacle::new(1, camera::Obstacle { corners, radius: 0.0 }, [0.0; 2]);
        let field = Field { width: 3.0, height: 3.0 };
        let surroundings = Surroundings { poses: &poses, obstacles: &[wall], field, radius: 0.08 };
        // Front: 0.5 m to the other's centre; left: the wall's face at 0.7 m; nothing behind and to the right.
        assert_eq!(readings(&surroundings, 0), [34, 22, 255, 255]);
    }
}
