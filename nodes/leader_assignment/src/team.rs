//! What is known of the robots and of the links between them during a run: who is gone, who does not hear whom.

use crate::watch::{Patience, Watch};
use std::collections::BTreeMap;
use trench_core::{Steady, Times};
use trench_msgs::msg::{LeaderState, LinkStatus, RobotState, TeamState};

/// A controller or a radio that says nothing for this long is silent, s.
const SILENCE: f64 = 0.5;

/// Limits of links and robots, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TeamLimits {
    /// A robot that was lost, silent or out of reach for so long has quit.
    pub(crate) robot: f64,
    /// A follower that has not heard its leader for so long follows its goal.
    pub(crate) link: f64,
    /// A robot that has quit must be there for so long.
    pub(crate) robot_dwell: f64,
    /// A link that was broken must be good for so long.
    pub(crate) link_dwell: f64,
}

/// What one robot's controller, its radio and the localizer say of it.
#[derive(Debug, Clone, Default)]
struct Known {
    /// When its controller spoke, and whom it heard; none before it has spoken.
    controller: Option<(Steady, Vec<String>)>,
    radio_is_down: bool,
    seen: Option<Steady>,
    presence: Watch,
    /// To the robot ahead of it.
    link: Watch,
    ahead: String,
}

/// All robots.
#[derive(Debug, Clone, Default)]
pub(crate) struct Team {
    robots: BTreeMap<String, Known>,
    /// When the localizer looked last: while it does not look, nobody is missing.
    looked: Option<Steady>,
}

impl Team {
    /// The localizer has looked.
    pub(crate) fn seen(&mut self, at: Times, team: &TeamState) {
        self.looked = Some(at.steady);
        for robot in team.robots.iter().filter(|robot| robot.status != RobotState::STATUS_LOST) {
            self.robots.entry(robot.name.clone()).or_default().seen = Some(at.steady);
        }
    }

    /// A robot's controller has spoken.
    pub(crate) fn controller(&mut self, at: Times, robot: &str, state: LeaderState) {
        self.robots.entry(robot.to_owned()).or_default().controller = Some((at.steady, state.hears));
    }

    /// The bridge tells of a robot's radio.
    pub(crate) fn radio(&mut self, robot: &str, link: &LinkStatus) {
        self.robots.entry(robot.to_owned()).or_default().radio_is_down = !link.up;
    }

    /// Brings up to date who of `robots` has quit; gives whether that changed.
    pub(crate) fn judge_presence(&mut self, now: Steady, robots: &[String], limits: TeamLimits) -> bool {
        let patience = Patience { bad: limits.robot, dwell: limits.robot_dwell };
        let mut changed = false;
        for robot in robots {
            let known = self.robots.entry(robot.clone()).or_default();
            let good = known.complaint(now, self.looked).is_none();
            changed |= known.presence.update(now, good, patience);
        }
        changed
    }

    /// Brings up to date whether `robot` hears the robot `ahead` of it; gives whether that changed.
    pub(crate) fn judge_link(&mut self, now: Steady, robot: &str, ahead: &str, limits: TeamLimits) -> bool {
        let known = self.robots.entry(robot.to_owned()).or_default();
        if known.ahead != ahead {
            ahead.clone_into(&mut known.ahead);
            known.link = Watch::default();
        }
        let spoken = known.controller.as_ref().filter(|(at, _)| now.seconds_since(*at) <= SILENCE);
        // Of a robot that says nothing nobody knows whom it hears.
        let Some((_, hears)) = spoken else { return false };
        let good = hears.iter().any(|name| name == ahead);
        known.link.update(now, good, Patience { bad: limits.link, dwell: limits.link_dwell })
    }

    /// Whether it has quit.
    pub(crate) fn is_gone(&self, robot: &str) -> bool {
        self.robots.get(robot).is_some_and(|known| known.presence.is_lost())
    }

    /// Whether nothing is wrong with it now: it takes part, or waits to join.
    pub(crate) fn is_here(&self, now: Steady, robot: &str) -> bool {
        self.robots.get(robot).is_none_or(|known| known.complaint(now, self.looked).is_none())
    }

    /// Whether its link to the robot ahead is broken.
    pub(crate) fn is_cut_off(&self, robot: &str) -> bool {
        self.robots.get(robot).is_some_and(|known| known.link.is_lost())
    }

    /// What is wrong with a robot now, in words.
    pub(crate) fn complaint(&self, now: Steady, robot: &str) -> &'static str {
        self.robots.get(robot).and_then(|known| known.complaint(now, self.looked)).unwrap_or("it waits to join")
    }

    /// Everything is taken for good until it shows otherwise: a run begins.
    pub(crate) fn begin(&mut self) {
        for known in self.robots.values_mut() {
            (known.presence, known.link) = (Watch::default(), Watch::default());
        }
    }
}

impl Known {
    fn complaint(&self, now: Steady, looked: Option<Steady>) -> Option<&'static str> {
        let looked = looked.unwrap_or(now);
        if self.seen.is_none_or(|seen| looked.seconds_since(seen) > SILENCE) {
            return Some("the localizer does not see it");
        }
        if self.controller.as_ref().is_some_and(|(at, _)| now.seconds_since(*at) > SILENCE) {
            return Some("its controller is silent");
        }
        self.radio_is_down.then_some("its radio is not heard")
    }
}
