//! While the run is not running, one command passes: the small turn by which the localizer finds out which robot is which.
//!
//! The bridge hears the localizer itself and lets through nothing but a slow turn on the spot, of the one robot that is asked,
//! while it is asked. An emergency stop stops that too.

use crate::core::RfBridge;
use crate::robot::Robot;
use trench_core::{Steady, Times};
use trench_msgs::msg::Identify;

/// What is not said again within this time is over, s.
const ASKED: f64 = 0.12;
/// No faster turn passes, rad/s.
const FASTEST: f64 = 1.2;

impl RfBridge {
    /// The localizer asks a robot to turn.
    pub(crate) fn hear_identify(&mut self, at: Times, message: &Identify) {
        let age = at.ros.seconds_since((&message.header.stamp).into());
        let robot = self.robots.iter().position(|robot| robot.name == message.robot);
        self.turning = robot.filter(|_| age <= self.tuning.information_age).map(|robot| (robot, at.steady));
    }

    /// The robot that may turn although the run is not running.
    pub(crate) fn turning(&self, now: Steady) -> Option<usize> {
        let stopped = self.stop.active() || self.stop.reached_for(now);
        let asked = self.turning.filter(|(_, heard)| !stopped && now.seconds_since(*heard) <= ASKED);
        asked.map(|(robot, _)| robot).filter(|robot| self.robots[*robot].only_turns(FASTEST))
    }

    /// Makes all robots stand but one.
    pub(crate) fn halt_but(&mut self, turning: Option<usize>) {
        for (index, robot) in self.robots.iter_mut().enumerate() {
            if Some(index) != turning {
                Robot::halt(robot);
            }
        }
    }
}
