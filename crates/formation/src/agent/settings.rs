//! What a person may choose about a robot's controller.
use crate::Vector2;
use crate::avoidance::WatchSettings;
use crate::laws::{Capability, NearestAttraction};
use crate::seek::SeekSettings;
use crate::trench::HyperbolicDamping;
use crate::zoning::{ObstaclePotential, Zoning};

/// A robot's law and everything that belongs to it.
#[derive(Debug, Clone, PartialEq)]
pub struct AgentSettings<T> {
    /// Trench and damping; (7.4) and (7.13) themselves.
    pub law: NearestAttraction<T>,
    /// Which of the laws.
    pub method: Method,
    /// Psi to the leader, Psi_hat to all robots ahead.
    pub zoning: Zoning,
    /// Psi_hat^ob.
    pub potential: ObstaclePotential,
    /// rho_clearance of (7.8), m: only for robots that encroach on the segment.
    pub clearance: f64,
    /// How the nearest point is sought.
    pub seeking: SeekSettings,
    /// What encroaches on the segment.
    pub encroaching: Encroaching,
    /// The way out of local minima; without it the robot stays.
    pub remedies: Option<Remedies>,
    /// Bounds of speed and acceleration relative to the segment (9.2), applied after the law.
    pub limits: Option<Capability>,
    /// Whether a push straight against the attraction is turned a little to the robot's right: exactly head-on it would stay.
    pub sidesteps: bool,
}

/// Which law steers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// (5.1) and (5.3) with the constant damping of the law, (5.2) with a damping of its own: to the goal point. Nobody leads.
    Goal(Option<HyperbolicDamping>),
    /// (6.1): to the point of attraction in a direction of the segment's frame, or across the segment. delta if `compensates`.
    Directed {
        /// Unit vector, frame of the segment; across the segment without it.
        direction: Option<Vector2<f64>>,
        /// See [`ZonedAttraction`](crate::laws::ZonedAttraction).
        compensates: bool,
    },
    /// (7.3), (7.4), (7.13): to the nearest point.
    Nearest,
}

/// What encroaches on the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Encroaching {
    /// Nothing: nearest points on the whole segment.
    Nothing,
    /// Apparent obstacles, up to the cut of their potential.
    Obstacles,
    /// Robots ahead too (step (1) of 7.5.2), as obstacles of this radius (m), sought anew at every tick: those that have come to the
    /// segment, whose repulsive area reaches it. With rho_hat less the obstacles' cut no place is left in anybody's zone 2.
    ObstaclesAndRobots(f64),
    /// The same, but a robot ahead joins only what of obstacles is near to it: it rests in a corridor without closing all of it, see
    /// [`apparent_obstacles_apart`](crate::seek::apparent_obstacles_apart) (9.2).
    ObstaclesAndRobotsApart(f64),
    /// The places that robots ahead have chosen, from the moment at which they choose them, as obstacles of this radius (m); and a robot
    /// chooses its own within its leader's neutral zone, as it will be once the leader stands at its place. Beyond the thesis, where
    /// robots learn only from those that have arrived where they cannot stay.
    ObstaclesAndPlaces(f64),
}

impl Encroaching {
    /// How robots ahead encroach; none where they do not.
    pub(super) fn robots_ahead(self) -> Option<RobotsAhead> {
        let (radius, places, apart) = match self {
            Self::Nothing | Self::Obstacles => return None,
            Self::ObstaclesAndRobots(radius) => (radius, false, false),
            Self::ObstaclesAndRobotsApart(radius) => (radius, false, true),
            Self::ObstaclesAndPlaces(radius) => (radius, true, false),
        };
        Some(RobotsAhead { radius, places, apart })
    }

    /// The radius that robots ahead encroach with, m; none where they do not.
    pub fn robot_radius(self) -> Option<f64> {
        self.robots_ahead().map(|ahead| ahead.radius)
    }

    /// Whether robots tell those behind them which places they have chosen.
    pub fn tells_places(self) -> bool {
        self.robots_ahead().is_some_and(|ahead| ahead.places)
    }
}

/// How robots ahead encroach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RobotsAhead {
    /// m.
    pub(super) radius: f64,
    /// By the places that they have chosen, not by where they are once they have come to the segment.
    pub(super) places: bool,
    /// Joining only what of obstacles is near to them.
    pub(super) apart: bool,
}

/// Watching for local minima and raising guards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remedies {
    /// When a robot counts as caught.
    pub watch: WatchSettings,
    /// How fast a guard rises to its place, and how fast robots are led out of hulls, m/s.
    pub rising: f64,
}
