//! What the tracker knows, as messages.

use crate::track::{State, Status, Track, Turn};
use nalgebra::SMatrix;
use trench_core::duration_from_seconds;
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::geometry_msgs::{
    Point, Pose, PoseWithCovariance, Quaternion, Transform, TransformStamped, Twist, TwistWithCovariance, Vector3,
};
use trench_msgs::msg::{Identify, Point2, RobotState, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_msgs::Header;

/// The variance of a place never known, m^2 and rad^2.
const UNKNOWN: f64 = 1e6;
/// "Never seen", s: fits into a duration.
pub(crate) const NEVER: f64 = 1e9;

fn header(stamp: Time) -> Header {
    Header { stamp, frame_id: "map".to_owned() }
}

/// The whole team at one exposure.
pub(crate) fn team_state(stamp: Time, frame_number: u64, tracks: &[Track], unnamed: &[[f64; 2]]) -> TeamState {
    let unnamed = unnamed.iter().map(|&[x, y]| Point2 { x, y }).collect();
    TeamState { header: header(stamp), frame_number, robots: tracks.iter().map(robot_state).collect(), unnamed }
}

fn robot_state(track: &Track) -> RobotState {
    let state = track.filter.as_ref().map(|filter| *filter.state());
    let known = state.unwrap_or(State {
        pose: trench_optics::Pose2::default(),
        v: 0.0,
        omega: 0.0,
        covariance: SMatrix::identity() * UNKNOWN,
    });
    let covariance = known.covariance;
    RobotState {
        name: track.name.clone(),
        status: track.status as u8,
        x: known.pose.x,
        y: known.pose.y,
        theta: known.pose.theta,
        v: known.v,
        omega: known.omega,
        pose_covariance: std::array::from_fn(|index| covariance[(index / 3, index % 3)]),
        twist_covariance: std::array::from_fn(|index| covariance[(3 + index / 2, 3 + index % 2)]),
        unseen: duration_from_seconds(track.unseen.min(NEVER)),
    }
}

/// What is asked of a robot whose name is in doubt.
pub(crate) fn identify(stamp: Time, robot: &str, turn: Turn) -> Identify {
    Identify { header: header(stamp), robot: robot.to_owned(), omega: turn.omega }
}

/// Where the robot is, if that is known well enough to show.
pub(crate) fn shown(track: &Track) -> Option<&State> {
    (track.status != Status::Lost).then(|| track.filter.as_ref().map(crate::track::Filter::state)).flatten()
}

/// `<r>/odom`
pub(crate) fn odometry(stamp: Time, name: &str, state: &State) -> Odometry {
    // Rows and columns of the 6 x 6 matrices over (x, y, z, rotations): x, y, rotation about z; forward, rotation about z.
    let spread = |places: [(usize, usize); 3]| {
        let mut wide = [0.0; 36];
        for (row, own_row) in places {
            for (column, own_column) in places {
                wide[6 * row + column] = state.covariance[(own_row, own_column)];
            }
        }
        wide
    };
    let twist =
        Twist { linear: Vector3 { x: state.v, y: 0.0, z: 0.0 }, angular: Vector3 { x: 0.0, y: 0.0, z: state.omega } };
    let pose =
        Pose { position: Point { x: state.pose.x, y: state.pose.y, z: 0.0 }, orientation: about_z(state.pose.theta) };
    Odometry {
        header: header(stamp),
        child_frame_id: base_link(name),
        pose: PoseWithCovariance { pose, covariance: spread([(0, 0), (1, 1), (5, 2)]) },
        // The sideways speed is zero: its place stays empty.
        twist: TwistWithCovariance { twist, covariance: spread([(0, 3), (5, 4), (5, 4)]) },
    }
}

/// map -> `<r>`/base_link
pub(crate) fn transform(stamp: Time, name: &str, state: &State) -> TransformStamped {
    TransformStamped {
        header: header(stamp),
        child_frame_id: base_link(name),
        transform: Transform {
            translation: Vector3 { x: state.pose.x, y: state.pose.y, z: 0.0 },
            rotation: about_z(state.pose.theta),
        },
    }
}

fn base_link(name: &str) -> String {
    format!("{name}/base_link")
}

fn about_z(theta: f64) -> Quaternion {
    Quaternion { x: 0.0, y: 0.0, z: libm::sin(0.5 * theta), w: libm::cos(0.5 * theta) }
}
