//! One step of a chain's robots, each by itself or several side by side.
use super::ChainScenario;
use super::Outcome;
use super::links::{Links, towards_goal};
use super::vicinity::Vicinity;
use crate::Vector2;
use crate::agent::{Abreast, Agent, AgentSettings, Leader, Moment, Side, Surroundings};
use crate::curve::Placed;
use crate::hull::{ApparentObstacle, Obstacle};
use crate::kinematics::PointState;
use crate::lanes::{LANES, Lanes, Work, in_widest};
use crate::laws::RigidMotion;
use crate::trench::Trench;
use nalgebra::Isometry2;

/// How many robots ahead of those that act the segment is called for: pieces lie far apart in memory.
const AHEAD: usize = 8;

/// What all robots share until the next tick.
pub(super) struct View<'a, T> {
    pub(super) scenario: &'a ChainScenario<T>,
    /// Time of the tick, s.
    pub(super) time: f64,
    /// The segment's frame then.
    pub(super) frame: (Isometry2<f64>, RigidMotion),
    pub(super) real: &'a [Obstacle],
    pub(super) apparent: &'a [ApparentObstacle],
    pub(super) velocities: &'a [Vector2<f64>],
    pub(super) seen: &'a [PointState],
    pub(super) seen_deviations: &'a [f64],
    pub(super) seen_places: &'a [Vector2<f64>],
    pub(super) vicinity: &'a Vicinity,
    pub(super) links: &'a Links,
}

/// Robots that act one after the other, from the one of index `first` on, and what comes of it.
pub(super) struct Part<'a, T> {
    pub(super) first: usize,
    pub(super) agents: &'a mut [Agent<T>],
    pub(super) robots: &'a mut [PointState],
    pub(super) outcomes: &'a mut [Outcome],
    pub(super) deviations: &'a mut [f64],
    pub(super) places: &'a mut [Vector2<f64>],
}

/// [`View::act`], in lanes of any kind.
struct Step<'a, 'p, T> {
    view: &'a View<'a, T>,
    since: f64,
    part: Part<'p, T>,
}

impl<T: Trench> Work for Step<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn in_lanes<L: Lanes>(self) {
        self.view.act_in::<L>(self.since, self.part);
    }
}

