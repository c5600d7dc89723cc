//! Robots and the target: poses from /team_state, ground truth, links.

use crate::{Point, point, seconds, short};
use serde::Serialize;
use trench_core::RosTime;
use trench_msgs::msg::{LinkStatus, RobotState, TeamState};
use trench_msgs::nav_msgs::Odometry;

/// All robots at one exposure.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Team {
    /// s, ROS time.
    stamp: f64,
    frame: u64,
    pub(crate) robots: Vec<Robot>,
}

/// One robot: where it is, how it moves, how well that is known.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Robot {
    pub(crate) name: String,
    status: &'static str,
    pub(crate) at: Point,
    theta: Option<f64>,
    v: Option<f64>,
    omega: Option<f64>,
}

impl Team {
    pub(crate) fn of(team: &TeamState) -> Self {
        let robots = team.robots.iter().map(Robot::of).collect();
        Self { stamp: seconds(RosTime::from(&team.header.stamp)), frame: team.frame_number, robots }
    }
}

impl Robot {
    fn of(robot: &RobotState) -> Self {
        let status = match robot.status {
            RobotState::STATUS_TRACKED => "tracked",
            RobotState::STATUS_PREDICTED => "predicted",
            RobotState::STATUS_AMBIGUOUS => "ambiguous",
            _ => "lost",
        };
        Self {
            name: robot.name.clone(),
            status,
            at: point(robot.x, robot.y),
            theta: short(robot.theta),
            v: short(robot.v),
            omega: short(robot.omega),
        }
    }
}

/// A pose out of an Odometry: the target's, or ground truth.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Posed {
    at: Point,
    theta: Option<f64>,
    v: Option<f64>,
}

impl Posed {
    pub(crate) fn of(odometry: &Odometry) -> Self {
        let (pose, q) = (&odometry.pose.pose, &odometry.pose.pose.orientation);
        let theta = (2.0 * (q.w * q.z + q.x * q.y)).atan2(1.0 - 2.0 * (q.y * q.y + q.z * q.z));
        let speed = &odometry.twist.twist.linear;
        Self { at: point(pose.position.x, pose.position.y), theta: short(theta), v: short(speed.x.hypot(speed.y)) }
    }
}

/// The command link to one robot.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Link {
    pub(crate) up: bool,
    /// 0 to 1.
    loss: Option<f64>,
    /// dBm.
    signal: Option<f64>,
    /// s.
    round_trip: Option<f64>,
    hops: u8,
    faults: Vec<&'static str>,
}

/// Loss above this part is told.
const WEAK: f64 = 0.2;

const FAULTS: [(u8, &str); 4] = [
    (LinkStatus::FAULT_COMMAND_TIMEOUT, "no commands"),
    (LinkStatus::FAULT_EMERGENCY_STOP, "emergency stop"),
    (LinkStatus::FAULT_LOW_BATTERY, "low battery"),
    (LinkStatus::FAULT_MISSED_STEPS, "missed steps"),
];

impl Link {
    /// Up, but something is the matter: as the page judges it.
    pub(crate) fn is_weak(&self) -> bool {
        self.loss.is_some_and(|loss| loss > WEAK) || !self.faults.is_empty()
    }

    pub(crate) fn of(link: &LinkStatus) -> Self {
        let faults = FAULTS.iter().filter(|(bit, _)| link.fault & bit != 0).map(|(_, name)| *name).collect();
        Self {
            up: link.up,
            loss: short(link.loss),
            signal: short(link.signal),
            round_trip: short(link.round_trip),
            hops: link.hops,
            faults,
        }
    }
}
