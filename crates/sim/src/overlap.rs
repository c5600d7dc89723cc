//! Bodies that are in each other, in an obstacle or over the field's edge before anything has moved.

use crate::contact::Surroundings;
use crate::{Field, Obstacle, Thing};
use trench_optics::Pose2;

/// Less than this, m, is rounding: bodies may touch.
const ROUNDING: f64 = 1e-9;

/// A body that reaches into something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Index of the robot.
    pub robot: usize,
    /// What it reaches into; of two robots the later one reaches into the earlier.
    pub thing: Thing,
    /// How far, m.
    pub depth: f64,
}

/// All overlaps of robots of one radius (m) at these poses, by robot.
#[must_use]
pub fn overlaps(poses: &[Pose2], obstacles: &[Obstacle], field: Field, radius: f64) -> Vec<Overlap> {
    let surroundings = Surroundings { poses, obstacles, field, radius };
    let of = |robot: usize| {
        let near = surroundings.near(robot, [poses[robot].x, poses[robot].y], -ROUNDING);
        let own = near.filter(move |near| !matches!(near.thing, Thing::Robot(other) if other > robot));
        own.map(move |near| Overlap { robot, thing: near.thing, depth: -near.gap }).collect::<Vec<_>>()
    };
    (0..poses.len()).flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera;

    fn check(poses: &[[f64; 2]], expected: &[(usize, Thing, f64)]) {
        let poses: Vec<Pose2> = poses.iter().map(|&[x, y]| Pose2 { x, y, theta: 0.0 }).collect();
        let disc = Obstacle::new(1, camera::Obstacle { corners: vec![[1.0, 1.0]], radius: 0.2 }, [0.0; 2]);
        let found = overlaps(&poses, &[disc], Field { width: 2.0, height: 2.0 }, 0.1);
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (overlap, (robot, thing, depth)) in found.iter().zip(expected) {
            assert_eq!((overlap.robot, overlap.thing), (*robot, *thing));
            assert!((overlap.depth - depth).abs() < 1e-9, "{overlap:?}");
        }
    }

    #[test]
    fn what_reaches_into_what() {
        check(&[[0.1, 0.1], [0.3, 0.1], [1.0, 1.3]], &[]);
        check(&[[0.5, 0.5], [0.55, 0.5]], &[(1, Thing::Robot(0), 0.15)]);
        check(&[[0.5, 0.5], [0.5, 0.5]], &[(1, Thing::Robot(0), 0.2)]);
        check(&[[1.0, 1.25]], &[(0, Thing::Obstacle(0), 0.05)]);
        check(&[[1.0, 1.0]], &[(0, Thing::Obstacle(0), 0.3)]);
        check(&[[50.0, 0.5]], &[(0, Thing::Edge(1), 48.1)]);
        check(&[[0.0, 1.95]], &[(0, Thing::Edge(0), 0.1), (0, Thing::Edge(3), 0.05)]);
    }
}
