//! The end of every tick: the safety filter, with what the vision sees and others say.

use crate::hold::Hold;
use crate::inputs::vector;
use crate::tick::{Command, Tick, pose_of};
use trench_core::{RosTime, Times};
use trench_formation::Vector2;
use trench_formation::kinematics::Twist;
use trench_formation::safety::{Neighbour, Scene, Wish};
use trench_msgs::msg::{LeaderState, RobotState, TeamState};

/// Seconds without a way round after which the side of the last one is forgotten.
const FORGET: f64 = 2.0;

impl Tick {
    /// The twist after the filter; `goal` is what a way round leads to, `pace` (m/s) how fast
    /// the law would drive it.
    pub(crate) fn safe(
        &mut self,
        (at, acts): (Times, RosTime),
        state: &RobotState,
        twist: Twist,
        (goal, pace): (Option<Vector2<f64>>, f64),
        command: &mut Command,
    ) -> Result<Twist, Hold> {
        if !self.settings.safety_enabled {
            return Ok(twist);
        }
        let obstacles = self.inputs.obstacles.as_ref();
        let fresh =
            obstacles.is_some_and(|heard| at.steady.seconds_since(heard.at) <= self.settings.obstacle_age_limit);
        if self.settings.needs_mapper && !fresh {
            command.limits |= LeaderState::LIMIT_STALE;
            return Err(Hold::NoMapper);
        }
        let mut neighbours = self.neighbours(at);
        neighbours.extend(self.unnamed());
        let hulls = self.inputs.obstacles.as_ref().map(|heard| heard.message.at(acts));
        let pose = pose_of(state);
        let obstacles = hulls
            .as_ref()
            .map_or_else(Vec::new, |hulls| hulls.bodies(pose.position(), 2.0 * self.settings.body_radius));
        let scene = Scene { neighbours: &neighbours, obstacles: &obstacles, field: &self.settings.field };
        let now = Twist { v: state.v, omega: state.omega };
        // A law that goes by potentials is led round, not across: it keeps to the side that it took.
        let kept = self.detour.filter(|_| self.settings.dynamic.is_some()).map(|(side, _)| side);
        let pace = pace.min(self.faster());
        let filtered = self.settings.safety.apply(pose, now, Wish { twist, goal, kept, pace }, &scene);
        match filtered.side {
            Some(side) => self.detour = Some((side, at.steady)),
            None if self.detour.is_some_and(|(_, last)| at.steady.seconds_since(last) > FORGET) => self.detour = None,
            None => {}
        }
        if filtered.acted.is_some() {
            command.limits |= LeaderState::LIMIT_SAFETY;
        }
        Ok(filtered.twist)
    }

    /// As fast forward as the motors can be with the next command, m/s.
    fn faster(&self) -> f64 {
        let told = self.last.map_or(0.0, |(_, wheels)| self.settings.axle.twist(wheels).v);
        told.max(0.0) + self.settings.ramp.acceleration * self.inputs.interval()
    }

    /// The other robots as the vision sees them, and what they say of themselves.
    fn neighbours(&self, at: Times) -> Vec<Neighbour> {
        let Some(team) = &self.inputs.team else { return Vec::new() };
        let others = team.message.robots.iter().filter(|other| other.name != self.settings.robot);
        let neighbour = |other: &RobotState| {
            let said = self.inputs.others.said(&other.name, at.steady, self.settings.leader_state_age_limit);
            let one_mind = !self.inputs.voices.are_several(&other.name, at.steady);
            let tracked = other.status == RobotState::STATUS_TRACKED;
            let obeys = said.is_some_and(|said| said.limited_by & LeaderState::LIMIT_DEVIATES == 0);
            let arrived = said.is_some_and(|said| said.goal_distance < 2.0 * self.settings.dead_band.resume);
            let (sin, cos) = libm::sincos(other.theta);
            Neighbour {
                position: Vector2::new(other.x, other.y),
                velocity: other.v * Vector2::new(cos, sin),
                radius: self.settings.body_radius,
                cooperative: tracked && obeys && one_mind,
                settled: arrived && other.v.abs() < 0.01,
            }
        };
        others.map(neighbour).collect()
    }

    /// Pads that are no robot's yet: of a robot that was put down there, or of one that is not of the team. Nobody answers for them.
    fn unnamed(&self) -> impl Iterator<Item = Neighbour> {
        let pads = self.inputs.team.iter().flat_map(|team| &team.message.unnamed);
        pads.filter(|pad| pad.x.is_finite() && pad.y.is_finite()).take(usize::from(TeamState::MOST_UNNAMED)).map(
            |pad| Neighbour {
                position: vector(pad),
                velocity: Vector2::zeros(),
                radius: self.settings.body_radius,
                cooperative: false,
                settled: false,
            },
        )
    }
}
