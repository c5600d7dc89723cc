//! Real obstacles: what bodies run into and range sensors see.

use crate::camera;

/// A polygon grown by a radius, or a disc, that may move.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Obstacle {
    /// Names it in contact reports and messages.
    pub id: u32,
    /// Corners in order, and radius; m in the map.
    pub outline: camera::Obstacle,
    /// m/s
    pub velocity: [f64; 2],
}

impl Obstacle {
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
        if self.velocity != [0.0, 0.0] {
            for corner in &mut self.outline.corners {
                corner[0] += self.velocity[0] * dt;
                corner[1] += self.velocity[1] * dt;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn obstacle(corners: &[[f64; 2]], radius: f64) -> Obstacle {
        Obstacle { outline: camera::Obstacle { corners: corners.to_vec(), radius }, ..Obstacle::default() }
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
    fn it_moves() {
        let mut disc = Obstacle { velocity: [0.5, -1.0], ..obstacle(&[[1.0, 1.0]], 0.5) };
        disc.advance(2.0);
        assert_eq!(disc.outline.corners, [[2.0, -1.0]]);
    }
}
