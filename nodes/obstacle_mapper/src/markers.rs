//! What the mapper knows as RViz2 and Foxglove draw it: apparent obstacles red, the hulls of their members grey, what
//! lasers have seen as dots.

use crate::scans::Memory;
use crate::sources::Known;
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::hull::Outline;
use trench_msgs::geometry_msgs::{Point, Vector3};
use trench_msgs::msg::ApparentObstacle;
use trench_msgs::std_msgs::ColorRGBA;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

/// Corners that stand for a rounded one.
const ROUND: usize = 16;
/// The shortest time between two pictures, s.
pub(crate) const PICTURES: f64 = 0.19;
/// What a viewer shows goes away after this, s: nobody else's markers are deleted, and none stays of a mapper that ended.
const LIFETIME: f64 = 0.6;

/// What is drawn.
pub(crate) struct Picture<'a> {
    pub(crate) apparent: &'a [ApparentObstacle],
    pub(crate) known: &'a [Known],
    pub(crate) memory: &'a Memory,
}

impl Picture<'_> {
    /// All markers; nothing where there is nothing to draw.
    pub(crate) fn markers(&self, stamp: RosTime) -> Option<MarkerArray> {
        let corner = |point: &trench_msgs::msg::Point2| Vector2::new(point.x, point.y);
        let red = ColorRGBA { r: 0.8, g: 0.25, b: 0.1, a: 0.9 };
        let grey = ColorRGBA { r: 0.4, g: 0.4, b: 0.4, a: 0.7 };
        let mut markers: Vec<Marker> = Vec::new();
        for obstacle in self.apparent {
            let points: Vec<Vector2<f64>> = obstacle.hull.iter().map(corner).collect();
            let outline = Outline { points: &points, radius: obstacle.radius };
            markers.push(strip("apparent_obstacles", obstacle.id, outline, 0.01, red, stamp));
        }
        for known in self.known {
            markers.push(strip("apparent_obstacles/members", known.id, known.shape.outline(), 0.004, grey, stamp));
        }
        if !self.memory.cells.is_empty() {
            let mut dots = marker("apparent_obstacles/scans", 0, Marker::POINTS, red, stamp);
            dots.scale = Vector3 { x: 0.015, y: 0.015, z: 0.0 };
            dots.points = self.memory.cells.values().map(|cell| level(cell.point)).collect();
            markers.push(dots);
        }
        (!markers.is_empty()).then_some(MarkerArray { markers })
    }
}

fn marker(namespace: &str, id: u32, kind: i32, color: ColorRGBA, stamp: RosTime) -> Marker {
    trench_core::marker(stamp, namespace, id as i32, kind, color, LIFETIME)
}

fn strip(namespace: &str, id: u32, outline: Outline<'_>, width: f64, color: ColorRGBA, stamp: RosTime) -> Marker {
    let mut marker = marker(namespace, id, Marker::LINE_STRIP, color, stamp);
    marker.points = outline.boundary(ROUND).into_iter().map(level).collect();
    marker.scale.x = width;
    marker
}

fn level(point: Vector2<f64>) -> Point {
    Point { x: point.x, y: point.y, z: 0.0 }
}
