//! Apparent obstacles as RViz2 and Foxglove draw them.

use trench_core::RosTime;
use trench_msgs::geometry_msgs::Point;
use trench_msgs::msg::ApparentObstacle;
use trench_msgs::std_msgs::{ColorRGBA, Header};
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

/// Corners that stand for a rounded one.
const ROUND: usize = 16;

/// The outlines of all apparent obstacles, after a marker that deletes the old ones.
pub(crate) fn outlines(obstacles: &[ApparentObstacle], stamp: RosTime) -> MarkerArray {
    let clear =
        Marker { action: Marker::DELETEALL, ns: NAMESPACE.to_owned(), header: header(stamp), ..Marker::default() };
    let mut markers = vec![clear];
    markers.extend(obstacles.iter().map(|obstacle| outline(obstacle, stamp)));
    MarkerArray { markers }
}

const NAMESPACE: &str = "apparent_obstacles";

fn header(stamp: RosTime) -> Header {
    Header { stamp: stamp.into(), frame_id: "map".to_owned() }
}

fn outline(obstacle: &ApparentObstacle, stamp: RosTime) -> Marker {
    let mut marker = Marker {
        header: header(stamp),
        ns: NAMESPACE.to_owned(),
        id: obstacle.id as i32,
        r#type: Marker::LINE_STRIP,
        action: Marker::ADD,
        color: ColorRGBA { r: 0.8, g: 0.25, b: 0.1, a: 0.9 },
        points: rounded(obstacle),
        ..Marker::default()
    };
    marker.pose.orientation.w = 1.0;
    marker.scale.x = 0.01;
    marker
}

/// The hull grown by its radius: at each corner the arc between the normals of its edges, closed at the end.
fn rounded(obstacle: &ApparentObstacle) -> Vec<Point> {
    let corners = &obstacle.hull;
    let mut points = Vec::new();
    for (index, corner) in corners.iter().enumerate() {
        let before = &corners[(index + corners.len() - 1) % corners.len()];
        let after = &corners[(index + 1) % corners.len()];
        let normal = |dx: f64, dy: f64| libm::atan2(-dx, dy);
        let (from, mut to) = if corners.len() == 1 {
            (0.0, std::f64::consts::TAU)
        } else {
            (normal(corner.x - before.x, corner.y - before.y), normal(after.x - corner.x, after.y - corner.y))
        };
        while to < from {
            to += std::f64::consts::TAU;
        }
        for step in 0..=ROUND {
            let angle = from + (to - from) * step as f64 / ROUND as f64;
            let (sin, cos) = libm::sincos(angle);
            points.push(Point { x: corner.x + obstacle.radius * cos, y: corner.y + obstacle.radius * sin, z: 0.0 });
        }
    }
    points.extend(points.first().cloned());
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_msgs::msg::Point2;

    #[test]
    fn every_point_lies_on_the_grown_outline() {
        let corner = |x, y| Point2 { x, y };
        let square = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let obstacle = ApparentObstacle { hull: square, radius: 0.1, ..Default::default() };
        let points = rounded(&obstacle);
        assert_eq!(points.len(), 4 * (ROUND + 1) + 1);
        for point in &points {
            let outside = |value: f64| (value - 1.0).max(-value).max(0.0);
            let distance = libm::hypot(outside(point.x), outside(point.y));
            assert!((distance - 0.1).abs() < 1e-12, "{point:?}");
        }
    }

    #[test]
    fn a_disc_is_a_circle() {
        let disc = ApparentObstacle { hull: vec![Point2 { x: 2.0, y: 0.0 }], radius: 0.5, ..Default::default() };
        let points = rounded(&disc);
        assert!(points.iter().all(|point| (libm::hypot(point.x - 2.0, point.y) - 0.5).abs() < 1e-12));
    }
}
