//! The infrared range sensors of a robot: how far the next thing is along a ray.

use crate::Thing;
use crate::contact::Surroundings;
use trench_optics::Pose2;
use trench_radio::NOTHING_IN_RANGE;

/// Directions in which the sensors look, rad from the robot's front, counter-clockwise.
pub const DIRECTIONS: [f64; 4] = [0.0, 0.5 * std::f64::consts::PI, std::f64::consts::PI, 1.5 * std::f64::consts::PI];

/// How far the sensors see, m.
pub const REACH: f64 = 0.8;

/// The readings of robot `index` in cm from its body's surface, [`NOTHING_IN_RANGE`] beyond [`REACH`].
pub(crate) fn readings(surroundings: &Surroundings<'_>, index: usize) -> [u8; DIRECTIONS.len()] {
    let Some(&pose) = surroundings.poses.get(index) else { return [NOTHING_IN_RANGE; DIRECTIONS.len()] };
    DIRECTIONS.map(|direction| match reading(surroundings, index, pose, direction) {
        Some(range) => (100.0 * range + 0.5) as u8,
        None => NOTHING_IN_RANGE,
    })
}

/// Walks along the ray by the distance to the nearest thing, which can never jump over one (sphere tracing).
fn reading(surroundings: &Surroundings<'_>, index: usize, pose: Pose2, direction: f64) -> Option<f64> {
    let (sin, cos) = libm::sincos(pose.theta + direction);
    let radius = surroundings.radius;
    let mut range = 0.0;
    for _ in 0..64 {
        let point = [pose.x + (radius + range) * cos, pose.y + (radius + range) * sin];
        // Gaps are those of a body around the point: a radius more than those of the point, but for the field's edge,
        // which is no wall: sensors see nothing there.
        let things = surroundings.near(index, point, REACH).filter(|near| !matches!(near.thing, Thing::Edge(_)));
        let distance = things.map(|near| near.gap + radius).fold(REACH, f64::min);
        if distance < 0.002 {
            return Some(range);
        }
        range += distance;
        if range > REACH {
            return None;
        }
    }
    Some(range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Field, Obstacle, camera};

    #[test]
    fn sees_robots_and_obstacles() {
        let theta = 0.5 * std::f64::consts::PI;
        let poses = [Pose2 { x: 1.0, y: 1.0, theta }, Pose2 { x: 1.0, y: 1.5, theta: 0.0 }];
        let wall = Obstacle {
            outline: camera::Obstacle { corners: vec![[0.6, 0.0], [0.7, 0.0], [0.7, 3.0], [0.6, 3.0]], radius: 0.0 },
            ..Obstacle::default()
        };
        let field = Field { width: 3.0, height: 3.0 };
        let surroundings = Surroundings { poses: &poses, obstacles: &[wall], field, radius: 0.08 };
        // Front: 0.5 m to the other's centre; left: the wall's face at 0.7 m; nothing behind and to the right.
        assert_eq!(readings(&surroundings, 0), [34, 22, 255, 255]);
    }
}
