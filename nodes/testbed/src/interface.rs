//! How the test bed is made and what it is connected to.

use crate::core::Testbed;
use crate::settings::{Settings, descriptors};
use trench_config::Parameters;
use trench_core::{
    Advertise, ByteStream, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, StartError,
};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{DiscArray, ObstacleArray};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::rosgraph_msgs::Clock;
use trench_msgs::sensor_msgs::{CameraInfo, Image, ImageView, LaserScan};
use trench_msgs::std_msgs::HeaderView;
use trench_msgs::{Message, TypeInfo};
use trench_optics::{Lens, Overhead};

/// Where each publication is.
#[derive(Debug, Clone)]
pub(crate) struct Ports {
    pub(crate) diagnostics: usize,
    pub(crate) contacts: usize,
    /// Of each camera.
    pub(crate) cameras: Vec<CameraPorts>,
    pub(crate) obstacles: Option<usize>,
    pub(crate) clock: Option<usize>,
    /// The first robot's; the others follow.
    pub(crate) truth: usize,
    /// The first laser's; the others follow.
    pub(crate) scans: usize,
}

/// Where a camera's publications are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CameraPorts {
    pub(crate) info: usize,
    /// Images, or detections.
    pub(crate) frames: usize,
}

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "testbed",
        about: "The simulated test bed behind the real interfaces: camera frames out, serial bytes in",
        parameters: descriptors,
        build,
    }
}

fn build(context: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let settings = Settings::read(parameters, files)?;
    let (interface, ports) = interface(&settings);
    Ok(Box::new(Testbed::new(context, settings, interface, ports)))
}

/// The image of a lens, without its pixels.
pub(crate) fn image<'a>(lens: &Lens, frame_id: &'a str, stamp: trench_core::RosTime) -> ImageView<'a> {
    ImageView {
        header: HeaderView { stamp: stamp.into(), frame_id },
        height: lens.height,
        width: lens.width,
        encoding: "rgb8",
        is_bigendian: 0,
        step: 3 * lens.width,
        data: &[],
    }
}

/// Bytes of the pixels of a lens's image.
pub(crate) fn pixel_bytes(lens: &Lens) -> usize {
    3 * lens.width as usize * lens.height as usize
}

fn interface(settings: &Settings) -> (Interface, Ports) {
    let mut publications = Vec::new();
    let mut advertise = |topic: &str, type_info: &'static TypeInfo, qos: Qos, local: Local| {
        publications.push(Advertise { topic: topic.to_owned(), type_info, qos, local });
        publications.len() - 1
    };
    let network = Local::NetworkOnly;
    let diagnostics = advertise("/diagnostics", DiagnosticArray::TYPE, Qos::RELIABLE, network);
    let contacts = advertise("/ground_truth/contacts", DiagnosticArray::TYPE, Qos::RELIABLE, network);
    let camera = |view: &Overhead| {
        let (lens, frame_id) = (view.camera.lens(), view.frame_id());
        let info = advertise(&view.topic("camera_info"), CameraInfo::TYPE, Qos::RELIABLE, Local::SMALL);
        let frames = if settings.render {
            let max_len = image(lens, &frame_id, trench_core::RosTime(0)).encoded_len_with(pixel_bytes(lens));
            let local = Local::SharedMemoryOnly { max_len };
            advertise(&view.topic("image_raw"), Image::TYPE, Qos::SENSOR, local)
        } else {
            let local = Local::SharedMemory { max_len: 16 * 1024 };
            advertise(&view.topic("detections"), DiscArray::TYPE, Qos::RELIABLE, local)
        };
        CameraPorts { info, frames }
    };
    let cameras = settings.cameras.iter().map(camera).collect();
    let obstacles =
        settings.publish_obstacles.then(|| advertise("/obstacles", ObstacleArray::TYPE, Qos::RELIABLE, network));
    let clock = settings.publish_clock.then(|| advertise("/clock", Clock::TYPE, Qos::RELIABLE, network));
    let truth = publications.len();
    for robot in &settings.robots {
        let topic = format!("/ground_truth/{robot}/odom");
        publications.push(Advertise { topic, type_info: Odometry::TYPE, qos: Qos::RELIABLE, local: Local::SMALL });
    }
    let scans = publications.len();
    for robot in settings.bed.lasers.iter().filter_map(|index| settings.robots.get(*index)) {
        // Ranges, and room for the rest of the message.
        let local = Local::SharedMemory { max_len: 4 * settings.bed.laser.rays + 512 };
        let topic = format!("/{robot}/scan");
        publications.push(Advertise { topic, type_info: LaserScan::TYPE, qos: Qos::SENSOR, local });
    }
    let interface = Interface {
        publications,
        byte_streams: vec![ByteStream::PseudoTerminal { link: settings.link.clone() }],
        ..Interface::default()
    };
    (interface, Ports { diagnostics, contacts, cameras, obstacles, clock, truth, scans })
}
