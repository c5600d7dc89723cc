//! What a robot knows at a tick, and how it goes on until the next.
use crate::Vector2;
use crate::curve::{Curve, Placed};
use crate::hull::{ApparentObstacle, Approach, Obstacle};
use crate::kinematics::PointState;
use crate::laws::{GoalMotion, RigidMotion};
use nalgebra::Isometry2;

/// Everything around a robot at a tick, frame `map`. Borrowed: nothing is copied.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    /// Time of the tick, s, from any fixed beginning.
    pub time: f64,
    /// The segment in its own frame.
    pub curve: &'a Curve,
    /// Pose of that frame.
    pub map_from_segment: Isometry2<f64>,
    /// Its motion.
    pub motion: RigidMotion,
    /// The robot's own goal point: the team goal of a chain leader, or the goal of [`Method::Goal`](super::Method::Goal).
    /// Without it the robot seeks its nearest point.
    pub goal: Option<GoalMotion>,
    /// The robot that it follows.
    pub leader: Option<Leader>,
    /// Robots to keep from besides the leader: those ahead of it in the chain, by rank, and those of other teams in range.
    pub ahead: &'a [PointState],
    /// Places that the robots ahead have chosen on the segment, the leader's last, m; for a robot that has chosen none, where it is.
    /// See [`Encroaching::ObstaclesAndPlaces`](super::Encroaching::ObstaclesAndPlaces).
    pub places: &'a [Vector2<f64>],
    /// How many robots of the chain come behind this one.
    pub behind: usize,
    /// Real obstacles.
    pub real: &'a [Obstacle],
    /// What they are combined to.
    pub apparent: &'a [ApparentObstacle],
    /// Velocities of the apparent obstacles in order, m/s; those missing rest.
    pub velocities: &'a [Vector2<f64>],
    /// No apparent obstacle is nearer to the robot than this until the next tick, m; 0 where that is not known.
    pub clear: f64,
}

/// What a robot knows of its leader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leader {
    /// Where it is and how fast.
    pub state: PointState,
    /// Its distance from what draws it, m.
    pub deviation: f64,
}

/// The segment some time after a tick.
pub(crate) struct Moment<'a> {
    /// Time since the tick, s.
    pub(super) since: f64,
    pub(super) segment: Placed<'a>,
    pub(super) motion: RigidMotion,
}

impl<'a> Surroundings<'a> {
    /// The segment `since` seconds after the tick.
    #[inline]
    pub(crate) fn moment(&self, since: f64) -> Moment<'a> {
        let (map_from_segment, motion) = self.motion.carried(self.map_from_segment, since);
        Moment { since, segment: Placed::new(self.curve, map_from_segment), motion }
    }

    /// The goal point then.
    #[inline]
    pub(super) fn goal_after(&self, since: f64) -> Option<GoalMotion> {
        self.goal.map(|goal| goal.after(since))
    }

    /// Displacement of an apparent obstacle since the tick, m.
    #[inline]
    pub(super) fn displacement(&self, index: usize, since: f64) -> Vector2<f64> {
        since * self.velocity(index)
    }

    /// How an apparent obstacle lies to a robot then.
    #[inline]
    pub(super) fn approach(&self, index: usize, since: f64, robot: Vector2<f64>) -> Approach {
        self.apparent[index].shape.outline().approach(robot - self.displacement(index, since))
    }

    /// How the nearest of the real obstacles in an apparent one lies to a robot then.
    pub(super) fn approach_of_members(&self, index: usize, since: f64, robot: Vector2<f64>) -> Option<Approach> {
        let (obstacle, robot) = (&self.apparent[index], robot - self.displacement(index, since));
        let members = self.real.iter().filter(|real| obstacle.members.contains(&real.id));
        members.map(|real| real.shape.outline().approach(robot)).min_by(|a, b| a.gap.total_cmp(&b.gap))
    }

    /// Whether an apparent obstacle may be within `reach` (m) of a robot then: others are not.
    #[inline]
    pub(super) fn is_near(&self, index: usize, since: f64, robot: Vector2<f64>, reach: f64) -> bool {
        !self.apparent[index].shape.is_beyond(robot - self.displacement(index, since), reach)
    }

    /// Whether two real obstacles are kept apart though their hulls are nearer than the clearance: pieces of one long wall (9.2).
    pub(super) fn parted(&self, a: u32, b: u32, clearance: f64) -> bool {
        let hull = |id: u32| self.apparent.iter().find(|obstacle| obstacle.members.contains(&id));
        let (Some(a), Some(b)) = (hull(a), hull(b)) else { return false };
        a.id != b.id && a.shape.outline().is_nearer_than(&b.shape.outline(), clearance)
    }

    /// Velocity of an apparent obstacle, m/s.
    #[inline]
    pub(super) fn velocity(&self, index: usize) -> Vector2<f64> {
        self.velocities.get(index).copied().unwrap_or_else(Vector2::zeros)
    }
}
