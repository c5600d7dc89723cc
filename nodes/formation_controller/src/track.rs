//! The laws of chapter 4 in a tick, and what the monitor makes of any law.

use crate::Law;
use crate::monitor::watched;
use crate::tick::{Command, Tick, Wanted};
use trench_core::Times;
use trench_formation::Vector2;
use trench_formation::kinematics::{Pose, Twist};
use trench_formation::laws::GoalMotion;
use trench_formation::stability::{Input, Supply};
use trench_msgs::msg::{Goal, LeaderState};

impl Tick {
    /// Has the monitor look at what the law wanted and what is sent.
    pub(crate) fn watch(&mut self, at: Times, ahead: Pose, wanted: &Wanted, command: &mut Command) {
        let Some(watched) = &wanted.watched else { return self.monitor.restart() };
        let acted = if command.limits & LeaderState::LIMIT_SAFETY == 0 { Input::Limits } else { Input::Safety };
        let mut filtered = Supply::default();
        if wanted.twist != command.twist {
            if let Some(expected) = watched.expected {
                filtered.add(acted, expected.missed(watched.gradient, ahead, command.twist));
            }
            if let (Some(news), Some(dynamic)) = (&mut self.news, &self.settings.dynamic) {
                news.sent(ahead, command.twist, dynamic.look_ahead, acted);
            }
        }
        command.balanced = Some(self.monitor.observe(at.steady.0 as f64 * 1e-9, watched, filtered));
    }

    /// A kinematic law of chapter 4.
    pub(crate) fn track(&mut self, ahead: Pose, (goal, phase): (GoalMotion, u8)) -> Wanted {
        let tracked = self.settings.law.track(self.settings.dead_band, ahead, goal, self.holding);
        self.holding = tracked.holding;
        let feed = if let Law::Tracking(law) = self.settings.law { Some(law.gains.k1) } else { None };
        let epoch = self.inputs.assignment.as_ref().map_or(0, |assignment| assignment.epoch);
        Wanted {
            watched: Some(watched(&tracked, (ahead, goal, phase), feed, epoch, self.inputs.interval())),
            zone: None,
            twist: tracked.twist,
            rests: tracked.twist == Twist::ZERO,
            drawn: Some(goal.position),
            place: None,
            error: None,
            distance: tracked.distance,
            lyapunov: tracked.lyapunov,
            acceleration: Vector2::zeros(),
            // A goal that moves on is no place that a robot could be in the way of.
            detour: (phase != Goal::PHASE_MOVING || !self.holding).then_some(goal.position),
            pace: 0.0,
        }
    }
}
