//! An experiment read out of a bag, or out of the table that `trench sim` writes: where the robots were, where they
//! should have been, and how well they did.

mod contact;
mod csv;
mod extract;
mod steps;
mod summary;
mod track;

pub use contact::ContactSample;
pub use csv::CsvError;
pub use extract::RunBuilder;
pub use steps::{StepSummary, StepTable, steps};
pub use summary::{Closest, RobotSummary, RunSummary, ShapeSample, SummaryOptions, summary};
pub use track::{GoalSample, Pose, Track};

use std::collections::BTreeMap;
use trench_msgs::msg::{Assignment, Formation, Member, RunState};

/// One run. All times are seconds since [`Run::t0`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Run {
    /// When the run began, ns of ROS time: the first tick with all robots localised while running; nothing where the
    /// bag does not say it, and times count from the first pose.
    pub t0: Option<i64>,
    /// What each robot did, by name.
    pub robots: BTreeMap<String, Track>,
    /// The last formation.
    pub formation: Option<Formation>,
    /// The last assignment.
    pub assignment: Option<Assignment>,
    /// The scenario file that was simulated.
    pub scenario: Option<String>,
    /// The last run state.
    pub state: Option<RunState>,
    /// Who touched whom, by time: known from the ground truth of a simulation alone.
    pub contacts: Vec<ContactSample>,
    /// Whether poses are ground truth; else they are the localizer's.
    pub is_ground_truth: bool,
    /// How many messages of known types could not be read.
    pub undecodable: u64,
}

impl Run {
    /// First and last time of a pose, s.
    #[must_use]
    pub fn span(&self) -> Option<(f64, f64)> {
        let spans = self.robots.values().filter_map(Track::span);
        spans.reduce(|(first, last), (other_first, other_last)| (first.min(other_first), last.max(other_last)))
    }

    /// The vertex a robot makes for, m: its place in its queue where it is the first to have it, else where its goal
    /// came to rest; nothing where that goes on with a target.
    #[must_use]
    pub fn vertex(&self, robot: &str) -> Option<[f64; 2]> {
        self.queue_vertex(robot).or_else(|| self.robots.get(robot)?.goals.last()?.resting_place())
    }

    fn queue_vertex(&self, robot: &str) -> Option<[f64; 2]> {
        let members = &self.assignment.as_ref()?.members;
        let member = members.iter().find(|member| member.robot == robot)?;
        // Followers in a chain share their leader's vertex but do not stand on it.
        let has_it = |other: &Member| (other.queue, other.place) == (member.queue, member.place);
        let is_first = !members.iter().any(|other| has_it(other) && other.rank < member.rank);
        // Vertices of a formation that moves with the target say nothing about the map.
        let formation = self.formation.as_ref().filter(|formation| formation.header.frame_id != "target")?;
        let vertex = formation.queues.get(member.queue as usize)?.vertices.get(member.place as usize)?;
        is_first.then_some([vertex.x, vertex.y])
    }

    /// When the goal points moved: from the first departure to the last arrival, s.
    #[must_use]
    pub fn motion(&self) -> Option<(f64, f64)> {
        let moving = self.robots.values().flat_map(|track| track.goals.iter().filter(|goal| goal.is_moving()));
        moving.fold(None, |span, goal| {
            let (first, last) = span.unwrap_or((goal.time, goal.time));
            Some((first.min(goal.time), last.max(goal.time)))
        })
    }

    /// Shape error at `time`, m: the largest difference, over all pairs of robots, between their distance and that of
    /// their vertices, or of their goal points then where these go on with a target. Nothing with fewer than two robots that
    /// have both a pose and a vertex.
    #[must_use]
    pub fn shape_error(&self, time: f64) -> Option<f64> {
        let placed: Vec<_> = self
            .robots
            .iter()
            .filter_map(|(name, track)| {
                Some((track.pose_at(time)?.position(), self.vertex(name).or_else(|| track.goal_at(time))?))
            })
            .collect();
        let pairs = placed.iter().enumerate().flat_map(|(i, a)| placed.iter().skip(i + 1).map(move |b| (a, b)));
        pairs.map(|(a, b)| (distance(a.0, b.0) - distance(a.1, b.1)).abs()).reduce(f64::max)
    }

    /// The times of all poses from `first` to `last`, s, in order.
    #[must_use]
    pub fn times(&self, first: f64, last: f64) -> Vec<f64> {
        let all = self.robots.values().flat_map(|track| track.poses.iter().map(|pose| pose.time));
        let mut times: Vec<f64> = all.filter(|&time| time >= first && time <= last).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}

/// The distance of two points, m.
#[must_use]
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
