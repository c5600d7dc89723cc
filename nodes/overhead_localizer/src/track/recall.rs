//! Identities that a former life of the localizer knew, weighed against the start poses by what the camera sees.

use super::filter::{FARTHEST, Filter};
use super::identity::Hypotheses;
use super::tracker::{Track, Tracker};
use super::{MapDisc, wrap};
use trench_optics::Pose2;

/// A robot as it was last known.
#[derive(Debug, Clone, PartialEq)]
pub struct Remembered {
    /// Its name.
    pub name: String,
    /// Where it was.
    pub pose: Pose2,
    /// Its forward speed, m/s.
    pub v: f64,
    /// Its turning speed, rad/s.
    pub omega: f64,
    /// How long it had not been seen, s.
    pub unseen: f64,
    /// Whether it was in doubt which robot it is.
    pub in_doubt: bool,
}

/// Without the localizer robots stop within this time, s (invariant 8); half of it at their speed is what is expected.
pub(super) const STOPPING: f64 = 0.25;
/// What is not known of a speed when the news ended, m/s and rad/s.
const SPEED: [f64; 2] = [0.05, 0.3];
/// Afterwards they stand, unless somebody moves them: m/sqrt(s) and rad/sqrt(s).
const MOVED: [f64; 2] = [0.03, 0.2];
/// As the measurements that it was known by, and more, m and rad.
const KNOWN: [f64; 2] = [0.002, 0.02];

/// Where a robot is expected that was at `pose` with these speeds (m/s, rad/s) `age` (s) ago, when the localizer fell silent,
/// and had not been seen for `unseen` (s) then; and how well that is known.
pub(super) fn expected(pose: Pose2, [v, omega]: [f64; 2], age: f64, unseen: f64) -> Filter {
    let coasting = 0.5 * STOPPING.min(age);
    let (ahead, turned) = (v * coasting, omega * coasting);
    let heading = pose.theta + 0.5 * turned;
    let place = Pose2 {
        x: pose.x + ahead * libm::cos(heading),
        y: pose.y + ahead * libm::sin(heading),
        theta: wrap(pose.theta + turned),
    };
    let doubt = |axis: usize, speed: f64| {
        let stopping = (speed.abs() + SPEED[axis]) * coasting;
        let moved = MOVED[axis] * libm::sqrt(age + unseen);
        libm::sqrt(KNOWN[axis] * KNOWN[axis] + stopping * stopping + moved * moved).min(FARTHEST[axis])
    };
    let sigma = doubt(0, v);
    Filter::new(place, [sigma, sigma, doubt(1, omega)])
}

impl Tracker {
    /// Tells a tracker that has seen nothing yet where robots were `age` (s) before its first frame. The first frame with a
    /// pad decides between that and the start poses; robots that fit both alike under different names are in doubt.
    pub fn recall(&mut self, last: &[Remembered], age: f64) {
        let remember = |track: &Track| match last.iter().find(|robot| robot.name == track.name) {
            Some(robot) => Track {
                filter: Some(expected(robot.pose, [robot.v, robot.omega], age, robot.unseen)),
                unseen: robot.unseen + age,
                in_doubt: robot.in_doubt,
                ..track.clone()
            },
            None => track.clone(),
        };
        self.remembered = Some(self.tracks.iter().map(remember).collect());
    }

    /// Decides, as soon as there is something to decide by.
    pub(super) fn choose(&mut self, discs: &[MapDisc]) {
        let Some(remembered) = self.remembered.take() else { return };
        let from_start = std::mem::replace(&mut self.tracks, remembered);
        let pads = self.seen(discs);
        let recalled = Hypotheses::new(&self.tracks, &pads, &self.measurement);
        let at_start = Hypotheses::new(&from_start, &pads, &self.measurement);
        if pads.is_empty() {
            self.remembered = Some(std::mem::replace(&mut self.tracks, from_start));
            return;
        }
        if from_start.iter().all(|track| track.filter.is_none()) {
            return;
        }
        let (now, then) = (recalled.best(), at_start.best());
        let gained = at_start.worth(&then) - recalled.worth(&now);
        if gained.abs() < Hypotheses::MARGIN {
            for (track, differs) in self.tracks.iter_mut().zip(now.iter().zip(&then).map(|(a, b)| a != b)) {
                track.in_doubt |= differs;
            }
        } else if gained > 0.0 {
            self.tracks = from_start;
        }
    }
}
