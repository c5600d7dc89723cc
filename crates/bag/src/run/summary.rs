//! How well a run went, in numbers: what the tests of whole runs judge by.

use super::{ContactSample, Run, distance};
use serde::Serialize;
use std::fmt::{self, Display};

/// So many contacts are told one by one.
const MOST_CONTACTS: usize = 20;

/// What to compute.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryOptions {
    /// When to give the shape error, s.
    pub shape_times: Vec<f64>,
    /// Over which interval to give its maximum, s; by default the last third of the goals' motion and all that follows.
    pub interval: Option<(f64, f64)>,
    /// Diameter of a robot's body, m.
    pub body_diameter: f64,
}

impl Default for SummaryOptions {
    fn default() -> Self {
        Self { shape_times: vec![0.0, 8.0, 16.0, 24.0, 60.0], interval: None, body_diameter: 0.16 }
    }
}

/// A run in numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunSummary {
    /// The beginning of the run, ns of ROS time, where it is known.
    pub t0: Option<i64>,
    /// Whether it is judged by ground truth; else by what the localizer saw.
    pub ground_truth: bool,
    /// From the beginning to the last pose, s.
    pub duration: f64,
    /// From the first departure of a goal point to the last arrival, s.
    pub motion: Option<(f64, f64)>,
    /// By name.
    pub robots: Vec<RobotSummary>,
    /// At the times asked for that the run reached.
    pub shape: Vec<ShapeSample>,
    /// At the last pose, m.
    pub final_shape_error: Option<f64>,
    /// The interval over which the maximum is taken, s.
    pub interval: (f64, f64),
    /// The largest shape error over the interval, m.
    pub max_shape_error: Option<f64>,
    /// The nearest that two bodies came to each other after the beginning.
    pub closest: Option<Closest>,
    /// Who touched whom, by ground truth.
    pub contacts: Vec<ContactSample>,
    /// Messages that could not be read.
    pub undecodable: u64,
}

/// One robot in numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobotSummary {
    /// Its name.
    pub name: String,
    /// Where it should be in the end, m.
    pub vertex: Option<[f64; 2]>,
    /// Where it is in the end: m, m, rad.
    pub final_pose: Option<[f64; 3]>,
    /// Its distance to the vertex in the end, m.
    pub final_distance: Option<f64>,
    /// The largest forward speed, m/s.
    pub max_speed: f64,
}

/// A shape error and when it was.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShapeSample {
    /// s.
    pub time: f64,
    /// m.
    pub error: f64,
}

/// How near two robots came to each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Closest {
    /// Their names.
    pub robots: [String; 2],
    /// s.
    pub time: f64,
    /// Between the bodies' edges, m; negative where they overlap.
    pub gap: f64,
}

/// Judges a run.
#[must_use]
pub fn summary(run: &Run, options: &SummaryOptions) -> RunSummary {
    let end = run.span().map_or(0.0, |(_, last)| last);
    let motion = run.motion();
    let settled_from = motion.map_or(0.0, |(first, last)| first + (last - first) * 2.0 / 3.0);
    let interval = options.interval.unwrap_or((settled_from, end));
    let shape_at = |time: f64| run.shape_error(time).map(|error| ShapeSample { time, error });
    RunSummary {
        t0: run.t0,
        ground_truth: run.is_ground_truth,
        duration: end,
        motion,
        robots: run.robots.keys().map(|name| robot(run, name)).collect(),
        shape: options.shape_times.iter().filter(|&&time| time <= end).filter_map(|&time| shape_at(time)).collect(),
        final_shape_error: run.shape_error(end),
        interval,
        max_shape_error: run
            .times(interval.0, interval.1)
            .into_iter()
            .filter_map(|t| run.shape_error(t))
            .reduce(f64::max),
        closest: closest(run, end, options.body_diameter),
        contacts: run.contacts.clone(),
        undecodable: run.undecodable,
    }
}

fn robot(run: &Run, name: &str) -> RobotSummary {
    let track = run.robots.get(name);
    let last = track.and_then(|track| track.poses.last());
    let vertex = run.vertex(name);
    RobotSummary {
        name: name.to_owned(),
        vertex,
        final_pose: last.map(|pose| [pose.x, pose.y, pose.theta]),
        final_distance: last.zip(vertex).map(|(pose, vertex)| distance(pose.position(), vertex)),
        max_speed: track.map_or(0.0, |track| track.poses.iter().map(|pose| pose.v.abs()).fold(0.0, f64::max)),
    }
}

fn closest(run: &Run, end: f64, body_diameter: f64) -> Option<Closest> {
    let names: Vec<&String> = run.robots.keys().collect();
    let mut best: Option<Closest> = None;
    for time in run.times(0.0, end) {
        let positions: Vec<_> =
            run.robots.values().map(|track| track.pose_at(time).map(|pose| pose.position())).collect();
        for (i, (&name, a)) in names.iter().zip(&positions).enumerate() {
            for (&other, b) in names.iter().zip(&positions).skip(i + 1) {
                let Some(gap) = a.zip(*b).map(|(a, b)| distance(a, b) - body_diameter) else { continue };
                if best.as_ref().is_none_or(|best| gap < best.gap) {
                    best = Some(Closest { robots: [name.clone(), other.clone()], time, gap });
                }
            }
        }
    }
    best
}

impl Display for RunSummary {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let metres = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4}"));
        let source = if self.ground_truth { "ground truth" } else { "the localizer's poses" };
        writeln!(out, "Run of {:.2} s, judged by {source}", self.duration)?;
        if let Some((first, last)) = self.motion {
            writeln!(out, "Goal points moved from t = {first:.2} s to {last:.2} s")?;
        }
        writeln!(
            out,
            "\n{:<12} {:>17} {:>17} {:>12} {:>12}",
            "robot", "vertex (m)", "final (m)", "distance (m)", "v max (m/s)"
        )?;
        for robot in &self.robots {
            let point = |point: Option<[f64; 2]>| point.map_or("-".to_owned(), |[x, y]| format!("({x:.3}, {y:.3})"));
            let last = robot.final_pose.map(|[x, y, _]| [x, y]);
            let (vertex, last, far) = (point(robot.vertex), point(last), metres(robot.final_distance));
            writeln!(out, "{:<12} {vertex:>17} {last:>17} {far:>12} {:>12.3}", robot.name, robot.max_speed)?;
        }
        writeln!(out)?;
        for sample in &self.shape {
            writeln!(out, "shape error at t = {:<6.1} {:>9.4} m", sample.time, sample.error)?;
        }
        writeln!(out, "shape error at the end  {:>9} m", metres(self.final_shape_error))?;
        let (first, last) = self.interval;
        writeln!(
            out,
            "largest shape error     {:>9} m  (t = {first:.1} to {last:.1} s)",
            metres(self.max_shape_error)
        )?;
        if let Some(Closest { robots: [a, b], time, gap }) = &self.closest {
            writeln!(out, "smallest body distance  {gap:>9.4} m  ({a} and {b}, t = {time:.2} s)")?;
        }
        if self.ground_truth {
            writeln!(out, "contacts                {:>9}", self.contacts.len())?;
        }
        for contact in self.contacts.iter().take(MOST_CONTACTS) {
            writeln!(out, "  {contact}")?;
        }
        if self.contacts.len() > MOST_CONTACTS {
            writeln!(out, "  and {} more", self.contacts.len() - MOST_CONTACTS)?;
        }
        if self.undecodable > 0 {
            writeln!(out, "{} messages could not be read", self.undecodable)?;
        }
        Ok(())
    }
}
