//! A robot that has come to rest turns the way its formation faces, where `face` asks for it: at each rest of the formation, or where it
//! has arrived.
//!
//! Meanwhile the law goes on as if the point that it steers were where it will be again: if that is to move, because the target, the leader,
//! the formation or an obstacle does, the law drives at once, from there, and the robot catches up with it. Followers hear of this point.

use crate::tick::{Tick, Wanted};
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::kinematics::{Facing, Pose, Twist};

/// s, for which the law must have wanted nothing.
const RESTED: f64 = 1.0;
/// s, after which it is left as it is: something is in the way.
const LONGEST: f64 = 15.0;
/// m/s and rad/s, below which the formation's frame rests.
const FRAME_RESTS: (f64, f64) = (0.003, 0.01);
/// s, in which a robot catches up with the point that its law has gone on with.
const CATCHES_UP: f64 = 2.0;

/// When robots turn the way their formation faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Faces {
    Never,
    /// Whenever it rests.
    AtRest,
    /// When it rests and has moved before.
    Arrived,
}

/// What a robot at rest does about the way it faces.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Face {
    stage: Stage,
    /// From where the point before the axle was to where the law goes on, m, map, when it did.
    behind: Option<(Vector2<f64>, Steady)>,
}

#[derive(Debug, Clone, Copy, Default)]
enum Stage {
    /// The law drives.
    #[default]
    Driving,
    /// The law has wanted nothing since.
    Resting(Steady),
    /// It turns, since.
    Turning(Facing, Steady),
    /// It has turned, once for each rest.
    Turned,
}

impl Face {
    /// From where the point before the axle is, at `point`, to where it is for the law, m, map; and how fast that changes, m/s, if the
    /// former moves at `velocity`. None where it is the same.
    pub(crate) fn ahead(
        &self,
        now: Steady,
        (point, velocity): (Vector2<f64>, Vector2<f64>),
    ) -> Option<(Vector2<f64>, Vector2<f64>)> {
        if let Stage::Turning(facing, _) = &self.stage {
            return Some((facing.point() - point, -velocity));
        }
        let (behind, since) = self.behind?;
        let left = 1.0 - now.seconds_since(since) / CATCHES_UP;
        (left > 0.0).then(|| (left * behind, -behind / CATCHES_UP))
    }

    /// Goes on to `stage`. `point` is where the point before the axle is.
    fn next(&mut self, stage: Stage, now: Steady, point: Vector2<f64>) {
        if let (Stage::Turning(facing, _), Stage::Driving | Stage::Turned) = (&self.stage, &stage) {
            self.behind = Some((facing.point() - point, now));
        }
        self.stage = stage;
    }
}

impl Tick {
    /// What the robot does instead of resting as the law wants; none where the law drives.
    pub(crate) fn face(&mut self, (at, acts): (Times, RosTime), ahead: Pose, wanted: &Wanted) -> Option<Twist> {
        let now = at.steady;
        let look_ahead = self.settings.look_ahead();
        let heading = self.faces(acts).filter(|_| wanted.rests);
        let (stage, twist) = match (self.face.stage, heading) {
            (_, None) => (Stage::Driving, None),
            (Stage::Driving, Some(_)) => (Stage::Resting(now), None),
            (Stage::Resting(since), Some(heading)) if now.seconds_since(since) >= RESTED => {
                let begun = Facing::begin(ahead, look_ahead, heading);
                (begun.map_or(Stage::Turned, |facing| Stage::Turning(facing, now)), None)
            }
            (Stage::Turning(mut facing, since), Some(_)) => {
                let twist = facing.twist(ahead).filter(|_| now.seconds_since(since) < LONGEST);
                (if twist.is_some() { Stage::Turning(facing, since) } else { Stage::Turned }, twist)
            }
            (stage, Some(_)) => (stage, None),
        };
        self.face.next(stage, now, ahead.position() + look_ahead * ahead.heading());
        twist
    }

    /// How the formation faces, rad, map, while it rests and the robot is to face so.
    fn faces(&mut self, acts: RosTime) -> Option<f64> {
        let (frame, motion) = self.inputs.goals.frame(acts)?;
        let (speed, turn) = FRAME_RESTS;
        let rests = motion.origin.velocity.norm() < speed && motion.turn_rate.abs() < turn;
        self.formation_moved |= !rests;
        let is_asked_for = match self.settings.faces {
            Faces::Never => false,
            Faces::AtRest => true,
            Faces::Arrived => self.formation_moved,
        };
        (rests && is_asked_for).then(|| libm::atan2(frame.rotation.im, frame.rotation.re))
    }
}
