//! How far robots are from their segments (5.2.1), by ground truth: in lock-step and from bags alike.

use super::hindrance::{Field, Hindrance};
use nalgebra::Isometry2;
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, Placed};
use trench_formation::kinematics::wrap;
use trench_msgs::Message;
use trench_msgs::msg::{Assignment, Formation, Goals, LeaderState, RunState};
use trench_msgs::nav_msgs::Odometry;
use trench_plan::curve_from_message;

/// Where a formation's frame is: x and y (m), direction (rad).
type Place = [f64; 3];

/// Gathers what is published. All times are ns of ROS time.
#[derive(Default)]
pub(crate) struct Conformity {
    /// By robot and exposure.
    truth: BTreeMap<String, BTreeMap<i64, [f64; 2]>>,
    /// Each robot's last heading, rad.
    headings: BTreeMap<String, f64>,
    frames: BTreeMap<i64, Place>,
    assignments: BTreeMap<i64, Assignment>,
    /// Of each formation, from when on.
    segments: BTreeMap<i64, Vec<Curve>>,
    t0: Option<i64>,
    field: Field,
    /// What each robot's law drives (its point off the axle, or its centre) by its last word, m.
    points: BTreeMap<String, [f64; 2]>,
}

/// One robot at one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Since t0, s.
    pub(crate) time: f64,
    /// m.
    place: Vector2<f64>,
    /// From its segment, m.
    pub(crate) distance: f64,
}

/// What came out.
#[derive(Debug, Clone, Default)]
pub(crate) struct Conformed {
    /// Each robot's way, as long as it has a segment.
    pub(crate) robots: BTreeMap<String, Vec<Sample>>,
    /// Where each robot is at the end, m, with a segment or without.
    pub(crate) places: BTreeMap<String, [f64; 2]>,
    /// What each robot's law drives, at the end, m.
    pub(crate) points: BTreeMap<String, [f64; 2]>,
    /// Where each robot looks at the end, rad.
    pub(crate) headings: BTreeMap<String, f64>,
    /// Where its formation does, rad.
    formation: f64,
    /// Robot, queue and rank, in the order of the last assignment.
    pub(crate) assignment: Vec<(String, u32, u32)>,
    pub(crate) hindrance: Hindrance,
}

impl Conformity {
    pub(crate) fn take(&mut self, topic: &str, cdr: &[u8]) {
        match topic {
            "/goals" => {
                let goals = Goals::decode(cdr).unwrap();
                let frame = &goals.frame;
                self.frames.insert(nanoseconds(&goals.header.stamp), [frame.position.x, frame.position.y, frame.theta]);
            }
            "/formation" => {
                let formation = Formation::decode(cdr).unwrap();
                let segments = formation.queues.iter().map(|queue| curve_from_message(&queue.segment).unwrap());
                self.segments.insert(nanoseconds(&formation.header.stamp), segments.collect());
            }
            "/assignment" => {
                let assignment = Assignment::decode(cdr).unwrap();
                self.assignments.insert(nanoseconds(&assignment.header.stamp), assignment);
            }
            "/obstacles" => self.field.take(cdr),
            "/run_state" => {
                let run = RunState::decode(cdr).unwrap();
                let t0 = nanoseconds(&run.t0);
                if run.state == RunState::RUNNING && t0 != 0 {
                    self.t0.get_or_insert(t0);
                }
            }
            _ if topic.ends_with("/leader_state") => {
                let state = LeaderState::decode(cdr).unwrap();
                self.points.insert(state.robot, [state.point.x, state.point.y]);
            }
            _ => {
                let robot = topic.strip_prefix("/ground_truth/").and_then(|rest| rest.strip_suffix("/odom"));
                if let Some(robot) = robot {
                    let odometry = Odometry::decode(cdr).unwrap();
                    let pose = &odometry.pose.pose;
                    let position = [pose.position.x, pose.position.y];
                    self.headings.insert(robot.to_owned(), 2.0 * libm::atan2(pose.orientation.z, pose.orientation.w));
                    let track = self.truth.entry(robot.to_owned()).or_default();
                    track.insert(nanoseconds(&odometry.header.stamp), position);
                }
            }
        }
    }

    pub(crate) fn finish(&self) -> Conformed {
        let t0 = self.t0.unwrap();
        let mut conformed =
            Conformed { points: self.points.clone(), headings: self.headings.clone(), ..Conformed::default() };
        for (robot, track) in &self.truth {
            let hindrance = &mut conformed.hindrance;
            let sample = |(stamp, position): (&i64, &[f64; 2])| {
                let (time, way) = ((stamp - t0) as f64 * 1e-9, self.way(robot, *stamp, *position)?);
                self.field.look(hindrance, (robot, *stamp, time), way);
                Some(Sample { time, place: way[0], distance: (way[1] - way[0]).norm() })
            };
            conformed.places.insert(robot.clone(), *track.last_key_value().unwrap().1);
            let way: Vec<Sample> = track.range(t0..).filter_map(sample).collect();
            // A robot that never had a place has none.
            if !way.is_empty() {
                conformed.robots.insert(robot.clone(), way);
            }
        }
        conformed.formation = self.frames.last_key_value().unwrap().1[2];
        let (_, last) = self.assignments.last_key_value().unwrap();
        let member = |member: &trench_msgs::msg::Member| (member.robot.clone(), member.queue, member.rank);
        conformed.assignment = last.members.iter().map(member).collect();
        conformed
    }

