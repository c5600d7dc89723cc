//! Markers of any node, flattened onto the plane: each namespace is a layer of the picture.

use crate::{Point, point, short};
use serde::Serialize;
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

/// What the picture draws from its own topic: namespaces, or all that begin like this.
const DRAWN_ELSEWHERE: [&str; 4] = ["robots/", "formation/", "apparent_obstacles", crate::shown::NAMESPACE];
/// The marker that tells how large a robot is.
const BODY: &str = "robots/body";
/// Markers that are remembered at most, and points of one.
const MOST: usize = 2000;

#[derive(Debug, Clone, Default)]
pub(crate) struct Markers {
    shapes: BTreeMap<(String, i32), (Option<RosTime>, Shape)>,
    /// A robot's diameter as the localizer draws it, m.
    pub(crate) body: Option<f64>,
}

/// A marker on the plane.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Shape {
    layer: String,
    kind: &'static str,
    points: Vec<Point>,
    /// Along and across, m.
    size: [Option<f64>; 2],
    /// rad.
    theta: Option<f64>,
    /// Red, green, blue of 255, and alpha of 1.
    colour: (u8, u8, u8, Option<f64>),
    #[serde(skip_serializing_if = "String::is_empty")]
    text: String,
}

impl Markers {
    /// Gives whether something that is drawn from here changed.
    pub(crate) fn take(&mut self, now: RosTime, array: MarkerArray) -> bool {
        let mut changed = false;
        for marker in array.markers {
            if marker.ns == BODY && marker.scale.x.is_finite() && marker.scale.x > 0.0 {
                self.body = Some(marker.scale.x);
            }
            let is_drawn = |name: &str| marker.ns == name || (name.ends_with('/') && marker.ns.starts_with(name));
            if DRAWN_ELSEWHERE.iter().any(|name| is_drawn(name)) {
                continue;
            }
            changed |= self.put(now, marker);
        }
        changed
    }

    fn put(&mut self, now: RosTime, marker: Marker) -> bool {
        let before = self.shapes.len();
        match marker.action {
            // Without a namespace all are meant.
            Marker::DELETEALL => {
                self.shapes.retain(|(namespace, _), _| !marker.ns.is_empty() && *namespace != marker.ns)
            }
            Marker::DELETE => drop(self.shapes.remove(&(marker.ns, marker.id))),
            _ => {
                let Some(shape) = Shape::of(&marker) else { return false };
                let lifetime = f64::from(marker.lifetime.sec) + f64::from(marker.lifetime.nanosec) * 1e-9;
                let until = (lifetime > 0.0).then(|| now.plus_seconds(lifetime));
                let key = (marker.ns, marker.id);
                if before >= MOST && !self.shapes.contains_key(&key) {
                    return false;
                }
                return self.shapes.insert(key, (until, shape.clone())).is_none_or(|(_, old)| old != shape);
            }
        }
        self.shapes.len() != before
    }

    /// Forgets what has lived its life; gives whether there was any.
    pub(crate) fn expire(&mut self, now: RosTime) -> bool {
        let before = self.shapes.len();
        self.shapes.retain(|_, (until, _)| until.is_none_or(|until| now <= until));
        self.shapes.len() != before
    }

    pub(crate) fn list(&self) -> Vec<&Shape> {
        self.shapes.values().map(|(_, shape)| shape).collect()
    }
}

