//! What the test bed publishes, as ROS messages.

use trench_core::RosTime;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use trench_msgs::geometry_msgs::Quaternion;
use trench_msgs::msg::{Obstacle, ObstacleArray, Point2};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::sensor_msgs::{CameraInfo, LaserScan};
use trench_msgs::std_msgs::Header;
use trench_optics::{Lens, PlumbBob};
use trench_sim::{Contact, Laser, Thing, Truth};

pub(crate) fn header(stamp: RosTime, frame_id: &str) -> Header {
    Header { stamp: stamp.into(), frame_id: frame_id.to_owned() }
}

/// The lens, for an image with this stamp.
pub(crate) fn camera_info(stamp: RosTime, frame_id: &str, lens: &Lens) -> CameraInfo {
    let Lens { width, height, fx, fy, cx, cy, distortion } = *lens;
    let PlumbBob { k1, k2, p1, p2, k3 } = distortion;
    CameraInfo::plumb_bob(header(stamp, frame_id), [width, height], [fx, fy], [cx, cy], [k1, k2, p1, p2, k3])
}

/// Where a robot really is.
pub(crate) fn odometry(stamp: RosTime, robot: &str, truth: &Truth) -> Odometry {
    let mut message =
        Odometry { header: header(stamp, "map"), child_frame_id: format!("{robot}/base_link"), ..Odometry::default() };
    let pose = &mut message.pose.pose;
    (pose.position.x, pose.position.y) = (truth.pose.x, truth.pose.y);
    let (sin, cos) = libm::sincos(0.5 * truth.pose.theta);
    pose.orientation = Quaternion { x: 0.0, y: 0.0, z: sin, w: cos };
    message.twist.twist.linear.x = truth.v;
    message.twist.twist.angular.z = truth.omega;
    message
}

/// What stands in the field.
pub(crate) fn obstacles(stamp: RosTime, obstacles: &[trench_sim::Obstacle]) -> ObstacleArray {
    let point = |[x, y]: [f64; 2]| Point2 { x, y };
    let obstacle = |obstacle: &trench_sim::Obstacle| Obstacle {
        id: obstacle.id(),
        polygon: obstacle.outline().corners.iter().copied().map(point).collect(),
        radius: obstacle.outline().radius,
        velocity: point(obstacle.velocity()),
    };
    ObstacleArray { header: header(stamp, "map"), obstacles: obstacles.iter().map(obstacle).collect() }
}

/// What a robot's laser measured; its rays leave together.
pub(crate) fn scan(stamp: RosTime, robot: &str, laser: &Laser, ranges: Vec<f32>) -> LaserScan {
    LaserScan {
        header: header(stamp, &format!("{robot}/base_link")),
        angle_min: laser.angle_min() as f32,
        angle_max: (laser.angle_min() + laser.increment() * ranges.len().saturating_sub(1) as f64) as f32,
        angle_increment: laser.increment() as f32,
        time_increment: 0.0,
        scan_time: (laser.period as f64 * 1e-9) as f32,
        range_min: laser.range_min as f32,
        range_max: laser.range_max as f32,
        ranges,
        intensities: Vec::new(),
    }
}

/// Two bodies touch.
pub(crate) fn contact(stamp: RosTime, contact: &Contact, robots: &[String]) -> DiagnosticArray {
    let name = |robot: usize| robots.get(robot).map_or("?", String::as_str);
    let thing = match contact.thing {
        Thing::Robot(other) => name(other).to_owned(),
        Thing::Obstacle(number) => format!("obstacle {}", number + 1),
        Thing::Edge(side) => {
            format!("{} edge", ["west", "east", "south", "north"].get(usize::from(side)).unwrap_or(&"?"))
        }
    };
    let value = |key: &str, value: f64| KeyValue { key: key.to_owned(), value: value.to_string() };
    let status = DiagnosticStatus {
        level: 2,
        name: format!("contact: {}", name(contact.robot)),
        message: format!("{} touches {thing}", name(contact.robot)),
        hardware_id: name(contact.robot).to_owned(),
        values: vec![
            KeyValue { key: "thing".to_owned(), value: thing },
            value("x", contact.pose.x),
            value("y", contact.pose.y),
        ],
    };
    DiagnosticArray { header: header(stamp, "map"), status: vec![status] }
}
