//! Real obstacles: what bodies run into and range sensors see.

use crate::{Path, camera};

/// A polygon grown by a radius, or a disc, that may move.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    id: u32,
    outline: camera::Obstacle,
    velocity: [f64; 2],
    path: Option<Path>,
    /// A circle around all of it: what is far from this need not be looked at closely.
    centre: [f64; 2],
    reach: f64,
}

impl Obstacle {
    /// An obstacle with an outline (m in the map) that moves at `velocity` (m/s) for ever; `id` names it in messages.
    #[must_use]
    pub fn new(id: u32, outline: camera::Obstacle, velocity: [f64; 2]) -> Self {
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for corner in &outline.corners {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let centre = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        let reach = outline.corners.iter().map(|corner| distance(*corner, centre)).fold(0.0, f64::max);
        // A little more than exact: corners and centre are moved on apart from each other.
        let reach = reach + outline.radius + 1e-6;
        Self { id, outline, velocity, path: None, centre, reach }
    }

    /// The same obstacle on a way.
    #[must_use]
    pub fn on(self, path: Path) -> Self {
        Self { path: Some(path), velocity: [0.0; 2], ..self }
    }

    /// Names it in messages.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.id
    }

    /// Corners in order, and radius; m in the map.
    #[must_use]
    pub fn outline(&self) -> &camera::Obstacle {
        &self.outline
    }

    /// m/s
    #[must_use]
    pub fn velocity(&self) -> [f64; 2] {
        self.velocity
    }

    /// The way that it goes, if it goes one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_ref()
    }

    /// Centre and radius of a circle around it, m.
    pub(crate) fn circle(&self) -> ([f64; 2], f64) {
        (self.centre, self.reach)
    }

    /// As [`Self::clearance`], nothing if that is clearly `reach` m or more.
    pub(crate) fn clearance_within(&self, point: [f64; 2], reach: f64) -> Option<(f64, [f64; 2])> {
        let offset = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let far = self.reach + reach.max(0.0);
        (offset[0] * offset[0] + offset[1] * offset[1] <= far * far).then(|| self.clearance(point))
    }

    /// The distance from a point to its surface, negative inside, and the unit vector that leads away from it.
    #[must_use]
    pub fn clearance(&self, point: [f64; 2]) -> (f64, [f64; 2]) {
        let corners = &self.outline.corners;
        let mut nearest = (f64::MAX, [1.0, 0.0]);
        let mut inside = false;
        for (index, &a) in corners.iter().enumerate() {
            let b = corners[(index + 1) % corners.len()];
            let (along, to_point) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
            let length2 = (along[0] * along[0] + along[1] * along[1]).max(1e-18);
            let fraction = ((to_point[0] * along[0] + to_point[1] * along[1]) / length2).clamp(0.0, 1.0);
            let offset = [to_point[0] - fraction * along[0], to_point[1] - fraction * along[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if distance < nearest.0 {
                nearest = (distance, offset);
            }
            // Even-odd rule: count the edges that a ray towards +x crosses.
            if (a[1] > point[1]) != (b[1] > point[1]) && to_point[0] < along[0] * to_point[1] / along[1] {
                inside = !inside;
            }
        }
        let (distance, offset) = nearest;
        let sign = if inside { -1.0 } else { 1.0 };
        let scale = if distance > 0.0 { sign / distance } else { 0.0 };
        (sign * distance - self.outline.radius, [offset[0] * scale, offset[1] * scale])
    }

    /// Moves on for `dt` seconds.
    pub fn advance(&mut self, dt: f64) {
        let step = match &mut self.path {
            Some(path) => {
                let (step, velocity) = path.advance(dt);
                self.velocity = velocity;
                step
            }
            None => [self.velocity[0] * dt, self.velocity[1] * dt],
        };
        if step != [0.0, 0.0] {
            for place in self.outline.corners.iter_mut().chain([&mut self.centre]) {
                *place = [place[0] + step[0], place[1] + step[1]];
            }
        }
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let offset = [a[0] - b[0], a[1] - b[1]];
    (offset[0] * offset[0] + offset[1] * offset[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ending;

    fn obstacle(corners: &[[f64; 2]], radius: f64) -> Obstacle {
        Obstacle::new(1, camera::Obstacle { corners: corners.to_vec(), radius }, [0.0; 2])
    }

    #[test]
    fn clearance_and_direction() {
        let square = obstacle(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]], 0.1);
        let disc = obstacle(&[[1.0, 1.0]], 0.5);
        let check = |obstacle: &Obstacle, point, expected: f64, away: [f64; 2]| {
            let (clearance, direction) = obstacle.clearance(point);
            assert!((clearance - expected).abs() < 1e-12, "{point:?}: {clearance}");
            assert!((direction[0] - away[0]).abs() + (direction[1] - away[1]).abs() < 1e-12, "{direction:?}");
        };
        check(&square, [3.0, 1.0], 0.9, [1.0, 0.0]);
        check(&square, [1.0, 0.5], -0.6, [0.0, -1.0]);
        check(&square, [5.0, 6.0], 4.9, [0.6, 0.8]);
        check(&disc, [4.0, 5.0], 4.5, [0.6, 0.8]);
    }

    #[test]
    fn it_moves_and_its_circle_with_it() {
        let mut disc = Obstacle::new(1, camera::Obstacle { corners: vec![[1.0, 1.0]], radius: 0.5 }, [0.5, -1.0]);
        disc.advance(2.0);
        assert_eq!((&disc.outline.corners[..], disc.velocity()), (&[[2.0, -1.0]][..], [0.5, -1.0]));
        let mut wall = obstacle(&[[0.0, 0.0], [1.0, 0.0]], 0.1).on(Path::new(&[[0.0, 3.0]], 2.0, Ending::Stay, 0.0));
        wall.advance(1.0);
        assert_eq!((&wall.outline.corners[..], wall.velocity()), (&[[0.0, 2.0], [1.0, 2.0]][..], [0.0, 2.0]));
        assert!(wall.clearance_within([0.5, 3.0], 1.0).is_some_and(|(clearance, _)| (clearance - 0.9).abs() < 1e-12));
        assert_eq!(wall.clearance_within([0.5, 4.0], 1.0), None);
    }

    #[test]
    fn inside_a_trap_is_outside_the_obstacle() {
        // A U open to the right, walls 0.1 m thick.
        let trap = obstacle(
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.1], [0.1, 0.1], [0.1, 0.9], [1.0, 0.9], [1.0, 1.0], [0.0, 1.0]],
            0.0,
        );
        let (clearance, away) = trap.clearance([0.4, 0.5]);
        assert!((clearance - 0.3).abs() < 1e-12 && away == [1.0, 0.0], "{clearance} {away:?}");
        assert!(trap.clearance([0.05, 0.5]).0 < 0.0);
    }
}
