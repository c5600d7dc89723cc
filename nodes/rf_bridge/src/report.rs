//! Telemetry as ROS messages.

use crate::odometry::WheelOdometry;
use trench_core::RosTime;
use trench_msgs::geometry_msgs::Quaternion;
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::sensor_msgs::{BatteryState, Range};
use trench_msgs::std_msgs::Header;
use trench_radio::{NOTHING_IN_RANGE, Telemetry};

/// sensor_msgs/Range's INFRARED.
const INFRARED: u8 = 1;

/// Nearest and farthest distance that the sensors measure, m.
const RANGE_LIMITS: (f32, f32) = (0.02, 0.8);

/// Opening of a sensor's view, rad.
const FIELD_OF_VIEW: f32 = 0.1;

/// Variance of a pose component that wheel odometry does not know.
const UNKNOWN: f64 = 1e6;

/// Variance of x, y (m^2) and heading (rad^2) that goes with slipping wheels.
const SLIPPING: f64 = 1e-2;

fn header(stamp: RosTime, frame_id: String) -> Header {
    Header { stamp: stamp.into(), frame_id }
}

/// The battery's voltage; what the robot does not measure is not a number, as the message wants it.
pub(crate) fn battery(stamp: RosTime, robot: &str, report: &Telemetry) -> BatteryState {
    BatteryState {
        header: header(stamp, format!("{robot}/base_link")),
        voltage: f32::from(report.battery_mv) * 1e-3,
        temperature: f32::NAN,
        current: f32::NAN,
        charge: f32::NAN,
        capacity: f32::NAN,
        design_capacity: f32::NAN,
        percentage: f32::NAN,
        present: true,
        ..BatteryState::default()
    }
}

/// One range sensor's reading: infinite where nothing is in reach (REP-117).
pub(crate) fn range(stamp: RosTime, robot: &str, sensor: usize, centimetres: u8) -> Range {
    let range = if centimetres == NOTHING_IN_RANGE { f32::INFINITY } else { f32::from(centimetres) * 0.01 };
    Range {
        header: header(stamp, format!("{robot}/range_{sensor}")),
        radiation_type: INFRARED,
        field_of_view: FIELD_OF_VIEW,
        min_range: RANGE_LIMITS.0,
        max_range: RANGE_LIMITS.1,
        range,
        ..Range::default()
    }
}

/// Where the wheels say the robot is.
pub(crate) fn odometry(stamp: RosTime, robot: &str, odometry: &WheelOdometry) -> Odometry {
    let mut message = Odometry {
        header: header(stamp, format!("{robot}/wheel_odom")),
        child_frame_id: format!("{robot}/base_link"),
        ..Odometry::default()
    };
    let pose = &mut message.pose.pose;
    (pose.position.x, pose.position.y) = (odometry.x, odometry.y);
    let (sin, cos) = libm::sincos(0.5 * odometry.theta);
    pose.orientation = Quaternion { x: 0.0, y: 0.0, z: sin, w: cos };
    message.twist.twist.linear.x = odometry.v;
    message.twist.twist.angular.z = odometry.omega;
    for (axis, variance) in [SLIPPING, SLIPPING, UNKNOWN, UNKNOWN, UNKNOWN, SLIPPING].into_iter().enumerate() {
        message.pose.covariance[7 * axis] = variance;
        message.twist.covariance[7 * axis] = variance;
    }
    message
}
