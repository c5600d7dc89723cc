//! Robots as RViz2 and Foxglove draw them: a disc for the body, an arrow for the heading, the name; coloured by status.

use crate::track::{Status, Track, Tracker};
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::geometry_msgs::{Point, Pose, Quaternion, Vector3};
use trench_msgs::std_msgs::ColorRGBA;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};
use trench_optics::Pad;

/// What a viewer shows of a localizer that has ended goes away after this, s.
const LIFETIME: f64 = 1.0;
/// Thickness of the drawn body, m.
const THICKNESS: f64 = 0.01;
/// Height of a name's letters, m.
const LETTERS: f64 = 0.06;

/// All robots that were ever seen; lost ones where they were last.
pub(crate) fn robots(stamp: Time, tracker: &Tracker, pad: &Pad) -> MarkerArray {
    let tracks = tracker.tracks().iter().enumerate().filter(|(_, track)| track.unseen.is_finite());
    MarkerArray { markers: tracks.flat_map(|(index, track)| robot(stamp, index as i32, track, pad)).collect() }
}

fn robot(stamp: Time, index: i32, track: &Track, pad: &Pad) -> Vec<Marker> {
    let Some(filter) = &track.filter else { return Vec::new() };
    let pose = filter.state().pose;
    let (sin, cos) = libm::sincos(0.5 * pose.theta);
    let marker = |namespace: &str, kind: i32, height: f64, [x, y, z]: [f64; 3], color: ColorRGBA| {
        let begun = trench_core::marker(stamp, format!("robots/{namespace}"), index, kind, color, LIFETIME);
        let position = Point { x: pose.x, y: pose.y, z: height };
        let orientation = Quaternion { x: 0.0, y: 0.0, z: sin, w: cos };
        Marker { pose: Pose { position, orientation }, scale: Vector3 { x, y, z }, ..begun }
    };
    let (body, dark) = (pad.body_diameter, ColorRGBA { r: 0.1, g: 0.1, b: 0.1, a: 0.9 });
    let disc = marker("body", Marker::CYLINDER, pad.height, [body, body, THICKNESS], colour(track.status));
    // From the middle to the body's edge, above the disc.
    let arrow = marker("heading", Marker::ARROW, pad.height + THICKNESS, [0.5 * body, 0.1 * body, 0.1 * body], dark);
    let mut name = marker("name", Marker::TEXT_VIEW_FACING, pad.height + LETTERS, [0.0, 0.0, LETTERS], dark);
    name.text.clone_from(&track.name);
    vec![disc, arrow, name]
}

/// Green: seen. Yellow: carried forward. Red: in doubt. Grey: lost.
fn colour(status: Status) -> ColorRGBA {
    let [r, g, b, a] = match status {
        Status::Tracked => [0.2, 0.7, 0.3, 0.9],
        Status::Predicted => [0.9, 0.8, 0.2, 0.7],
        Status::Ambiguous => [0.9, 0.2, 0.1, 0.9],
        Status::Lost => [0.5, 0.5, 0.5, 0.4],
    };
    ColorRGBA { r, g, b, a }
}
