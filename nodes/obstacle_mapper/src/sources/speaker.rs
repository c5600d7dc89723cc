//! One publisher of obstacles.

use super::Known;
use std::collections::BTreeMap;
use trench_core::{RosTime, Steady, Times};
use trench_msgs::msg::ObstacleArray;

/// Ids of the second source and later ones are moved by this much a source.
const IDS_A_SOURCE: u32 = 1 << 20;
/// A clock that runs back this far, s, was set anew: less is a message out of order.
const SET_BACK: f64 = 1.0;
/// A moving obstacle is carried on for so long after the last news, s; then it stays.
const CARRIED: f64 = 1.0;
/// A publisher that was never silent for longer than a third of its silence, and this, s, has gone.
const GRACE: f64 = 1.0;
/// More obstacles or corners in a message are no description of a field.
const MOST_OBSTACLES: usize = 1000;
const MOST_CORNERS: usize = 20_000;

/// What was said of an obstacle last.
#[derive(Debug, Clone)]
struct News {
    stamp: RosTime,
    known: Known,
}

/// A publisher with what it told last.
pub(super) struct Speaker {
    pub(super) gid: [u8; 16],
    /// Added to its ids.
    offset: u32,
    stamp: Option<RosTime>,
    heard: Steady,
    /// When a message of it could be used last.
    taken: Option<Steady>,
    /// Its longest silence so far, s, once it has spoken twice.
    rhythm: Option<f64>,
    known: Vec<News>,
    pub(super) complaints: Vec<String>,
}

impl Speaker {
    pub(super) fn new(gid: [u8; 16], number: u32, at: Times) -> Self {
        let offset = number.wrapping_mul(IDS_A_SOURCE);
        let (known, complaints) = (Vec::new(), Vec::new());
        Self { gid, offset, stamp: None, heard: at.steady, taken: None, rhythm: None, known, complaints }
    }

    /// Takes a message; gives what is wrong with it.
    pub(super) fn take(&mut self, at: Times, message: &ObstacleArray) -> Vec<String> {
        if self.stamp.is_some() {
            self.rhythm = Some(self.rhythm.unwrap_or(0.0).max(self.silence(at)));
        }
        self.heard = at.steady;
        let stamp = match RosTime::from(&message.header.stamp) {
            // Typed by hand, without a stamp.
            RosTime(0) => at.ros,
            stamp => stamp,
        };
        self.complaints = match self.refusal(at, stamp, message) {
            Some(reason) => vec![reason],
            None => {
                self.stamp = Some(stamp);
                let (known, complaints) = self.read(stamp, message);
                // Who tells of obstacles none of which is one has told of nothing, and not of a field without any.
                if message.obstacles.is_empty() || known.iter().any(|news| news.stamp == stamp) {
                    self.taken = Some(at.steady);
                    self.known = known;
                }
                complaints
            }
        };
        self.complaints.clone()
    }

    /// Why a message as a whole cannot be used.
    fn refusal(&self, at: Times, stamp: RosTime, message: &ObstacleArray) -> Option<String> {
        let ahead = stamp.seconds_since(at.ros);
        if ahead > Times::FUTURE {
            return Some(format!("a message was dropped: its stamp is {ahead:.1} s in the future"));
        }
        let behind = self.stamp.map_or(0.0, |last| last.seconds_since(stamp));
        if behind > 0.0 && behind < SET_BACK {
            return Some(format!("a message was dropped: it is {behind:.3} s older than the last one"));
        }
        let corners: usize = message.obstacles.iter().map(|obstacle| obstacle.polygon.len()).sum();
        let count = message.obstacles.len();
        (count > MOST_OBSTACLES || corners > MOST_CORNERS).then(|| {
            let most = format!("at most {MOST_OBSTACLES} and {MOST_CORNERS} are taken");
            format!("a message was dropped: {count} obstacles with {corners} corners, {most}")
        })
    }

    /// The obstacles of a message, and what is wrong with it. One that cannot be used and was known is still there.
    fn read(&self, stamp: RosTime, message: &ObstacleArray) -> (Vec<News>, Vec<String>) {
        let (mut usable, mut kept, mut complaints) = (BTreeMap::new(), BTreeMap::new(), Vec::new());
        for obstacle in &message.obstacles {
            let id = obstacle.id.wrapping_add(self.offset);
            match Known::read(id, obstacle) {
                Ok(_) if usable.contains_key(&id) => {
                    complaints.push(format!("obstacle {} is left out: a second one of this id", obstacle.id));
                }
                Ok((known, problem)) => {
                    complaints.extend(problem.map(|problem| format!("obstacle {}: {problem}", obstacle.id)));
                    usable.insert(id, News { stamp, known });
                }
                Err(reason) => {
                    let before = self.known.iter().find(|news| news.known.id == id);
                    let done = if before.is_some() { "stays where it was" } else { "is left out" };
                    complaints.push(format!("obstacle {} {done}: {reason}", obstacle.id));
                    kept.extend(before.map(|news| (id, news.clone())));
                }
            }
        }
        kept.append(&mut usable);
        (kept.into_values().collect(), complaints)
    }

    pub(super) fn silence(&self, at: Times) -> f64 {
        at.steady.seconds_since(self.heard)
    }

    /// Whether something usable came from it within so many seconds.
    pub(super) fn is_heard(&self, at: Times, within: f64) -> bool {
        self.taken.is_some_and(|taken| at.steady.seconds_since(taken) <= within)
    }

    /// Whether it is silent for longer than its rhythm explains; `alone`: nobody is connected any more.
    pub(super) fn is_silent(&self, at: Times, alone: bool) -> bool {
        match self.rhythm {
            Some(rhythm) => self.silence(at) > GRACE + 3.0 * rhythm,
            None => alone && self.silence(at) > GRACE,
        }
    }

    /// Its obstacles where they are at `at`.
    pub(super) fn at(&self, at: Times) -> impl Iterator<Item = Known> {
        self.known.iter().map(move |news| news.known.moved(at.ros.seconds_since(news.stamp).clamp(0.0, CARRIED)))
    }

    pub(super) fn len(&self) -> usize {
        self.known.len()
    }
}