impl<T: Trench> View<'_, T> {
    /// One step of some robots.
    pub(super) fn act(&self, since: f64, part: Part<'_, T>) {
        in_widest(Step { view: self, since, part });
    }

    /// The same in lanes of a kind.
    #[inline(always)]
    fn act_in<L: Lanes>(&self, since: f64, part: Part<'_, T>) {
        let (step, integration) = (self.scenario.step, self.scenario.options.integration);
        let mut around = self.around(part.first);
        let moment = around.moment(since);
        let Some(settings) = part.agents.first().map(Agent::shared) else { return };
        let tells = self.scenario.encroaching.tells_places();
        let robots = part.robots.chunks_mut(LANES);
        let outcomes = part.outcomes.chunks_mut(LANES).zip(part.deviations.chunks_mut(LANES));
        let mut later = part.agents;
        for (first, (robots, (outcomes, deviations))) in (part.first..).step_by(LANES).zip(robots.zip(outcomes)) {
            let (agents, rest) = later.split_at_mut(robots.len());
            later = rest;
            for agent in later.iter().skip(AHEAD).step_by(2).take(2) {
                agent.call_for(&self.scenario.segment);
            }
            let abreast = self.abreast::<L>(&settings, &moment, first, agents, robots);
            let several = agents.iter_mut().zip(robots).zip(outcomes.iter_mut().zip(deviations));
            for (lane, ((agent, robot), (outcome, deviation))) in several.enumerate() {
                if let Some(abreast) = abreast.as_ref().filter(|abreast| abreast.tells(lane)) {
                    let (acceleration, cut) = abreast.applied(lane);
                    let (foot, distance) = abreast.drawn(lane);
                    let (steered, drawn) = (abreast.steered(lane), Some(foot));
                    *robot = integration.held(*robot, acceleration, step);
                    *outcome = Outcome { steered, power: abreast.power(lane), acceleration, cut, attraction: drawn };
                    *deviation = distance;
                    continue;
                }
                let index = first + lane;
                self.stand_at(&mut around, index);
                let action = agent.act_at(&around, &moment, *robot, step);
                let wanted = action.acceleration;
                let acceleration = self.vicinity.admit(self.scenario, self.real, (index, *robot), wanted, since);
                *robot = integration.held(*robot, acceleration, step);
                let (steered, power, cut) = (action.steered, action.powers.sum(), action.cut);
                *outcome = Outcome { steered, power, acceleration, cut, attraction: action.attraction };
                if tells {
                    part.places[index - part.first] = action.place.unwrap_or(robot.position);
                }
                // Infinite where nothing of the segment is left for the robot: it does not conform.
                *deviation = action.deviation;
            }
        }
    }

    /// What robots side by side do, from the one of index `first` on, if that can be told of them together.
    #[inline(always)]
    fn abreast<L: Lanes>(
        &self,
        settings: &AgentSettings<T>,
        moment: &Moment<'_>,
        first: usize,
        agents: &mut [Agent<T>],
        robots: &[PointState],
    ) -> Option<Abreast<L>> {
        let (agents, robots) = (agents.try_into().ok()?, robots.try_into().ok()?);
        let leader = |lane: usize| (first + lane).saturating_sub(1);
        let side = Side {
            time: self.time,
            moment,
            leaders: core::array::from_fn(|lane| self.seen[leader(lane)]),
            deviations: core::array::from_fn(|lane| self.seen_deviations[leader(lane)]),
            alone: core::array::from_fn(|lane| {
                first + lane > 0 && self.vicinity.is_alone(first + lane) && self.links.hears(first + lane)
            }),
        };
        Agent::act_abreast(settings, agents, robots, &side, self.scenario.step)
    }

    /// The surroundings of a robot at the tick.
    pub(super) fn around(&self, index: usize) -> Surroundings<'_> {
        let (map_from_segment, motion) = self.frame;
        let mut around = Surroundings {
            time: self.time,
            curve: &self.scenario.segment,
            map_from_segment,
            motion,
            goal: None,
            leader: None,
            ahead: &[],
            places: &[],
            behind: 0,
            real: self.real,
            apparent: self.apparent,
            velocities: self.velocities,
            clear: 0.0,
        };
        self.stand_at(&mut around, index);
        around
    }

    /// Makes the surroundings of one robot those of another.
    #[inline(always)]
    pub(super) fn stand_at<'a>(&'a self, around: &mut Surroundings<'a>, index: usize) {
        let goal = self.scenario.team_goal.filter(|_| index == 0);
        around.goal = goal.map(|goal| around.motion.at(around.map_from_segment.transform_point(&goal.into()).coords));
        let hears = self.links.hears(index);
        around.ahead = self.vicinity.ahead(self.seen, index, hears);
        if let Some((speed, goal)) = self.scenario.options.recovery.zip(self.scenario.team_goal).filter(|_| !hears) {
            let segment = Placed::new(&self.scenario.segment, around.map_from_segment);
            let others = (around.ahead, self.scenario.zoning.radii().rho_hat);
            let obstacles = (self.apparent, self.scenario.potential.cut());
            let robot = self.seen[index].position;
            around.goal = Some(towards_goal(&segment, &around.motion, robot, (goal, speed), others, obstacles));
        }
        around.leader = index
            .checked_sub(1)
            .filter(|_| hears)
            .map(|leader| Leader { state: self.seen[leader], deviation: self.seen_deviations[leader] });
        around.clear = self.vicinity.clear(index);
        around.places = &self.seen_places[..index];
        around.behind = self.seen.len() - index - 1;
    }
}

#[cfg(test)]
#[cfg(target_arch = "x86_64")]
mod tests;
