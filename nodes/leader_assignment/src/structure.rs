//! Structure changes during a run (8.4, A.22): robots quit and join, links break and resume.

use crate::assign::epoch_after;
use crate::core::{ASSIGNMENT, LeaderAssignment};
use crate::{members, organise::Seated};
use std::collections::BTreeMap;
use trench_core::{Condition, Level, Sink, Times};
use trench_formation::Vector2;
use trench_msgs::msg::{Assignment, Member};
use trench_msgs::std_msgs::Header;

impl LeaderAssignment {
    /// Looks whether the structure of the formation has changed, and says so.
    pub(crate) fn follow_structure(&mut self, at: Times, sink: &mut dyn Sink) {
        if !self.run.running() || self.assignment.is_none() {
            return;
        }
        let limits = self.settings.team;
        let changed = self.members.judge_presence(at.steady, &self.held.robots, limits);
        let seated = |robot: &String| self.seats.iter().any(|seat| seat.robot == *robot);
        // After a restart nobody knows who had quit: they may join at once.
        let waiting = self.held.robots.iter().any(|robot| !seated(robot) && !self.members.is_gone(robot));
        if changed || waiting {
            self.quit_and_join(at, sink);
        }
        for index in 0..self.seats.len() {
            let Seated { robot, leader: Some(ahead), .. } = &self.seats[index] else { continue };
            if self.members.judge_link(at.steady, robot, ahead, limits) {
                let (level, text) = match self.members.is_cut_off(robot) {
                    true => (Level::Warn, format!("{robot} does not hear {ahead}: it follows its goal (Remark 8.4.1)")),
                    false => (Level::Info, format!("{robot} hears {ahead} again and follows it")),
                };
                sink.log(level, &text);
            }
        }
        self.announce_seats(at, sink);
        self.tell_structure(at);
    }

    fn quit_and_join(&mut self, at: Times, sink: &mut dyn Sink) {
        let team = &self.members;
        for seat in self.seats.iter().filter(|seat| team.is_gone(&seat.robot)) {
            let reason = team.complaint(at.steady, &seat.robot);
            sink.log(Level::Warn, &format!("{} has quit: {reason}", seat.robot));
        }
        self.seats = members::without(&self.held.plan, &self.seats, |robot| team.is_gone(robot));
        let Some(positions) = self.positions(&self.held, at) else { return };
        let positions: BTreeMap<String, Vector2<f64>> = positions.into_iter().collect();
        let takes_part = |robot: &String| self.members.is_here(at.steady, robot);
        let size = self.held.robots.iter().filter(|robot| takes_part(robot)).count();
        for robot in &self.held.robots {
            let seated = self.seats.iter().any(|seat| seat.robot == *robot);
            let Some(position) = positions.get(robot).filter(|_| !seated && !self.members.is_gone(robot)) else {
                continue;
            };
            if let Some(seats) = members::with(&self.held.plan, &self.seats, (robot, *position), &positions, size) {
                self.seats = seats;
                sink.log(Level::Info, &format!("{robot} joins"));
            }
        }
    }

    /// Publishes the seats as they are followed now, if that is news: who does not hear the robot ahead follows nobody.
    pub(crate) fn announce_seats(&mut self, at: Times, sink: &mut dyn Sink) {
        let member = |seat: &Seated| {
            let followed = seat.leader.as_ref().filter(|_| !self.members.is_cut_off(&seat.robot));
            Member { leader: followed.cloned().unwrap_or_default(), ..seat.member() }
        };
        let members: Vec<Member> = self.seats.iter().map(member).collect();
        let hash = self.held.message.hash;
        let same = |old: &Assignment| old.members == members && old.formation_hash == hash;
        if self.assignment.as_ref().is_some_and(same) {
            return;
        }
        let header = Header { stamp: at.ros.into(), frame_id: self.held.plan.frame.id().to_owned() };
        let epoch = epoch_after(self.assignment.as_ref());
        let assignment = Assignment { header, epoch, formation_hash: hash, members };
        sink.publish(ASSIGNMENT, &assignment);
        self.assignment = Some(assignment);
    }

    fn tell_structure(&mut self, at: Times) {
        let gone = self.held.robots.iter().filter(|robot| self.seats.iter().all(|seat| seat.robot != **robot));
        let gone = gone.map(|robot| format!("{robot} takes no part: {}", self.members.complaint(at.steady, robot)));
        let alone = self.seats.iter().filter(|seat| seat.leader.is_some() && self.members.is_cut_off(&seat.robot));
        let alone = alone.map(|seat| format!("{} does not hear the robot ahead", seat.robot));
        let told: Vec<String> = gone.chain(alone).collect();
        match told.is_empty() {
            true => self.health.set("team", Condition::Ok, "all robots take part and hear the robot ahead"),
            false => self.health.set("team", Condition::Warn, told.join("; ")),
        }
    }
}
