//! /overhead/camera_info: the lens file as a message.

use trench_core::RosTime;
use trench_msgs::sensor_msgs::CameraInfo;
use trench_msgs::std_msgs::Header;
use trench_optics::{Lens, PlumbBob};

/// The lens at the exposure of a frame.
pub(crate) fn camera_info(exposed: RosTime, frame_id: &str, lens: &Lens) -> CameraInfo {
    let Lens { width, height, fx, fy, cx, cy, distortion } = *lens;
    let PlumbBob { k1, k2, p1, p2, k3 } = distortion;
    let header = Header { stamp: exposed.into(), frame_id: frame_id.to_owned() };
    CameraInfo::plumb_bob(header, [width, height], [fx, fy], [cx, cy], [k1, k2, p1, p2, k3])
}
