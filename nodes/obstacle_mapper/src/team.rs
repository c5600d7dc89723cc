//! Where the robots were in the last moments: scans are older than what is known when they come.

use std::collections::VecDeque;
use trench_core::RosTime;
use trench_msgs::msg::{RobotState, TeamState};
use trench_optics::Pose2;

/// Team states that are kept: a second's at 30 Hz.
const LENGTH: usize = 32;
/// Longer gaps between two team states are not bridged, s.
const LONGEST_GAP: f64 = 0.2;

/// One team state: robots that are known to be where they are said to be.
struct Moment {
    stamp: RosTime,
    robots: Vec<(String, Pose2)>,
}

/// The last second of the team.
#[derive(Default)]
pub(crate) struct Team {
    moments: VecDeque<Moment>,
}

/// What is known of a robot's pose at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Whereabouts {
    At(Pose2),
    /// The time is not yet known.
    Later,
    /// Nor will it ever be.
    Unknown,
}

impl Team {
    /// Takes a team state, unless it is older than the last one.
    pub(crate) fn take(&mut self, message: &TeamState) {
        let stamp = RosTime::from(&message.header.stamp);
        if let Some(last) = self.moments.back() {
            match stamp.seconds_since(last.stamp) {
                // The clock was set back.
                behind if behind < -1.0 => self.moments.clear(),
                behind if behind <= 0.0 => return,
                _ => {}
            }
        }
        let known = |robot: &&RobotState| {
            matches!(robot.status, RobotState::STATUS_TRACKED | RobotState::STATUS_PREDICTED)
                && [robot.x, robot.y, robot.theta].iter().all(|number| number.is_finite())
        };
        let pose = |robot: &RobotState| Pose2 { x: robot.x, y: robot.y, theta: robot.theta };
        let robots = message.robots.iter().filter(known).map(|robot| (robot.name.clone(), pose(robot))).collect();
        if self.moments.len() == LENGTH {
            self.moments.pop_front();
        }
        self.moments.push_back(Moment { stamp, robots });
    }

    /// Where a robot is by the newest team state, unless it is lost or in doubt there.
    pub(crate) fn newest(&self, robot: &str) -> Option<Pose2> {
        let newest = self.moments.back()?;
        newest.robots.iter().find(|(name, _)| name == robot).map(|(_, pose)| *pose)
    }

    /// Where a robot was at a time, between two team states by interpolation.
    pub(crate) fn whereabouts(&self, robot: &str, at: RosTime) -> Whereabouts {
        let Some((before, after)) = self.around(at) else {
            let is_later = self.moments.back().is_none_or(|last| last.stamp < at);
            return if is_later { Whereabouts::Later } else { Whereabouts::Unknown };
        };
        let of = |moment: &Moment| moment.robots.iter().find(|(name, _)| name == robot).map(|(_, pose)| *pose);
        match (of(before), of(after)) {
            (Some(early), Some(late)) => Whereabouts::At(between(early, late, share(before, after, at))),
            _ => Whereabouts::Unknown,
        }
    }

    /// Where all robots were that were known before and after a time.
    pub(crate) fn all(&self, at: RosTime) -> impl Iterator<Item = Pose2> {
        self.around(at).into_iter().flat_map(move |(before, after)| {
            let share = share(before, after, at);
            before.robots.iter().filter_map(move |(name, early)| {
                let (_, late) = after.robots.iter().find(|(other, _)| other == name)?;
                Some(between(*early, *late, share))
            })
        })
    }

    fn around(&self, at: RosTime) -> Option<(&Moment, &Moment)> {
        let after = self.moments.iter().position(|moment| moment.stamp >= at)?;
        let late = &self.moments[after];
        let early = if late.stamp == at { late } else { self.moments.get(after.checked_sub(1)?)? };
        (late.stamp.seconds_since(early.stamp) <= LONGEST_GAP).then_some((early, late))
    }
}

fn share(before: &Moment, after: &Moment, at: RosTime) -> f64 {
    let whole = after.stamp.seconds_since(before.stamp);
    if whole > 0.0 { at.seconds_since(before.stamp) / whole } else { 0.0 }
}

fn between(early: Pose2, late: Pose2, share: f64) -> Pose2 {
    let turn = libm::remainder(late.theta - early.theta, std::f64::consts::TAU);
    Pose2 {
        x: early.x + share * (late.x - early.x),
        y: early.y + share * (late.y - early.y),
        theta: early.theta + share * turn,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_msgs::std_msgs::Header;

    fn state(seconds: f64, robots: &[(&str, u8, f64, f64)]) -> TeamState {
        let robot = |&(name, status, x, theta): &(&str, u8, f64, f64)| RobotState {
            name: name.to_owned(),
            status,
            x,
            theta,
            ..RobotState::default()
        };
        let header = Header { stamp: RosTime(0).plus_seconds(seconds).into(), ..Header::default() };
        TeamState { header, robots: robots.iter().map(robot).collect(), ..TeamState::default() }
    }

    #[test]
    fn poses_are_interpolated_and_doubtful_ones_are_not_known() {
        let mut team = Team::default();
        let at = |seconds: f64| RosTime(0).plus_seconds(seconds);
        assert_eq!(team.whereabouts("a", at(1.0)), Whereabouts::Later);
        let (seen, lost) = (RobotState::STATUS_TRACKED, RobotState::STATUS_LOST);
        team.take(&state(1.0, &[("a", seen, 0.0, 3.1), ("b", seen, 5.0, 0.0)]));
        team.take(&state(1.1, &[("a", seen, 1.0, -3.1), ("b", lost, 5.0, 0.0)]));
        team.take(&state(1.05, &[("a", seen, 9.0, 0.0)]));
        let Whereabouts::At(pose) = team.whereabouts("a", at(1.05)) else { unreachable!() };
        assert!((pose.x - 0.5).abs() < 1e-6 && (pose.theta.abs() - std::f64::consts::PI).abs() < 1e-6, "{pose:?}");
        assert_eq!(team.whereabouts("b", at(1.05)), Whereabouts::Unknown);
        assert_eq!(team.whereabouts("a", at(1.11)), Whereabouts::Later);
        assert_eq!(team.whereabouts("a", at(0.9)), Whereabouts::Unknown);
        assert_eq!(team.all(at(1.1)).count(), 1);
        team.take(&state(2.0, &[("a", seen, 1.0, 0.0)]));
        assert_eq!(team.whereabouts("a", at(1.5)), Whereabouts::Unknown, "nobody knows what was in the gap");
        // The clock is set back.
        team.take(&state(0.2, &[("a", seen, 4.0, 0.0)]));
        assert!(matches!(team.whereabouts("a", at(0.2)), Whereabouts::At(pose) if pose.x == 4.0));
    }
}
