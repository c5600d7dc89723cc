//! A laser scanner in the middle of a robot, above its own body and lower than everything else.

use crate::Random;
use crate::contact::Surroundings;
use crate::ray::{Ray, View};
use std::f64::consts::TAU;

/// A scanner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Laser {
    /// From scan to scan, ns.
    pub period: u64,
    /// What is nearer is not measured, m from the robot's centre.
    pub range_min: f64,
    /// What is farther is not seen, m.
    pub range_max: f64,
    /// Half of it to either side of the robot's front, rad; at most the whole circle.
    pub field_of_view: f64,
    /// Rays a scan.
    pub rays: usize,
    /// Standard deviation of a range, m.
    pub noise: f64,
}

impl Laser {
    /// The direction of the first ray, rad from the robot's front, counter-clockwise.
    #[must_use]
    pub fn angle_min(&self) -> f64 {
        -0.5 * self.field_of_view
    }

    /// From ray to ray, rad. The last ray of a whole circle is not the first one again.
    #[must_use]
    pub fn increment(&self) -> f64 {
        let gaps = if self.field_of_view < TAU { self.rays.saturating_sub(1) } else { self.rays };
        self.field_of_view / gaps.max(1) as f64
    }

    /// All ranges in m as REP 117 wants them: +infinity where nothing is, -infinity where it is too near.
    pub(crate) fn scan(&self, surroundings: &Surroundings<'_>, index: usize, random: &mut Random) -> Vec<f32> {
        let pose = surroundings.poses.get(index).copied().unwrap_or_default();
        let view = View::of(surroundings, index, self.range_max);
        let range = |ray: usize| {
            let angle = pose.theta + self.angle_min() + self.increment() * ray as f64;
            let (sin, cos) = libm::sincos(angle);
            // Drawn for every ray: what one ray meets does not shift the noise of the others.
            let noise = self.noise * random.normal();
            match view.range(Ray { origin: [pose.x, pose.y], direction: [cos, sin] }) + noise {
                near if near < self.range_min => f32::NEG_INFINITY,
                far if far > self.range_max => f32::INFINITY,
                range => range as f32,
            }
        };
        (0..self.rays).map(range).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Field, Obstacle, camera};
    use trench_optics::Pose2;

    #[test]
    fn sees_bodies_and_walls_but_not_the_edge() {
        let poses = [Pose2 { x: 1.0, y: 1.0, theta: 0.5 * std::f64::consts::PI }, Pose2 { x: 1.0, y: 1.5, theta: 0.0 }];
        let corners = vec![[0.6, 0.0], [0.7, 0.0], [0.7, 3.0], [0.6, 3.0]];
        let wall = Obstacle::new(1, camera::Obstacle { corners, radius: 0.0 }, [0.0; 2]);
        let near = Obstacle::new(2, camera::Obstacle { corners: vec![[1.0, 0.8]], radius: 0.15 }, [0.0; 2]);
        let (field, obstacles) = (Field { width: 3.0, height: 3.0 }, [wall, near]);
        let surroundings = Surroundings { poses: &poses, obstacles: &obstacles, field, radius: 0.08 };
        let laser = Laser { period: 1, range_min: 0.1, range_max: 2.5, field_of_view: TAU, rays: 4, noise: 0.0 };
        // Rear: a disc 0.05 m away; right: nothing but the edge; front: a robot; left: the wall.
        let scan = laser.scan(&surroundings, 0, &mut Random::new(1, 0));
        assert_eq!((scan[0], scan[1]), (f32::NEG_INFINITY, f32::INFINITY));
        assert!((scan[2] - 0.42).abs() < 1e-6 && (scan[3] - 0.3).abs() < 1e-6, "{scan:?}");
    }

    #[test]
    fn noise_has_the_deviation_asked_for_and_rays_span_the_view() {
        let poses = [Pose2 { x: 1.0, y: 1.0, theta: 0.0 }];
        let disc = Obstacle::new(1, camera::Obstacle { corners: vec![[1.0, 1.0]], radius: 0.001 }, [0.0; 2]);
        let field = Field { width: 3.0, height: 3.0 };
        let surroundings = Surroundings { poses: &poses, obstacles: &[disc], field, radius: 0.08 };
        let laser = Laser { period: 1, range_min: -1.0, range_max: 1.0, field_of_view: 3.0, rays: 3001, noise: 0.01 };
        assert!((laser.increment() - 0.001).abs() < 1e-12 && (laser.angle_min() + 1.5).abs() < 1e-12);
        let scan = laser.scan(&surroundings, 0, &mut Random::new(5, 0));
        let variance = scan.iter().map(|range| f64::from(*range).powi(2)).sum::<f64>() / 3001.0;
        assert!((variance.sqrt() - 0.01).abs() < 0.001, "{}", variance.sqrt());
    }
}
