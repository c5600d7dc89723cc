//! /overhead/camera_info: the lens file as a message.

use trench_core::RosTime;
use trench_msgs::sensor_msgs::CameraInfo;
use trench_msgs::std_msgs::Header;
use trench_optics::Lens;

/// The lens at the exposure of a frame.
pub(crate) fn camera_info(exposed: RosTime, frame_id: &str, lens: &Lens) -> CameraInfo {
    let Lens { width, height, fx, fy, cx, cy, distortion } = *lens;
    CameraInfo {
        header: Header { stamp: exposed.into(), frame_id: frame_id.to_owned() },
        height,
        width,
        distortion_model: "plumb_bob".to_owned(),
        d: vec![distortion.k1, distortion.k2, distortion.p1, distortion.p2, distortion.k3],
        k: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        ..CameraInfo::default()
    }
}
