//! How a run went, for people and for programs.

use serde::Serialize;
use std::fmt::{self, Display};

/// A run, judged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Of the scenario.
    pub name: String,
    /// Of the thesis.
    pub section: String,
    /// s.
    pub duration: f64,
    /// s.
    pub step: f64,
    /// Where it ended, because a robot was out of all bounds; none where it did not.
    pub diverged: Option<DivergedSummary>,
    /// One a case.
    pub cases: Vec<CaseSummary>,
}

/// A run that diverged: what is told besides is of this moment, and says nothing about the laws.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DivergedSummary {
    /// s.
    pub time: f64,
    /// The first robot that was out of bounds, by its name.
    pub robot: String,
    /// How far from the origin it was, m.
    pub distance: f64,
    /// A thousand times as far out as anything that the file speaks of, m.
    pub limit: f64,
    /// For people.
    pub remedy: &'static str,
}

impl Summary {
    /// The first robot of all that went through an obstacle, or into one: then nothing else that is told means what it says.
    #[must_use]
    pub fn first_collision(&self) -> Option<&CollisionSummary> {
        let collisions = self.cases.iter().flat_map(|case| &case.collisions);
        collisions.min_by(|a, b| a.time.total_cmp(&b.time))
    }
}

/// A team.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseSummary {
    /// What legends call it.
    pub label: String,
    /// s after which every robot conforms for good; none if one does not.
    pub conforms_after: Option<f64>,
    /// Least distance of any two robots, m.
    pub closest_pair: Option<f64>,
    /// Least gap between a robot's way and each obstacle's own outline, m.
    pub obstacles: Vec<ObstacleSummary>,
    /// Who went through or into which obstacle, in time.
    pub collisions: Vec<CollisionSummary>,
    /// s after which every leader is for good in its follower's neutral zone; none where it is not.
    pub neutral_after: Option<f64>,
    /// Who is not in its follower's neutral zone at the end, and why: nobody where `neutral_after` says something, or where there are no zones.
    pub outside_neutral: Vec<OutsideSummary>,
    /// Seconds that robots spent in zone 1 of a robot, summed over pairs; none where there are no zones.
    pub in_zone_1: Option<f64>,
    /// What befell a queue, in time: robots that quit and join, links that break.
    pub changes: Vec<ChangeSummary>,
    /// By rank.
    pub robots: Vec<RobotSummary>,
}

/// A follower whose leader is not in its neutral zone at the end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutsideSummary {
    /// The follower.
    pub robot: String,
    /// The robot that it follows.
    pub leader: String,
    /// In which zone of Fig. 6.1 that is; 6 is beyond all of them.
    pub zone: u8,
    /// Between them, m.
    pub distance: f64,
    /// For people.
    pub why: String,
}

/// A change of a queue's structure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChangeSummary {
    /// s.
    pub time: f64,
    /// Whom it befell.
    pub robot: String,
    /// What: `joins`, `quits`, `lost`, `retargets` or `follows`.
    pub change: &'static str,
    /// The rank at which it joins, from 1 on.
    pub rank: Option<usize>,
}

/// An obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObstacleSummary {
    /// Its id.
    pub id: u32,
    /// m; negative: so deep inside it a robot was, 0: its way crossed it and ended outside.
    pub least_gap: f64,
}

/// A robot that an obstacle did not stop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CollisionSummary {
    /// When the two met first: the end of the step on whose way it was, s.
    pub time: f64,
    /// Which.
    pub robot: String,
    /// The obstacle's id.
    pub obstacle: u32,
    /// `through` it, out on another side within that step, or `into` it.
    pub way: &'static str,
    /// How often it did so until the end.
    pub times: usize,
}

/// For people: `r2 went through obstacle 3 at 30.843 s`.
impl Display for CollisionSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, robot, obstacle, way, times } = self;
        write!(formatter, "{robot} went {way} obstacle {obstacle} at {time:.3} s")?;
        if *times > 1 { write!(formatter, ", and {} times more", times - 1) } else { Ok(()) }
    }
}

/// A robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobotSummary {
    /// Its name.
    pub name: String,
    /// m, at the end.
    pub position: [f64; 2],
    /// Distance from what draws it at the end, m.
    pub error: f64,
    /// s after which it stays within the tolerance.
    pub conforms_after: Option<f64>,
    /// s since when no qualified fragment has been left that would draw it (7.5.1), to the end; none where one is.
    pub no_fragment_since: Option<f64>,
    /// m, at the end.
    pub leader_distance: Option<f64>,
    /// Least and greatest, m.
    pub leader_distance_range: Option<[f64; 2]>,
    /// phi at the end, rad (chapter 4).
    pub misalignment: Option<f64>,
    /// Where phi comes to rest under (3.13), rad.
    pub resting_misalignment: Option<f64>,
    /// Integral of v^2 + omega^2 (Table 4.1).
    pub effort: Option<f64>,
    /// Jumps of its nearest point on the whole segment (Definition 7.2.1), where that is bent.
    pub transits: Option<Transits>,
    /// What its motors were asked for, where it is driven by wheel torques (3.1).
    pub wheels: Option<WheelSummary>,
    /// The law's Lyapunov function (A.10, A.12, A.18, chapter 4) along the run, where it was asked.
    pub lyapunov: Option<LyapunovSummary>,
}

/// Transits along a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Transits {
    /// How many.
    pub count: usize,
    /// The first hundred of them.
    pub first: Vec<TransitSummary>,
}

/// A transit: the nearest point jumps from one transit point to another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TransitSummary {
    /// s: when it was seen, on whose last `tolerance` of its way it was.
    pub time: f64,
    /// Where the robot was, m.
    pub place: [f64; 2],
    /// Arc length of the transit point before, m.
    pub from: f64,
    /// And behind.
    pub to: f64,
}

/// Motors of the wheels along a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WheelSummary {
    /// The largest torque that was asked for, N m.
    pub greatest_torque: f64,
    /// How long it was more than the motors have, s.
    pub saturated: f64,
}

/// A Lyapunov function along a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LyapunovSummary {
    /// Its greatest value.
    pub greatest: f64,
    /// Its value at the end.
    pub last: f64,
    /// The greatest rate at which it changed from one step to the next, in units of V a second, less the power that leader, robots ahead
    /// and obstacles brought in: V' of the argument, measured. None where no two steps had the
    /// same V.
    pub greatest_rate: Option<f64>,
    /// By how much it rose at most over any stretch of time, less what they brought in: nothing but for errors of the integration where the
    /// argument holds.
    pub greatest_rise: f64,
    /// The greatest rate that the law's own formula gave it, such as -k |r'|^2, whatever the robot did then.
    pub greatest_rate_of_law: f64,
}
