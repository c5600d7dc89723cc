//! How a run went: whether a team conforms in time and touches nothing.
use super::{ChainScenario, ChainSimulation, ScenarioError};
use crate::kinematics::PointState;
use crate::laws::Capability;
use crate::seek::Room;
use crate::trench::Trench;

/// What a run is held to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standard {
    /// Radius of the robots' bodies, m.
    pub body_radius: f64,
    /// What the robots can do.
    pub capability: Capability,
    /// A robot conforms within this distance of what draws it, m.
    pub tolerance: f64,
}

/// The verdict on a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// The fragments have fewer places, rho_hat from each other, than there are robots.
    TooFewPlaces {
        /// More there are not.
        places: usize,
    },
    /// A robot of this rank starts out of reach of its leader.
    Disconnected(usize),
    /// All conform from `time` (s) on, to the end of the run. Gaps are the least seen, m.
    Conforms {
        /// s.
        time: f64,
        /// Between bodies of robots.
        robot_gap: f64,
        /// Between robots and obstacles.
        obstacle_gap: f64,
    },
    /// Not in time; the rank of the robot that is farthest off and its deviation, m.
    Late(usize, f64),
    /// Bodies met at this time, s: negative gaps, m.
    Collision {
        /// s.
        time: f64,
        /// Between bodies of robots.
        robot_gap: f64,
        /// Between robots and obstacles.
        obstacle_gap: f64,
    },
    /// A number was not finite at this time, s.
    NotFinite(f64),
}

/// Seconds allowed besides three times the way at full speed.
const PATIENCE: f64 = 20.0;
/// How long a team must have conformed at the end, s.
const SETTLED: f64 = 5.0;

/// Runs `scenario` for 3 times the longest straight way of a robot, from its start to where it ends, at full speed, and 20 s.
///
/// # Errors
/// Scenarios that cannot be run.
pub fn judge<T: Trench + Clone + Send + Sync>(
    scenario: ChainScenario<T>,
    standard: &Standard,
) -> Result<Verdict, ScenarioError> {
    let starts = scenario.robots.clone();
    let radii = *scenario.zoning.radii();
    if let Some(index) =
        starts.windows(2).position(|pair| !radii.is_coordinated((pair[0].position - pair[1].position).norm()))
    {
        return Ok(Verdict::Disconnected(index + 2));
    }
    let step = scenario.step;
    let longest = 3.0 * (scenario.segment.length() + 60.0) / standard.capability.speed + PATIENCE;
    let mut simulation = ChainSimulation::new(scenario)?;
    let room = Room::count(&simulation.scenario.segment, simulation.fragments(1), radii.rho_hat, starts.len());
    if room.most < starts.len() {
        return Ok(Verdict::TooFewPlaces { places: room.most });
    }
    let (mut robot_gap, mut obstacle_gap, mut since) = (f64::INFINITY, f64::INFINITY, None);
    while simulation.time() < longest {
        simulation.step()?;
        let time = simulation.time();
        let finite = |robot: &PointState| (robot.position + robot.velocity).iter().all(|number| number.is_finite());
        if !simulation.robots().iter().all(finite) {
            return Ok(Verdict::NotFinite(time));
        }
        robot_gap = robot_gap.min(simulation.least_distance() - 2.0 * standard.body_radius);
        obstacle_gap = obstacle_gap.min(simulation.least_obstacle_gap() - standard.body_radius);
        if robot_gap <= 0.0 || obstacle_gap <= 0.0 {
            return Ok(Verdict::Collision { time, robot_gap, obstacle_gap });
        }
        let worst = simulation.deviations().iter().copied().fold(0.0, f64::max);
        if worst > standard.tolerance {
            since = None;
        } else {
            since.get_or_insert(time);
        }
        let way = |(start, robot): (&PointState, &PointState)| (start.position - robot.position).norm();
        let longest_way = starts.iter().zip(simulation.robots()).map(way).fold(0.0, f64::max);
        let allowed = 3.0 * longest_way / standard.capability.speed + PATIENCE;
        match since {
            Some(since) if time - since >= SETTLED && since <= allowed => {
                return Ok(Verdict::Conforms { time: since, robot_gap, obstacle_gap });
            }
            _ if time > allowed + SETTLED + step => break,
            _ => {}
        }
    }
    let deviations = simulation.deviations().iter().copied().enumerate();
    let (index, deviation) = deviations.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
    Ok(Verdict::Late(index + 1, deviation))
}
