//! What a ray of light meets first: obstacles and robots' bodies. The field's edge is no wall.

use crate::Obstacle;
use crate::contact::Surroundings;

/// A half-line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// m
    pub(crate) origin: [f64; 2],
    /// Of length 1.
    pub(crate) direction: [f64; 2],
}

/// What a robot may see: everything within reach but itself.
pub(crate) struct View<'a> {
    obstacles: Vec<&'a Obstacle>,
    /// The other robots' centres, m.
    bodies: Vec<[f64; 2]>,
    /// Of a body, m.
    radius: f64,
    reach: f64,
}

impl<'a> View<'a> {
    /// What is within `reach` (m) of robot `index`.
    pub(crate) fn of(surroundings: &Surroundings<'a>, index: usize, reach: f64) -> Self {
        let place = surroundings.poses.get(index).copied().unwrap_or_default();
        let near = |centre: [f64; 2], radius: f64| {
            let offset = [centre[0] - place.x, centre[1] - place.y];
            offset[0] * offset[0] + offset[1] * offset[1] < (reach + radius) * (reach + radius)
        };
        let others = surroundings.poses.iter().enumerate().filter(|(other, _)| *other != index);
        let bodies = others.map(|(_, pose)| [pose.x, pose.y]).filter(|centre| near(*centre, surroundings.radius));
        let obstacles = surroundings.obstacles.iter().filter(|obstacle| {
            let (centre, radius) = obstacle.circle();
            near(centre, radius)
        });
        Self { bodies: bodies.collect(), obstacles: obstacles.collect(), radius: surroundings.radius, reach }
    }

    /// The distance to what a ray meets first, m; nothing within the reach: infinite.
    pub(crate) fn range(&self, ray: Ray) -> f64 {
        let bodies = self.bodies.iter().map(|centre| ray.to_circle(*centre, self.radius));
        let range = bodies.fold(f64::INFINITY, f64::min);
        let obstacles = self.obstacles.iter().map(|obstacle| ray.to_obstacle(obstacle));
        let range = obstacles.fold(range, f64::min);
        if range <= self.reach { range } else { f64::INFINITY }
    }
}

impl Ray {
    /// The distance to a circle, m: 0 inside, infinite where it is missed.
    fn to_circle(self, centre: [f64; 2], radius: f64) -> f64 {
        let offset = [centre[0] - self.origin[0], centre[1] - self.origin[1]];
        let along = offset[0] * self.direction[0] + offset[1] * self.direction[1];
        let beside2 = offset[0] * offset[0] + offset[1] * offset[1] - along * along;
        let chord2 = radius * radius - beside2;
        if chord2 < 0.0 {
            return f64::INFINITY;
        }
        let half = chord2.sqrt();
        if along + half < 0.0 { f64::INFINITY } else { (along - half).max(0.0) }
    }

    /// The distance to a line from `a` to `b`, m; infinite where it is missed.
    fn to_segment(self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let (along, offset) = ([b[0] - a[0], b[1] - a[1]], [a[0] - self.origin[0], a[1] - self.origin[1]]);
        let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let turn = cross(self.direction, along);
        if turn == 0.0 {
            return f64::INFINITY;
        }
        let (range, fraction) = (cross(offset, along) / turn, cross(offset, self.direction) / turn);
        if range >= 0.0 && (0.0..=1.0).contains(&fraction) { range } else { f64::INFINITY }
    }

    /// The distance to the surface of an obstacle, seen from outside: that of its edges moved out by its radius, and of
    /// the circles around its corners.
    fn to_obstacle(self, obstacle: &Obstacle) -> f64 {
        let (centre, reach) = obstacle.circle();
        if self.to_circle(centre, reach) == f64::INFINITY {
            return f64::INFINITY;
        }
        let (corners, radius) = (&obstacle.outline().corners, obstacle.outline().radius);
        let mut range = f64::INFINITY;
        for (index, &a) in corners.iter().enumerate() {
            let b = corners[(index + 1) % corners.len()];
            if radius > 0.0 {
                range = range.min(self.to_circle(a, radius));
            }
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
            if length == 0.0 {
                continue;
            }
            let out = [radius * along[1] / length, -radius * along[0] / length];
            range = range.min(self.to_segment([a[0] + out[0], a[1] + out[1]], [b[0] + out[0], b[1] + out[1]]));
            if radius > 0.0 {
                range = range.min(self.to_segment([a[0] - out[0], a[1] - out[1]], [b[0] - out[0], b[1] - out[1]]));
            }
        }
        range
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera;
    use parry2d_f64::math::{Pose, Vector};
    use parry2d_f64::query::{Ray as Theirs, RayCast};
    use parry2d_f64::shape::{Ball, Capsule, Segment};
    use proptest::prelude::*;

    proptest! {
        /// Rays from outside, against parry's on the same edges: segments, or capsules where the outline is grown.
        #[test]
        fn ranges_are_those_of_parry(
            corners in proptest::collection::vec([0.0..2.0f64, 0.0..2.0f64], 1..7),
            radius in prop_oneof![Just(0.0), 0.01..0.3f64],
            angle in 0.0..6.3f64,
        ) {
            let obstacle = Obstacle::new(1, camera::Obstacle { corners: corners.clone(), radius }, [0.0; 2]);
            let ray = Ray { origin: [-1.0, 1.0], direction: [libm::cos(angle), libm::sin(angle)] };
            let theirs = Theirs::new(Vector::new(-1.0, 1.0), Vector::new(ray.direction[0], ray.direction[1]));
            let mut expected = f64::INFINITY;
            let mut meet = |shape: &dyn RayCast| {
                let range = shape.cast_ray(&Pose::identity(), &theirs, 100.0, true);
                expected = expected.min(range.unwrap_or(f64::INFINITY));
            };
            for (index, a) in corners.iter().enumerate() {
                let b = corners[(index + 1) % corners.len()];
                let (a, b) = (Vector::new(a[0], a[1]), Vector::new(b[0], b[1]));
                match (corners.len(), radius > 0.0) {
                    (1, true) => meet(&parry2d_f64::shape::Compound::new(vec![(Pose::translation(a.x, a.y), parry2d_f64::shape::SharedShape::new(Ball::new(radius)))])),
                    (1, false) => {}
                    (_, true) => meet(&Capsule::new(a, b, radius)),
                    (_, false) => meet(&Segment::new(a, b)),
                }
            }
            let range = ray.to_obstacle(&obstacle);
            prop_assert!(range == expected || (range - expected).abs() < 1e-7, "{range}, parry {expected}");
        }
    }
}
