//! Who takes part, who goes where, and telling of it.

use crate::Carrier;
use crate::checkpoint::{self, Checkpoint, FRESH};
use crate::core::{ASSIGNMENT, FORMATION, LeaderAssignment, RUN_STATE};
use crate::held::Held;
use crate::members;
use crate::organise::{Seated, organise};
use trench_core::{Condition, Level, RosTime, Sink, Times};
use trench_formation::Vector2;
use trench_msgs::msg::{Assignment, RobotState, RunState};
use trench_msgs::std_msgs::Header;
use trench_plan::{Frame, plan_from_message};

/// The number of an assignment that replaces `old`.
pub(crate) fn epoch_after(old: Option<&Assignment>) -> u64 {
    old.map_or(0, |old| old.epoch) + 1
}

impl LeaderAssignment {
    /// Takes up the run of an earlier life of the process, one that died just now, and says what is in force.
    pub(crate) fn started(&mut self, at: Times, sink: &mut dyn Sink) {
        if self.resume(at).is_some() {
            sink.log(Level::Info, "going on with the run that was interrupted");
        }
        sink.publish(FORMATION, &self.held.stamped(at.ros));
        if let Some(assignment) = &self.assignment {
            sink.publish(ASSIGNMENT, assignment);
        }
        self.announce(at, sink);
    }

    fn resume(&mut self, at: Times) -> Option<()> {
        let Checkpoint { written, run, assignment, formation, robots, configured, since, scale } =
            self.checkpoint.take()?;
        let assignment = assignment?;
        let fresh = (0.0..=FRESH).contains(&at.ros.seconds_since(written));
        let known = robots.iter().all(|robot| self.settings.robots.contains(robot));
        let ours = configured == self.configured && assignment.formation_hash == formation.hash;
        if !(fresh && known && ours) {
            return None;
        }
        if formation.hash != self.held.message.hash || robots != self.held.robots {
            // Another one was asked for during the run. Those of the library have motion besides what a message tells.
            let known = self.settings.library.iter().filter(|plan| plan.name == formation.name);
            let mut sized = known.filter_map(|plan| Held::at_scale(plan, scale, robots.clone()).ok());
            let held = sized.find(|held| held.message.hash == formation.hash);
            let told = || plan_from_message(&formation).ok().map(|plan| Held::new(plan, robots.clone()));
            self.held = held.or_else(told)?;
        }
        self.held.since = since;
        self.seats = Seated::of_assignment(&self.held.plan, &assignment);
        // Links that were broken are watched anew.
        self.seats = members::without(&self.held.plan, &self.seats, |_| false);
        (self.run, self.assignment) = (run, Some(assignment));
        Some(())
    }

    /// What speaks against moving.
    pub(crate) fn ready(&self) -> Result<(), String> {
        if self.team.is_none() {
            return Err("no /team_state was heard: is the localizer running?".to_owned());
        }
        let missing = self.unlocalised(&self.held.robots);
        if missing.is_empty() { Ok(()) } else { Err(format!("not localised: {}", missing.join(", "))) }
    }

    pub(crate) fn unlocalised<'a>(&self, robots: &'a [String]) -> Vec<&'a str> {
        let tracked = |name: &&String| {
            self.team
                .iter()
                .flat_map(|team| &team.robots)
                .any(|robot| robot.name == **name && robot.status == RobotState::STATUS_TRACKED)
        };
        robots.iter().filter(|name| !tracked(name)).map(String::as_str).collect()
    }

    /// Where the robots of a formation are, in its frame; none while nobody knows where that is.
    pub(crate) fn positions(&self, held: &Held, at: Times) -> Option<Vec<(String, Vector2<f64>)>> {
        let team = self.team.as_ref()?;
        let carrier = match held.plan.frame {
            Frame::Map => Carrier::MAP,
            Frame::Target => self.target.at(at.steady, RosTime::from(&team.header.stamp))?,
        };
        let seen = team.robots.iter().filter(|robot| held.robots.contains(&robot.name));
        Some(seen.map(|robot| (robot.name.clone(), carrier.from_map(Vector2::new(robot.x, robot.y)))).collect())
    }

    pub(crate) fn assign(&mut self, at: Times, sink: &mut dyn Sink) {
        let Some(mut robots) = self.positions(&self.held, at) else { return };
        robots.retain(|(robot, _)| !self.members.is_gone(robot));
        match organise(&self.held.plan, &robots, &self.seats, self.settings.seating) {
            Ok(seats) => self.seats = seats,
            Err(error) => {
                self.health.set("assignment", Condition::Error, error.to_string());
                sink.log(Level::Error, &format!("the assignment stays as it is: {error}"));
                return;
            }
        }
        self.health.set("assignment", Condition::Ok, format!("{} robots have places", self.seats.len()));
        self.announce_seats(at, sink);
    }

    pub(crate) fn keep(&self, at: Times, sink: &mut dyn Sink) {
        let kept = checkpoint::write(at.ros, &self.run, self.assignment.as_ref(), &self.held, self.configured);
        sink.checkpoint(&kept);
    }

    pub(crate) fn announce(&mut self, at: Times, sink: &mut dyn Sink) {
        self.keep(at, sink);
        let text = format!("{}: {}", crate::state_name(self.run.state()), self.run.reason());
        self.health.set("run", Condition::Ok, text);
        sink.publish(
            RUN_STATE,
            &RunState {
                header: Header { stamp: at.ros.into(), frame_id: String::new() },
                state: self.run.state(),
                epoch: self.assignment.as_ref().map_or(0, |assignment| assignment.epoch),
                t0: self.run.t0().map(Into::into).unwrap_or_default(),
                reason: self.run.reason().to_owned(),
            },
        );
    }
}
