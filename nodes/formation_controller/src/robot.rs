//! What the robot is known to do, and what its motors can follow.

use crate::hold::Hold;
use crate::tick::{Command, Tick, pose_of};
use trench_core::{RosTime, Times};
use trench_formation::kinematics::{Limited, Twist, Wheels, saturate};
use trench_msgs::msg::{LeaderState, RobotState};

/// Speeds by which a robot may miss its command before it counts as deviating, and for how long (invariant 8).
pub(crate) const DEVIATION: (f64, f64, f64) = (0.08, 2.5, 0.3);

/// A stamp may be this far ahead of our clock, s: more is a pose from the future, which nobody has.
pub(crate) const CLOCK_ERROR: f64 = 0.005;

impl Tick {
    /// The robot's state, if it is one to drive by.
    pub(crate) fn usable_state(&self, at: Times, command: &mut Command) -> Result<&RobotState, Hold> {
        let state = self.inputs.robot(&self.settings.robot).ok_or(Hold::NoTeamState)?;
        if !matches!(state.status, RobotState::STATUS_TRACKED | RobotState::STATUS_PREDICTED) {
            return Err(Hold::NotSeen(state.status));
        }
        // Both clocks: the stamp tells how old the pose was on arrival, the monotonic clock how long it has lain here.
        let lain = self.inputs.team.as_ref().map_or(f64::INFINITY, |team| at.steady.seconds_since(team.at));
        let stamped = at.ros.seconds_since(command.exposure);
        let unseen = unseen(state);
        if stamped.max(lain) + unseen > self.settings.information_age_limit {
            command.limits |= LeaderState::LIMIT_STALE;
            return Err(Hold::OldPose(stamped.max(lain) + unseen));
        }
        if stamped.max(lain) > self.settings.pose_age_limit || stamped < -CLOCK_ERROR {
            command.limits |= LeaderState::LIMIT_STALE;
            return Err(Hold::OldPose(stamped));
        }
        Ok(state)
    }

    pub(crate) fn deviates(&mut self, exposure: RosTime, state: &RobotState, command: &mut Command) {
        let seen = Twist { v: state.v, omega: state.omega };
        // The localizer's velocity lags by a few frames: anything the robot was told lately explains it.
        let commands = [self.predictor.in_force(exposure.plus_seconds(-0.15)), self.predictor.in_force(exposure)];
        if self.deviation.observe(exposure, seen, commands) {
            command.limits |= LeaderState::LIMIT_DEVIATES;
        }
        if state.status == RobotState::STATUS_TRACKED {
            command.strays = self.following.observe(exposure, pose_of(state), &self.predictor);
        } else {
            self.following.restart();
        }
    }

    /// The twist nearest to the law's that the wheels can follow from what they were told last.
    pub(crate) fn followable(&self, twist: Twist, acts: RosTime, command: &mut Command) -> Twist {
        let wanted = saturate(self.settings.axle.wheels(twist), self.settings.max_wheel_speed);
        if wanted.acted {
            command.limits |= LeaderState::LIMIT_WHEELS;
        }
        let ramped = self.ramped(wanted.value, acts);
        if ramped.acted {
            command.limits |= LeaderState::LIMIT_RAMP;
        }
        self.settings.axle.twist(ramped.value)
    }

    fn ramped(&self, wanted: Wheels, acts: RosTime) -> Limited<Wheels> {
        let (current, interval) = self.since_last(acts);
        self.settings.ramp.limit(current, wanted, interval)
    }

    /// What the safety filter asks for, as far as each wheel can follow from what it was told last, braking or turning away as hard as it
    /// can: steps told beyond that are missed, and bring nothing.
    pub(crate) fn within_reach(&self, twist: Twist, acts: RosTime, command: &mut Command) -> Twist {
        let asked = self.settings.axle.wheels(twist);
        let (current, interval) = self.since_last(acts);
        let told = saturate(asked, self.settings.max_wheel_speed).value;
        let reached = self.settings.ramp.limit_each(current, told, interval);
        if reached == asked {
            return twist;
        }
        command.limits |= LeaderState::LIMIT_RAMP;
        self.settings.axle.twist(reached)
    }

    /// What the wheels make of `told`. Who is told to rest at once is told more than they can follow: that is meant for the worst.
    pub(crate) fn reached(&self, told: Wheels, acts: RosTime) -> Wheels {
        let (current, interval) = self.since_last(acts);
        self.settings.ramp.reached(current, told, interval)
    }

    /// The wheels as they are when the next command acts, and how long they will have obeyed the last one, s.
    fn since_last(&self, acts: RosTime) -> (Wheels, f64) {
        let (before, current) = self.last.unwrap_or((acts, Wheels::default()));
        (current, acts.seconds_since(before).clamp(0.0, 0.1))
    }
}

/// Seconds since a robot was seen, at the exposure.
pub(crate) fn unseen(state: &RobotState) -> f64 {
    (f64::from(state.unseen.sec) + 1e-9 * f64::from(state.unseen.nanosec)).max(0.0)
}