    /// From a robot straight to the segment of its queue, as assigned and placed at that time, m; nothing where nobody says it.
    fn way(&self, robot: &str, stamp: i64, position: [f64; 2]) -> Option<[Vector2<f64>; 2]> {
        let (_, assignment) = self.assignments.range(..=stamp).next_back()?;
        let queue = assignment.members.iter().find(|member| member.robot == robot)?.queue;
        let [x, y, theta] = *self.frames.get(&stamp)?;
        let frame = Isometry2::new(Vector2::new(x, y), theta);
        let position = Vector2::from(position);
        let (_, segments) = self.segments.range(..=stamp).next_back()?;
        let foot = Placed::new(segments.get(queue as usize)?, frame).nearest(position);
        Some([position, foot.point])
    }
}

impl Conformed {
    /// Where each robot is last before `time`, s.
    fn at(&self, time: f64) -> BTreeMap<&str, Sample> {
        let last = |way: &[Sample]| way[way.partition_point(|sample| sample.time < time) - 1];
        self.robots.iter().map(|(robot, way)| (robot.as_str(), last(way))).collect()
    }

    /// The largest distance from its segment that any robot has at the end, m; infinity if one has been left out before.
    pub(crate) fn at_the_end(&self) -> f64 {
        let last = self.at(f64::INFINITY);
        let end = last.values().map(|sample| sample.time).fold(0.0, f64::max);
        let distance = |sample: &Sample| if sample.time > end - 0.5 { sample.distance } else { f64::INFINITY };
        last.values().map(distance).fold(0.0, f64::max)
    }

    /// The largest distance between the places of a robot in both runs at `time` (s), or at the end before it, m.
    pub(crate) fn apart(&self, other: &Self, time: f64) -> f64 {
        let (ours, theirs) = (self.at(time), other.at(time));
        ours.iter().map(|(robot, sample)| (sample.place - theirs[robot].place).norm()).fold(0.0, f64::max)
    }

    /// The largest distance between what the law of a robot drives in both runs, at the end, m.
    pub(crate) fn points_apart(&self, other: &Self) -> f64 {
        let apart = |(robot, [x, y]): (&String, &[f64; 2])| {
            let [other_x, other_y] = other.points[robot];
            libm::hypot(x - other_x, y - other_y)
        };
        self.points.iter().map(apart).fold(0.0, f64::max)
    }

    /// The largest angle between where a robot looks in both runs, at the end, rad.
    pub(crate) fn turned(&self, other: &Self) -> f64 {
        self.headings.iter().map(|(robot, heading)| wrap(heading - other.headings[robot]).abs()).fold(0.0, f64::max)
    }

    /// The largest angle between where a robot looks and where its formation does, at the end, rad.
    pub(crate) fn askew(&self) -> f64 {
        self.headings.values().map(|heading| wrap(heading - self.formation).abs()).fold(0.0, f64::max)
    }

    /// How long it took each robot from `since` until it was within `bound` of its segment and stayed there until `until`, s:
    /// infinity if it did not.
    fn conforming([since, until]: [f64; 2], bound: f64, way: &[Sample]) -> f64 {
        let [from, to] = [since, until].map(|time| way.partition_point(|sample| sample.time < time));
        let piece = &way[from..to];
        let formed = piece.iter().rposition(|sample| sample.distance > bound).map_or(0, |away| away + 1);
        piece.get(formed).map_or(f64::INFINITY, |sample| sample.time - since)
    }

    /// How long it took all robots from `since` until they were within `bound` of their segments and stayed there until `until`,
    /// s: infinity if they did not.
    pub(crate) fn formed_after(&self, time: [f64; 2], bound: f64) -> f64 {
        self.robots.values().map(|way| Self::conforming(time, bound, way)).fold(0.0, f64::max)
    }

    /// How often something had been in a robot's way and then nothing was for `patience` (s) and more, and how often the robot was within
    /// `bound` of its segment in that time.
    pub(crate) fn recoveries(&self, bound: f64, patience: f64) -> [usize; 2] {
        let mut counted = [0, 0];
        for (robot, times) in &self.hindrance.of {
            let Some(way) = self.robots.get(robot) else { continue };
            let end = way.last().map_or(0.0, |sample| sample.time);
            let free =
                times.iter().zip(times.iter().skip(1).chain([&end])).filter(|(since, next)| *next - *since >= patience);
            for (since, _) in free {
                let from = way.partition_point(|sample| sample.time <= *since);
                let mut soon = way[from..].iter().take_while(|sample| sample.time <= since + patience);
                counted[0] += 1;
                counted[1] += usize::from(soon.any(|sample| sample.distance <= bound));
            }
        }
        counted
    }

    /// The median over the robots of the same, s.
    pub(crate) fn median_time(&self, time: [f64; 2], bound: f64) -> f64 {
        let mut times: Vec<f64> = self.robots.values().map(|way| Self::conforming(time, bound, way)).collect();
        times.sort_by(f64::total_cmp);
        let upper = times.len() / 2;
        if times.len().is_multiple_of(2) { 0.5 * (times[upper - 1] + times[upper]) } else { times[upper] }
    }

    /// Distances from each robot to the one ahead of it in its queue at the end, m.
    pub(crate) fn spacings(&self) -> Vec<f64> {
        let behind = self.assignment.windows(2).filter(|pair| pair[0].1 == pair[1].1);
        let last = self.at(f64::INFINITY);
        behind.map(|pair| (last[pair[0].0.as_str()].place - last[pair[1].0.as_str()].place).norm()).collect()
    }
}

fn nanoseconds(time: &trench_msgs::builtin_interfaces::Time) -> i64 {
    RosTime::from(time).0
}
