//! From a bag to a run.

use super::{ContactSample, GoalSample, Pose, Run, Track};
use crate::{BagError, BagReader};
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{Assignment, Formation, Goals, LeaderState, RobotState, RunState, TeamState};
use trench_msgs::nav_msgs::Odometry;

impl Run {
    /// Reads a run out of a bag. Poses are those of `/ground_truth/<robot>/odom` where the bag has them, else those
    /// of `/team_state`; goals, formation, assignment and the beginning come from the topics of their names, V from leader states.
    ///
    /// # Errors
    /// When the bag cannot be read. Messages that cannot are counted in [`Run::undecodable`].
    pub fn from_bag(bag: &BagReader) -> Result<Self, BagError> {
        Self::built(bag, RunBuilder::default())
    }

    /// As [`Run::from_bag`] with the poses that the localizer measured, also where the ground truth is known.
    ///
    /// # Errors
    /// As [`Run::from_bag`].
    pub fn measured(bag: &BagReader) -> Result<Self, BagError> {
        Self::built(bag, RunBuilder { leaves_out_truth: true, ..RunBuilder::default() })
    }

    fn built(bag: &BagReader, mut builder: RunBuilder) -> Result<Self, BagError> {
        let roles: Vec<_> = bag.topics().iter().map(|topic| Role::of(&topic.name, &topic.type_name)).collect();
        for message in bag.messages() {
            let message = message?;
            if let Some(role) = roles.get(message.topic)
                && builder.take_as(role, &message).is_none()
            {
                builder.run.undecodable += 1;
            }
        }
        Ok(builder.finish())
    }
}

/// What a topic is to a run.
enum Role {
    GroundTruth(String),
    Contacts,
    TeamState,
    Goals,
    Formation,
    Assignment,
    RunState,
    LeaderState,
    Scenario,
    Other,
}

impl Role {
    fn of(topic: &str, type_name: &str) -> Self {
        match (topic, type_name) {
            ("/team_state", "trench_msgs/msg/TeamState") => Self::TeamState,
            ("/goals", "trench_msgs/msg/Goals") => Self::Goals,
            ("/formation", "trench_msgs/msg/Formation") => Self::Formation,
            ("/assignment", "trench_msgs/msg/Assignment") => Self::Assignment,
            ("/run_state", "trench_msgs/msg/RunState") => Self::RunState,
            ("/scenario", "std_msgs/msg/String") => Self::Scenario,
            ("/ground_truth/contacts", "diagnostic_msgs/msg/DiagnosticArray") => Self::Contacts,
            (name, "trench_msgs/msg/LeaderState") if name.ends_with("/leader_state") => Self::LeaderState,
            (name, "nav_msgs/msg/Odometry") => {
                let robot = name.strip_prefix("/ground_truth/").and_then(|rest| rest.strip_suffix("/odom"));
                robot.map_or(Self::Other, |robot| Self::GroundTruth(robot.to_owned()))
            }
            _ => Self::Other,
        }
    }
}

/// Makes a run of messages as they come: from a bag, or from a simulation while it goes.
#[derive(Debug, Default)]
pub struct RunBuilder {
    run: Run,
    /// By robot, with times still in ns.
    truth: BTreeMap<String, Vec<(i64, Pose)>>,
    estimates: BTreeMap<String, Vec<(i64, Pose)>>,
    goals: BTreeMap<String, Vec<(i64, GoalSample)>>,
    lyapunov: BTreeMap<String, Vec<(i64, f64)>>,
    contacts: Vec<(i64, ContactSample)>,
    /// Whether ground truth is passed over.
    leaves_out_truth: bool,
}

impl RunBuilder {
    /// Takes a message; what is nothing to a run is passed over, what cannot be read is counted.
    pub fn take(&mut self, topic: &str, type_name: &str, cdr: &[u8]) {
        if self.take_as(&Role::of(topic, type_name), cdr).is_none() {
            self.run.undecodable += 1;
        }
    }

