//! Obstacles as they are, and the hulls made of them.

use crate::{Point, point, short};
use serde::Serialize;
use trench_msgs::msg::{ApparentObstacle, Obstacle, Point2};

/// A polygon with round corners.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Outline {
    id: u32,
    /// m; one point is the centre of a disc.
    points: Vec<Point>,
    /// m, by which the polygon is grown.
    radius: Option<f64>,
    /// m/s.
    velocity: Point,
    /// Obstacles inside: more than one make a combined hull.
    members: usize,
}

impl Outline {
    pub(crate) fn of_obstacle(obstacle: &Obstacle) -> Self {
        Self {
            id: obstacle.id,
            points: obstacle.polygon.iter().map(place).collect(),
            radius: short(obstacle.radius),
            velocity: place(&obstacle.velocity),
            members: 1,
        }
    }

    pub(crate) fn of_hull(hull: &ApparentObstacle) -> Self {
        Self {
            id: hull.id,
            points: hull.hull.iter().map(place).collect(),
            radius: short(hull.radius),
            velocity: place(&hull.velocity),
            members: hull.members.len(),
        }
    }
}

fn place(at: &Point2) -> Point {
    point(at.x, at.y)
}