impl Shape {
    /// Nothing for what has no place on the plane: foreign frames, meshes.
    fn of(marker: &Marker) -> Option<Self> {
        if !matches!(marker.header.frame_id.as_str(), "map" | "/map" | "") {
            return None;
        }
        let kind = match marker.r#type {
            Marker::ARROW => "arrow",
            Marker::CUBE => "box",
            Marker::SPHERE | Marker::CYLINDER => "disc",
            Marker::LINE_STRIP | Marker::ARROW_STRIP => "line",
            Marker::LINE_LIST => "lines",
            Marker::CUBE_LIST | Marker::SPHERE_LIST | Marker::POINTS => "points",
            Marker::TEXT_VIEW_FACING => "text",
            Marker::TRIANGLE_LIST => "triangles",
            _ => return None,
        };
        let (place, q) = (&marker.pose.position, &marker.pose.orientation);
        let theta = 2.0 * q.z.atan2(q.w);
        let (sin, cos) = theta.sin_cos();
        let map = |x: f64, y: f64| point(place.x + cos * x - sin * y, place.y + sin * x + cos * y);
        let mut points: Vec<Point> = marker.points.iter().take(MOST).map(|at| map(at.x, at.y)).collect();
        if points.is_empty() {
            points.push(map(0.0, 0.0));
            if kind == "arrow" {
                points.push(map(marker.scale.x, 0.0));
            }
        }
        let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        let colour = &marker.color;
        Some(Self {
            layer: marker.ns.clone(),
            kind,
            points,
            size: [short(marker.scale.x), short(if kind == "text" { marker.scale.z } else { marker.scale.y })],
            theta: short(theta),
            colour: (byte(colour.r), byte(colour.g), byte(colour.b), short(f64::from(colour.a))),
            text: marker.text.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::duration_from_seconds;
    use trench_msgs::geometry_msgs;

    fn marker(namespace: &str, id: i32) -> Marker {
        let mut marker = Marker { ns: namespace.to_owned(), id, r#type: Marker::LINE_STRIP, ..Marker::default() };
        marker.points = vec![geometry_msgs::Point { x: 1.0, y: 0.0, z: 0.0 }];
        (marker.pose.position.x, marker.pose.orientation.z, marker.pose.orientation.w) = (0.5, 1.0, 1.0);
        marker
    }

    fn take(markers: &mut Markers, at: f64, marker: Marker) -> bool {
        markers.take(RosTime(0).plus_seconds(at), MarkerArray { markers: vec![marker] })
    }

    #[test]
    fn markers_come_move_with_their_pose_and_go() {
        let mut markers = Markers::default();
        assert!(take(&mut markers, 0.0, marker("zones", 1)));
        assert!(!take(&mut markers, 0.0, marker("zones", 1)), "the same again is no change");
        assert_eq!(
            markers.list()[0].points,
            [[Some(0.5), Some(1.0)]],
            "a quarter turn to the left, half a metre ahead"
        );
        assert!(take(&mut markers, 0.0, Marker { lifetime: duration_from_seconds(1.0), ..marker("zones", 2) }));
        assert!(!markers.expire(RosTime(0).plus_seconds(0.9)));
        assert!(markers.expire(RosTime(0).plus_seconds(1.1)));
        assert!(!take(&mut markers, 2.0, Marker { action: Marker::DELETEALL, ..marker("others", 0) }));
        assert!(take(&mut markers, 2.0, Marker { action: Marker::DELETE, ..marker("zones", 1) }));
        assert!(markers.list().is_empty());
    }

    #[test]
    fn what_is_drawn_elsewhere_or_nowhere_is_left_out() {
        let mut markers = Markers::default();
        let mut body = marker(BODY, 1);
        body.scale.x = 0.16;
        assert!(!take(&mut markers, 0.0, body));
        assert_eq!(markers.body, Some(0.16));
        let mut foreign = marker("zones", 1);
        foreign.header.frame_id = "base_link".to_owned();
        assert!(!take(&mut markers, 0.0, foreign));
        assert!(!take(&mut markers, 0.0, Marker { r#type: Marker::MESH_RESOURCE, ..marker("zones", 1) }));
        let mut endless = marker("zones", 1);
        endless.points[0].x = f64::NAN;
        assert!(take(&mut markers, 0.0, endless));
        assert_eq!(serde_json::to_value(markers.list()).unwrap()[0]["points"][0][0], serde_json::Value::Null);
    }
}