    /// Nothing where the message cannot be read.
    fn take_as(&mut self, role: &Role, message: &[u8]) -> Option<()> {
        match role {
            Role::GroundTruth(_) if self.leaves_out_truth => {}
            Role::GroundTruth(robot) => {
                let odometry = Odometry::decode(message).ok()?;
                let pose = pose_of(&odometry)?;
                self.truth.entry(robot.clone()).or_default().push((RosTime::from(&odometry.header.stamp).0, pose));
            }
            Role::Contacts => {
                let array = DiagnosticArray::decode(message).ok()?;
                let stamp = RosTime::from(&array.header.stamp).0;
                for status in &array.status {
                    self.contacts.push((stamp, ContactSample::read(status)?));
                }
            }
            Role::TeamState => {
                let team = TeamState::decode(message).ok()?;
                let stamp = RosTime::from(&team.header.stamp).0;
                for robot in team.robots.iter().filter(|robot| is_seen(robot)) {
                    let RobotState { x, y, theta, v, omega, .. } = *robot;
                    let pose = Pose { time: 0.0, x, y, theta, v, omega };
                    self.estimates.entry(robot.name.clone()).or_default().push((stamp, finite(pose)?));
                }
            }
            Role::Goals => {
                let goals = Goals::decode(message).ok()?;
                let stamp = RosTime::from(&goals.header.stamp).0;
                for goal in &goals.goals {
                    let sample = GoalSample {
                        time: 0.0,
                        position: [goal.position.x, goal.position.y],
                        velocity: [goal.velocity.x, goal.velocity.y],
                        remaining: goal.remaining,
                    };
                    self.goals.entry(goal.robot.clone()).or_default().push((stamp, sample));
                }
            }
            Role::Formation => self.run.formation = Some(Formation::decode(message).ok()?),
            Role::Scenario => self.run.scenario = Some(trench_msgs::std_msgs::String::decode(message).ok()?.data),
            Role::Assignment => self.run.assignment = Some(Assignment::decode(message).ok()?),
            Role::RunState => {
                let state = RunState::decode(message).ok()?;
                let t0 = RosTime::from(&state.t0).0;
                // The first run of a bag is the one that is judged.
                if state.state == RunState::RUNNING && t0 != 0 {
                    self.run.t0.get_or_insert(t0);
                }
                self.run.state = Some(state);
            }
            Role::LeaderState => {
                let state = LeaderState::decode(message).ok()?;
                let sample = (RosTime::from(&state.header.stamp).0, state.lyapunov);
                self.lyapunov.entry(state.robot).or_default().push(sample);
            }
            Role::Other => {}
        }
        Some(())
    }

    /// The run, its times counted from t0.
    #[must_use]
    pub fn finish(self) -> Run {
        let Self { mut run, truth, estimates, goals, lyapunov, mut contacts, .. } = self;
        run.is_ground_truth = !truth.is_empty();
        let poses = if truth.is_empty() { estimates } else { truth };
        let first = poses.values().filter_map(|poses| poses.iter().map(|(stamp, _)| *stamp).min()).min();
        let t0 = run.t0.or(first).unwrap_or(0);
        let seconds = |stamp: i64| RosTime(stamp).seconds_since(RosTime(t0));
        for (robot, poses) in poses {
            let track = run.robots.entry(robot).or_default();
            track.poses = poses.into_iter().map(|(stamp, pose)| Pose { time: seconds(stamp), ..pose }).collect();
        }
        for (robot, goals) in goals {
            let track = run.robots.entry(robot).or_default();
            track.goals = goals.into_iter().map(|(stamp, goal)| GoalSample { time: seconds(stamp), ..goal }).collect();
        }
        for (robot, values) in lyapunov {
            if let Some(track) = run.robots.get_mut(&robot) {
                track.lyapunov = values.into_iter().map(|(stamp, value)| (seconds(stamp), value)).collect();
            }
        }
        contacts.sort_by_key(|(stamp, _)| *stamp);
        let timed = |(stamp, contact)| ContactSample { time: seconds(stamp), ..contact };
        run.contacts = contacts.into_iter().map(timed).collect();
        run.robots.values_mut().for_each(Track::sort);
        run
    }
}

fn is_seen(robot: &RobotState) -> bool {
    matches!(robot.status, RobotState::STATUS_TRACKED | RobotState::STATUS_PREDICTED)
}

fn pose_of(odometry: &Odometry) -> Option<Pose> {
    let pose = &odometry.pose.pose;
    let q = &pose.orientation;
    // The yaw of a quaternion; robots stand on the plane.
    let theta = (2.0 * (q.w * q.z + q.x * q.y)).atan2(1.0 - 2.0 * (q.y * q.y + q.z * q.z));
    let twist = &odometry.twist.twist;
    finite(Pose { time: 0.0, x: pose.position.x, y: pose.position.y, theta, v: twist.linear.x, omega: twist.angular.z })
}

fn finite(pose: Pose) -> Option<Pose> {
    [pose.x, pose.y, pose.theta, pose.v, pose.omega].iter().all(|value| value.is_finite()).then_some(pose)
}
