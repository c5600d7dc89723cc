//! The camera's parameters, and the node made from them.

use crate::core::OverheadCamera;
use crate::frame::Encoding;
use crate::source::{BagSource, Controls, DeviceSource, FolderSource, FrameSource, PixelFormat};
use std::path::Path;
use trench_config::{ConfigError, ParameterDescriptor as P, Parameters};
use trench_core::{Files, NodeContext, NodeCore, NodeDescription, StartError};
use trench_optics::{CameraInfo, Lens};

/// What the core is told once.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) lens: Option<Lens>,
    pub(crate) frame_id: String,
    /// Seconds from the node's start to the first frame.
    pub(crate) start_delay: f64,
}

/// The node as processes make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "overhead_camera",
        about: "A real camera, an image folder or a bag into /overhead/image_raw, stamped at exposure.",
        parameters: descriptors,
        build,
    }
}

fn descriptors() -> Vec<P> {
    let all = vec![
        P::string("source", "v4l2", "v4l2: a camera; folder: its .png and .jpg files; bag: a recorded topic"),
        P::string("path", "", "the device (/dev/video0), the folder or the bag"),
        P::string(
            "camera_info_file",
            "",
            "lens file in ROS's camera_info format: published, and frames must have its size",
        ),
        P::string("frame_id", "overhead_camera", "the frame that stamps of images name"),
        P::double("rate", 30.0, "1/s, frames of a folder; what a camera is asked for").range(0.1, 1000.0),
        P::bool("repeat", false, "folder and bag: begin again after the last frame; otherwise the node ends"),
        P::double("start_delay", 1.0, "s, folder and bag: until the first frame, so that readers are there")
            .range(0.0, 60.0),
        P::double(
            "exposure_delay",
            0.0,
            "s, from the middle of the exposure until a frame of a camera or folder is here",
        )
        .range(0.0, 1.0),
        P::string("topic", "/overhead/image_raw", "bag: the recorded images, sensor_msgs/Image or CompressedImage"),
        P::string("format", "yuyv", "v4l2: yuyv, mjpeg, rgb or bgr"),
        P::integer("width", 768, "v4l2: pixels a row, where there is no lens file").range(16.0, 8192.0),
        P::integer("height", 576, "v4l2: rows, where there is no lens file").range(16.0, 8192.0),
    ];
    let controls = vec![
        P::double("controls.exposure", -1.0, "v4l2: s, exposure; 0: automatic; -1: as the camera is").range(-1.0, 1.0),
        P::integer("controls.gain", -1, "v4l2: gain in the driver's units; -1: as the camera is").range(-1.0, 65_535.0),
        P::integer("controls.white_balance", -1, "v4l2: K, of the light; 0: automatic; -1: as the camera is")
            .range(-1.0, 20_000.0),
    ];
    all.into_iter().map(P::read_only).chain(controls).collect()
}

/// What the camera is told; numbers below zero leave it as it is.
pub(crate) fn controls(parameters: &Parameters) -> Result<Controls, ConfigError> {
    let integer = |key: &str| parameters.i64(key).map(|value| i32::try_from(value).ok().filter(|value| *value >= 0));
    Ok(Controls {
        exposure: Some(parameters.f64("controls.exposure")?).filter(|seconds| *seconds >= 0.0),
        gain: integer("controls.gain")?,
        white_balance: integer("controls.white_balance")?,
    })
}

fn build(context: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let lens = lens(parameters, files)?;
    let mut source = source(parameters, lens.as_ref())?;
    // Nothing is open yet: what the camera says of it comes when it is.
    let refused = |problem| parameters.error("controls", problem, "leave it at -1");
    source.control(controls(parameters)?).map_err(refused)?;
    let settings = Settings {
        lens,
        frame_id: parameters.str("frame_id")?.to_owned(),
        start_delay: parameters.f64("start_delay")?,
    };
    Ok(Box::new(OverheadCamera::new(context, settings, source)))
}

fn lens(parameters: &Parameters, files: &dyn Files) -> Result<Option<Lens>, ConfigError> {
    let path = parameters.str("camera_info_file")?;
    if path.is_empty() {
        return Ok(None);
    }
    let text = files.read("camera_info_file", path)?;
    Ok(Some(CameraInfo::parse(path, &text)?.lens))
}

fn source(parameters: &Parameters, lens: Option<&Lens>) -> Result<Box<dyn FrameSource>, ConfigError> {
    let path = parameters.str("path")?;
    if path.is_empty() {
        return Err(parameters.error("path", "is missing", "name the device, folder or bag"));
    }
    let (rate, repeat) = (parameters.f64("rate")?, parameters.bool("repeat")?);
    let exposure_delay = parameters.f64("exposure_delay")?;
    match parameters.str("source")? {
        "folder" => FolderSource::open(Path::new(path), rate, repeat, exposure_delay)
            .map(|source| Box::new(source) as Box<dyn FrameSource>)
            .map_err(|problem| parameters.error("path", problem, "name a folder of .png or .jpg files")),
        "bag" => BagSource::open(Path::new(path), parameters.str("topic")?, repeat)
            .map(|source| Box::new(source) as Box<dyn FrameSource>)
            .map_err(|problem| parameters.error("path", problem, "name a bag, and its images in `topic`")),
        "v4l2" => {
            let size = match lens {
                Some(lens) => [lens.width, lens.height],
                // The descriptors keep both within 8192.
                None => [parameters.usize("width")? as u32, parameters.usize("height")? as u32],
            };
            Ok(Box::new(DeviceSource::new(path, size, rate, format(parameters)?, exposure_delay)))
        }
        _ => Err(parameters.error("source", "is not a source", "write v4l2, folder or bag")),
    }
}

fn format(parameters: &Parameters) -> Result<PixelFormat, ConfigError> {
    Ok(match parameters.str("format")? {
        "yuyv" => PixelFormat::Raw(Encoding::Yuv422Yuy2),
        "mjpeg" => PixelFormat::Jpeg,
        "rgb" => PixelFormat::Raw(Encoding::Rgb8),
        "bgr" => PixelFormat::Raw(Encoding::Bgr8),
        _ => return Err(parameters.error("format", "is not a format", "write yuyv, mjpeg, rgb or bgr")),
    })
}
