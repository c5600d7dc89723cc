//! Bodies block each other: no robot moves into another, into an obstacle, or over the field's edge.

use crate::Obstacle;
use trench_optics::Pose2;

/// The rectangle in which robots stay: x from 0 to `width`, y from 0 to `height`, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// m
    pub width: f64,
    /// m
    pub height: f64,
}

/// What a robot runs into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    /// Another robot, by its index.
    Robot(usize),
    /// An obstacle, by its index.
    Obstacle(usize),
    /// The edge of the field: west, east, south, north.
    Edge(u8),
}

/// A thing near a robot: the gap between the surfaces in m, and the unit vector away from the thing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Near {
    pub(crate) thing: Thing,
    pub(crate) gap: f64,
    pub(crate) away: [f64; 2],
}

/// Everything a robot could run into.
pub(crate) struct Surroundings<'a> {
    pub(crate) poses: &'a [Pose2],
    pub(crate) obstacles: &'a [Obstacle],
    pub(crate) field: Field,
    /// Of every robot's body, m.
    pub(crate) radius: f64,
}

impl Surroundings<'_> {
    /// The gaps of robot `index` if its centre were at `point`, to whatever is nearer than `reach`.
    pub(crate) fn near(&self, index: usize, point: [f64; 2], reach: f64) -> impl Iterator<Item = Near> {
        // Robots and obstacles that are clearly farther need no root; the last filter compares exactly.
        let clearly = (reach + 2.0 * self.radius) * (1.0 + 1e-9);
        let others = self.poses.iter().enumerate().filter(move |(other, _)| *other != index);
        let robots = others.filter_map(move |(other, pose)| {
            let offset = [point[0] - pose.x, point[1] - pose.y];
            let square = offset[0] * offset[0] + offset[1] * offset[1];
            if square > clearly * clearly {
                return None;
            }
            let distance = square.sqrt();
            let away = if distance > 0.0 { [offset[0] / distance, offset[1] / distance] } else { [1.0, 0.0] };
            Some(Near { thing: Thing::Robot(other), gap: distance - 2.0 * self.radius, away })
        });
        let obstacles = self.obstacles.iter().enumerate().filter_map(move |(number, obstacle)| {
            let (clearance, away) = obstacle.clearance_within(point, clearly)?;
            Some(Near { thing: Thing::Obstacle(number), gap: clearance - self.radius, away })
        });
        let [x, y] = point;
        let edges = [
            (x, [1.0, 0.0]),
            (self.field.width - x, [-1.0, 0.0]),
            (y, [0.0, 1.0]),
            (self.field.height - y, [0.0, -1.0]),
        ];
        let edges = (0..).zip(edges).map(|(side, (inside, away))| Near {
            thing: Thing::Edge(side),
            gap: inside - self.radius,
            away,
        });
        robots.chain(obstacles).chain(edges).filter(move |near| near.gap < reach)
    }

    /// How far robot `index` gets of the way from `from` to `to` (both m): along what is in the way, and not at all
    /// where two things are. `touched` is told what stopped it.
    pub(crate) fn blocked(
        &self,
        index: usize,
        from: [f64; 2],
        to: [f64; 2],
        mut touched: impl FnMut(Thing),
    ) -> [f64; 2] {
        let mut step = [to[0] - from[0], to[1] - from[1]];
        let reach = step[0].abs() + step[1].abs();
        if reach == 0.0 {
            return from;
        }
        let (mut free, mut before) = (true, 0.0_f64);
        for near in self.near(index, from, reach) {
            free = false;
            before = before.min(near.gap);
            let towards = step[0] * near.away[0] + step[1] * near.away[1];
            if towards < 0.0 && near.gap + towards < 0.0 {
                touched(near.thing);
                step = [step[0] - towards * near.away[0], step[1] - towards * near.away[1]];
            }
        }
        let end = [from[0] + step[0], from[1] + step[1]];
        if free {
            return end;
        }
        let deeper = self.near(index, end, reach).any(|near| near.gap < before - 1e-12);
        if deeper { from } else { end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(from: [f64; 2], to: [f64; 2], expected: [f64; 2], expected_things: &[Thing]) {
        let poses = [Pose2::default(), Pose2 { x: 1.0, y: 1.0, theta: 0.0 }];
        let surroundings =
            Surroundings { poses: &poses, obstacles: &[], field: Field { width: 2.0, height: 2.0 }, radius: 0.1 };
        let mut things = Vec::new();
        let end = surroundings.blocked(0, from, to, |thing| things.push(thing));
        assert!((end[0] - expected[0]).abs() + (end[1] - expected[1]).abs() < 1e-12, "{end:?}");
        assert_eq!(things, expected_things);
    }

    #[test]
    fn motion_into_things_is_stopped_motion_along_them_is_not() {
        check([0.5, 0.5], [0.51, 0.51], [0.51, 0.51], &[]);
        check([0.801, 1.0], [0.803, 1.001], [0.801, 1.001], &[Thing::Robot(1)]);
        check([0.801, 1.0], [0.799, 1.0], [0.799, 1.0], &[]);
        check([0.101, 1.5], [0.099, 1.502], [0.101, 1.502], &[Thing::Edge(0)]);
        check([0.1, 0.1], [0.099, 0.098], [0.1, 0.1], &[Thing::Edge(0), Thing::Edge(2)]);
        check([1.5, 1.9], [1.5, 1.901], [1.5, 1.9], &[Thing::Edge(3)]);
    }

    #[test]
    fn who_overlaps_gets_free_but_not_deeper() {
        check([0.9, 1.0], [0.899, 1.0], [0.899, 1.0], &[]);
        check([0.9, 1.0], [0.901, 1.0], [0.9, 1.0], &[Thing::Robot(1)]);
    }
}
