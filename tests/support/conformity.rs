//! How far robots are from their segments (5.2.1), by ground truth: in lock-step and from bags alike.

use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_formation::curve::Curve;
use trench_msgs::Message;
use trench_msgs::msg::{Assignment, Formation, Goals, RunState};
use trench_msgs::nav_msgs::Odometry;
use trench_plan::curve_from_message;

/// Where a formation's frame is: x and y (m), direction (rad).
type Place = [f64; 3];

/// Gathers what is published. All times are ns of ROS time.
#[derive(Default)]
pub(crate) struct Conformity {
    /// By robot and exposure.
    truth: BTreeMap<String, BTreeMap<i64, [f64; 2]>>,
    frames: BTreeMap<i64, Place>,
    assignments: BTreeMap<i64, Assignment>,
    /// Of each formation, from when on.
    segments: BTreeMap<i64, Vec<Curve>>,
    t0: Option<i64>,
}

/// One robot's distance from its segment over the run: time since t0 (s), distance (m).
type Distances = Vec<(f64, f64)>;

/// What came out.
#[derive(Debug, Clone, Default)]
pub(crate) struct Conformed {
    pub(crate) robots: BTreeMap<String, Distances>,
    /// Where each robot is at the end, m.
    pub(crate) places: BTreeMap<String, [f64; 2]>,
    /// Robot, queue and rank, in the order of the last assignment.
    pub(crate) assignment: Vec<(String, u32, u32)>,
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
            "/run_state" => {
                let run = RunState::decode(cdr).unwrap();
                let t0 = nanoseconds(&run.t0);
                if run.state == RunState::RUNNING && t0 != 0 {
                    self.t0.get_or_insert(t0);
                }
            }
            _ => {
                let robot = topic.strip_prefix("/ground_truth/").and_then(|rest| rest.strip_suffix("/odom"));
                if let Some(robot) = robot {
                    let odometry = Odometry::decode(cdr).unwrap();
                    let position = [odometry.pose.pose.position.x, odometry.pose.pose.position.y];
                    let track = self.truth.entry(robot.to_owned()).or_default();
                    track.insert(nanoseconds(&odometry.header.stamp), position);
                }
            }
        }
    }

    pub(crate) fn finish(&self) -> Conformed {
        let t0 = self.t0.unwrap();
        let mut conformed = Conformed::default();
        for (robot, track) in &self.truth {
            let distance = |(stamp, position): (&i64, &[f64; 2])| {
                let distance = self.distance(robot, *stamp, *position)?;
                Some(((stamp - t0) as f64 * 1e-9, distance))
            };
            conformed.places.insert(robot.clone(), *track.last_key_value().unwrap().1);
            let distances: Distances = track.range(t0..).filter_map(distance).collect();
            // A robot that never had a place has none.
            if !distances.is_empty() {
                conformed.robots.insert(robot.clone(), distances);
            }
        }
        let (_, last) = self.assignments.last_key_value().unwrap();
        let member = |member: &trench_msgs::msg::Member| (member.robot.clone(), member.queue, member.rank);
        conformed.assignment = last.members.iter().map(member).collect();
        conformed
    }

    /// From the segment of the robot's queue as assigned and placed at that time, m; nothing where nobody says it.
    fn distance(&self, robot: &str, stamp: i64, position: [f64; 2]) -> Option<f64> {
        let (_, assignment) = self.assignments.range(..=stamp).next_back()?;
        let queue = assignment.members.iter().find(|member| member.robot == robot)?.queue;
        let [x, y, theta] = *self.frames.get(&stamp)?;
        let (dx, dy) = (position[0] - x, position[1] - y);
        let (sin, cos) = libm::sincos(theta);
        let in_frame = trench_formation::Vector2::new(cos * dx + sin * dy, cos * dy - sin * dx);
        let (_, segments) = self.segments.range(..=stamp).next_back()?;
        Some(segments.get(queue as usize)?.nearest(in_frame).distance)
    }
}

impl Conformed {
    /// The largest distance from its segment that any robot has at the end, m.
    pub(crate) fn at_the_end(&self) -> f64 {
        self.robots.values().map(|distances| distances.last().unwrap().1).fold(0.0, f64::max)
    }

    /// The largest distance between the places of a robot at the end of both runs, m.
    pub(crate) fn apart(&self, other: &Self) -> f64 {
        let apart = |(robot, [x, y]): (&String, &[f64; 2])| {
            let [other_x, other_y] = other.places[robot];
            libm::hypot(x - other_x, y - other_y)
        };
        self.places.iter().map(apart).fold(0.0, f64::max)
    }

    /// When each robot came within `bound` of its segment for good, s: infinity for one that is not there at the end.
    pub(crate) fn conforming_from(&self, bound: f64) -> BTreeMap<&str, f64> {
        let from = |distances: &Distances| match distances.iter().rposition(|(_, distance)| *distance > bound) {
            None => 0.0,
            Some(last) => distances.get(last + 1).map_or(f64::INFINITY, |(time, _)| *time),
        };
        self.robots.iter().map(|(robot, distances)| (robot.as_str(), from(distances))).collect()
    }

    /// The median over the robots of the time from which they conform, s.
    pub(crate) fn median_time(&self, bound: f64) -> f64 {
        let mut times: Vec<f64> = self.conforming_from(bound).into_values().collect();
        times.sort_by(f64::total_cmp);
        let upper = times.len() / 2;
        if times.len().is_multiple_of(2) { 0.5 * (times[upper - 1] + times[upper]) } else { times[upper] }
    }

    /// From `since` on, how long it took until all robots were within `bound` of their segments, s.
    pub(crate) fn formed_after(&self, since: f64, bound: f64) -> Option<f64> {
        let times = self.robots.values().next()?.iter().map(|(time, _)| *time).filter(|time| *time >= since);
        let within = |time: f64| {
            let at =
                |distances: &Distances| distances.get(distances.partition_point(|(other, _)| *other < time)).copied();
            self.robots.values().all(|distances| at(distances).is_some_and(|(_, distance)| distance <= bound))
        };
        times.into_iter().find(|time| within(*time)).map(|time| time - since)
    }
}

fn nanoseconds(time: &trench_msgs::builtin_interfaces::Time) -> i64 {
    RosTime::from(time).0
}
