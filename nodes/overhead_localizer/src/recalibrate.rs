//! Another lens, or another place of a camera, while the node runs.

use nalgebra::Point3;
use trench_msgs::msg::SetCalibrationRequest;
use trench_optics::{Camera, CameraInfo, Mount, Overhead, Pad, Pose2};

/// The cameras as `request` wants them; nothing is in force yet.
///
/// # Errors
/// With the reason, for whoever asked.
pub(crate) fn cameras(
    now: &[Overhead],
    request: &SetCalibrationRequest,
    pad_height: f64,
) -> Result<Vec<Overhead>, String> {
    let SetCalibrationRequest { camera, camera_info, mount } = request;
    if camera_info.is_empty() && mount.is_empty() {
        return Err("neither a lens nor a mount is given".to_owned());
    }
    let mut cameras = now.to_vec();
    if !mount.is_empty() {
        let mounts = Mount::parse_all("mount", mount).map_err(|error| error.to_string())?;
        if mounts.len() != cameras.len() {
            return Err(format!("the mount file places {} cameras, there are {}", mounts.len(), cameras.len()));
        }
        for (name, mount) in mounts {
            let view = find(&mut cameras, name.as_deref().unwrap_or_default())?;
            view.camera = Camera::new(*view.camera.lens(), mount).map_err(|error| error.to_string())?;
        }
    }
    if !camera_info.is_empty() {
        let info = CameraInfo::parse("camera_info", camera_info).map_err(|error| error.to_string())?;
        let view = find(&mut cameras, camera)?;
        view.camera = Camera::new(info.lens, *view.camera.mount()).map_err(|error| error.to_string())?;
        view.lens_name = info.name;
    }
    match cameras.iter().find(|view| view.camera.mount().height <= pad_height) {
        Some(low) => Err(format!("a camera {} m above the floor is below the pads", low.camera.mount().height)),
        None => Ok(cameras),
    }
}

fn find<'a>(cameras: &'a mut [Overhead], name: &str) -> Result<&'a mut Overhead, String> {
    let names: Vec<&str> = cameras.iter().map(|view| view.name.as_deref().unwrap_or_default()).collect();
    match names.iter().position(|other| *other == name).and_then(|index| cameras.get_mut(index)) {
        Some(view) => Ok(view),
        None => Err(format!("there is no camera {name:?}")),
    }
}

/// Where a robot is by `after` whose pad's discs `before` saw where `pose` says; None if no camera saw them.
pub(crate) fn moved(before: &[Overhead], after: &[Overhead], pad: &Pad, pose: Pose2) -> Option<Pose2> {
    let [yellow, blue] = pad.discs(pose).map(|disc| Point3::new(disc.x, disc.y, pad.height));
    before.iter().zip(after).find_map(|(before, after)| {
        let again = |disc| {
            let pixel = before.camera.project(disc)?;
            if !before.camera.lens().contains(pixel, 0.0) {
                return None;
            }
            after.camera.unproject(pixel, pad.height)
        };
        Some(Pad::pose(again(yellow)?, again(blue)?))
    })
}
