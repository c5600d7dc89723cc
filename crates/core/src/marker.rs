//! What all markers of the stack have in common.

use crate::duration_from_seconds;
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::geometry_msgs::{Pose, Quaternion};
use trench_msgs::std_msgs::{ColorRGBA, Header};
use trench_msgs::visualization_msgs::Marker;

/// A marker of this kind in the map, not turned, that goes by itself after `lifetime` seconds, so that what a viewer shows of a
/// node ends with it. Its place, size, points or text are still to be set.
#[must_use]
pub fn marker(
    stamp: impl Into<Time>,
    namespace: impl Into<String>,
    id: i32,
    kind: i32,
    color: ColorRGBA,
    lifetime: f64,
) -> Marker {
    Marker {
        header: Header { stamp: stamp.into(), frame_id: "map".to_owned() },
        ns: namespace.into(),
        id,
        r#type: kind,
        action: Marker::ADD,
        // RViz takes a quaternion of zeros for one that was forgotten.
        pose: Pose { orientation: Quaternion { w: 1.0, ..Quaternion::default() }, ..Pose::default() },
        color,
        lifetime: duration_from_seconds(lifetime),
        ..Marker::default()
    }
}
