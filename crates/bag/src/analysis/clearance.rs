//! How near robots came to obstacles.

use crate::run::{Run, distance};
use serde::Serialize;
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::msg::{Obstacle, ObstacleArray, Point2};

/// The nearest that one robot came to an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Clearance {
    /// The robot.
    pub robot: String,
    /// The obstacle.
    pub obstacle: u32,
    /// When, s.
    pub time: f64,
    /// Between the edges of body and obstacle, m; 0 where they overlap.
    pub gap: f64,
}

/// Gathers what was told of obstacles, in log order.
#[derive(Default)]
pub(super) struct Obstacles {
    told: Vec<(f64, ObstacleArray)>,
}

impl Obstacles {
    pub(super) fn take(&mut self, cdr: &[u8], t0: i64) {
        let Ok(array) = ObstacleArray::decode(cdr) else { return };
        let time = RosTime::from(&array.header.stamp).seconds_since(RosTime(t0));
        self.told.push((time, array));
    }

    /// Of each robot the nearest, after the beginning; obstacles move on between two messages.
    pub(super) fn finish(mut self, run: &Run, body_radius: f64) -> Vec<Clearance> {
        self.told.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut clearances = Vec::new();
        for (robot, track) in &run.robots {
            let mut nearest: Option<Clearance> = None;
            for pose in track.poses.iter().filter(|pose| pose.time >= 0.0) {
                let after = self.told.partition_point(|(time, _)| *time <= pose.time);
                let Some((told, array)) = after.checked_sub(1).and_then(|index| self.told.get(index)) else { continue };
                for obstacle in &array.obstacles {
                    let moved = pose.time - told;
                    let from = [pose.x - obstacle.velocity.x * moved, pose.y - obstacle.velocity.y * moved];
                    let gap = (distance_to(obstacle, from) - body_radius).max(0.0);
                    if gap.is_finite() && nearest.as_ref().is_none_or(|nearest| gap < nearest.gap) {
                        let (robot, obstacle, time) = (robot.clone(), obstacle.id, pose.time);
                        nearest = Some(Clearance { robot, obstacle, time, gap });
                    }
                }
            }
            clearances.extend(nearest);
        }
        clearances
    }
}

/// From a point to the edge of an obstacle, m; 0 inside.
fn distance_to(obstacle: &Obstacle, point: [f64; 2]) -> f64 {
    let corners: Vec<[f64; 2]> = obstacle.polygon.iter().map(|&Point2 { x, y }| [x, y]).collect();
    let next = corners.iter().cycle().skip(1);
    let sides: Vec<_> = corners.iter().zip(next).take(corners.len()).collect();
    // A ray to the right crosses the outline of what holds the point an odd number of times.
    let crossings = sides.iter().filter(|(a, b)| {
        let is_across = (a[1] > point[1]) != (b[1] > point[1]);
        is_across && point[0] < a[0] + (b[0] - a[0]) * (point[1] - a[1]) / (b[1] - a[1])
    });
    if crossings.count() % 2 == 1 {
        return 0.0;
    }
    let nearest = sides.iter().map(|(a, b)| distance_to_side(**a, **b, point)).fold(f64::INFINITY, f64::min);
    (nearest - obstacle.radius).max(0.0)
}

/// From a point to a straight line between two points, m.
fn distance_to_side(a: [f64; 2], b: [f64; 2], point: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / square;
    let share = if square > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 };
    distance([a[0] + share * along[0], a[1] + share * along[1]], point)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(corners: &[[f64; 2]], radius: f64, point: [f64; 2], expected: f64) {
        let polygon = corners.iter().map(|&[x, y]| Point2 { x, y }).collect();
        let obstacle = Obstacle { polygon, radius, ..Obstacle::default() };
        let found = distance_to(&obstacle, point);
        assert!((found - expected).abs() < 1e-12, "{corners:?}, {radius}: {found}");
    }

    #[test]
    fn discs_sides_corners_and_the_inside() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        check(&[[1.0, 2.0]], 0.5, [1.0, 3.0], 0.5);
        check(&[[1.0, 2.0]], 0.5, [1.0, 2.2], 0.0);
        check(&square, 0.0, [0.5, -0.25], 0.25);
        check(&square, 0.25, [0.5, -0.25], 0.0);
        check(&square, 0.0, [4.0, 5.0], 5.0);
        check(&square, 0.0, [0.5, 0.5], 0.0);
        check(&[[0.0, 0.0], [2.0, 0.0]], 0.1, [1.0, 0.6], 0.5);
    }
}
