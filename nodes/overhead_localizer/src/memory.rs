//! What outlives the process (invariant 12): who is where, in a checkpoint.

use crate::messages;
use crate::track::{Remembered, Status, Track};
use nalgebra::Vector2;
use trench_core::{RosTime, Sink, Steady, Times};
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::msg::{RobotState, TeamState};
use trench_msgs::{Encode, Message};
use trench_optics::Pose2;

/// The shortest time between two checkpoints, s: each replaces a file.
const SHORTEST: f64 = 0.2;
/// The longest, s: an old checkpoint says little, however still the robots stand.
const LONGEST: f64 = 2.0;
/// A robot that has moved so far, m and rad, since the last checkpoint is worth a new one.
const NOTICEABLE: [f64; 2] = [0.005, 0.05];
/// Older checkpoints than this, s, are of another experiment.
const OLDEST: f64 = 30.0;

/// Keeps the last checkpoint up to date.
pub(crate) struct Memory {
    /// What the last life left, until the first frame.
    inherited: Option<TeamState>,
    written: Option<(Steady, Vec<Place>)>,
}

type Place = (Status, Option<Pose2>);

impl Memory {
    /// With what the last life left: a TeamState, if it is one.
    pub(crate) fn new(checkpoint: Option<&[u8]>) -> Self {
        Self { inherited: checkpoint.and_then(|bytes| TeamState::decode(bytes).ok()), written: None }
    }

    /// At the first frame: who was where, and how long ago, s; nothing if that is not known or too long ago.
    pub(crate) fn recall(&mut self, stamp: Time) -> Option<(Vec<Remembered>, f64)> {
        let state = self.inherited.take()?;
        let age = RosTime::from(&stamp).seconds_since(RosTime::from(&state.header.stamp));
        // A clock that runs back was set anew: nobody knows how long ago that was.
        (0.0..=OLDEST).contains(&age).then(|| (state.robots.iter().filter_map(remembered).collect(), age))
    }

    /// Writes a checkpoint if it is time to.
    pub(crate) fn keep(&mut self, at: Times, stamp: Time, tracks: &[Track], sink: &mut dyn Sink) {
        let age = self.written.as_ref().map_or(f64::INFINITY, |(last, _)| at.steady.seconds_since(*last));
        let any = tracks.iter().any(|track| track.unseen.is_finite());
        if age < SHORTEST || !any || (age < LONGEST && !self.is_news(tracks)) {
            return;
        }
        sink.checkpoint(&messages::team_state(stamp, 0, tracks, &[]).to_cdr());
        self.written = Some((at.steady, tracks.iter().map(place).collect()));
    }

    fn is_news(&self, tracks: &[Track]) -> bool {
        let Some((_, places)) = &self.written else { return true };
        let far = |a: Pose2, b: Pose2| {
            Vector2::new(a.x - b.x, a.y - b.y).norm() > NOTICEABLE[0]
                || crate::track::wrap(a.theta - b.theta).abs() > NOTICEABLE[1]
        };
        places.iter().zip(tracks.iter().map(place)).any(|((status, pose), (now, here))| {
            *status != now || pose.zip(here).is_none_or(|(pose, here)| far(pose, here))
        })
    }
}

fn place(track: &Track) -> Place {
    (track.status, track.filter.as_ref().map(|filter| filter.state().pose))
}

/// A robot of a checkpoint, if it was ever seen and its numbers are numbers.
fn remembered(robot: &RobotState) -> Option<Remembered> {
    let unseen = f64::from(robot.unseen.sec) + 1e-9 * f64::from(robot.unseen.nanosec);
    let numbers = [robot.x, robot.y, robot.theta, robot.v, robot.omega];
    (unseen < messages::NEVER && numbers.iter().all(|number| number.is_finite())).then(|| Remembered {
        name: robot.name.clone(),
        pose: Pose2 { x: robot.x, y: robot.y, theta: crate::track::wrap(robot.theta) },
        v: robot.v,
        omega: robot.omega,
        unseen,
        in_doubt: robot.status == RobotState::STATUS_AMBIGUOUS,
    })
}
