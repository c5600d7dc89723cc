//! Names found by small turns: one robot at a time is told to turn on the spot, and the pad that turns is its own.
//!
//! Bodies are round and turn about their middle, so that a turn touches nobody. A turn counts if one pad turns, in the
//! direction told, and stands again soon after the turn is over, while no other pad in doubt moves: what hands do to robots
//! meanwhile names nobody.

use super::filter::wrap;
use super::pairing::Pair;
use super::tracker::Track;
use nalgebra::Matrix3;
use trench_optics::Pose2;

/// How fast robots turn, rad/s: 0.06 m/s at the wheels, which steppers start and stop at without a ramp.
const SPEED: f64 = 1.0;
/// A pad that has turned so far is the one, rad; with what the robot turns on until it hears to stop it makes about 20 degrees.
const TURNED: f64 = 0.25;
/// A pad that has moved by less stands still, m and rad.
const STILL: [f64; 2] = [0.008, 0.07];
/// A robot that turns on beyond this when it should stand is turned by somebody else, rad.
const TOO_FAR: f64 = 0.6;
/// A pad in doubt must have stood for so long before a turn, s.
const REST: f64 = 0.15;
/// After a turn the pad must stand by then, s.
const SETTLING: f64 = 0.3;
/// A robot that has not turned by then does not hear, or nobody sees it, s.
const PATIENCE: f64 = 1.0;
/// Between these angles the turn is steady, rad: its line, drawn back, tells when the wheels began.
const STEADY: [f64; 2] = [0.06, 0.4];
/// Delays kept: of the last ones.
const KEPT: usize = 48;
/// How often each robot is told to turn before only a request, or a pad that has come, makes it turn again.
const ATTEMPTS: u32 = 4;

/// What is asked of a robot in this frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Its place among the tracks.
    pub robot: usize,
    /// rad/s
    pub omega: f64,
}

/// Where the pads in doubt were when a phase began; None of tracks without one.
type Places = Vec<Option<Pose2>>;

#[derive(Debug, Clone, Default)]
enum Phase {
    #[default]
    Idle,
    /// All pads in doubt should stand.
    Resting { since: Places, elapsed: f64 },
    /// A robot is told to turn.
    Turning { turn: Turn, from: Places, elapsed: f64 },
    /// The pad of this track has turned, and should stand again.
    Settling { turn: Turn, pad: usize, from: Places, elapsed: f64, last: f64 },
}

/// Finds names, a turn a time.
#[derive(Debug, Clone, Default)]
pub(super) struct Turns {
    phase: Phase,
    /// Of each robot, how often it was told to turn in vain.
    attempts: Vec<u32>,
    /// Pads in doubt in the last frame.
    open: usize,
    /// Since the robot was asked, s, and where the pads in doubt were then.
    course: Vec<(f64, Places)>,
    /// From the exposure of the frame that made a robot turn to its wheels turning, s, by the turns so far.
    delays: Vec<f64>,
}

impl Turns {
    /// From an exposure to the wheels that obey what it led to, s: the median over the last turns, and how many they were.
    pub(super) fn delay(&self) -> Option<(f64, usize)> {
        let mut delays = self.delays.clone();
        delays.sort_by(f64::total_cmp);
        delays.get(delays.len() / 2).map(|median| (*median, delays.len()))
    }

    /// A turn was seen: its line, drawn back to no angle, is the delay.
    fn measure(&mut self, turn: Turn, pad: usize, from: &Places) {
        let steady = self.course.iter().filter_map(|(time, places)| {
            let by = turned(from, places, pad)? * turn.omega.signum();
            (STEADY[0]..STEADY[1]).contains(&by).then(|| time - by / turn.omega.abs())
        });
        let starts: Vec<f64> = steady.collect();
        if starts.len() < 3 {
            return;
        }
        if self.delays.len() == KEPT {
            self.delays.remove(0);
        }
        self.delays.push(starts.iter().sum::<f64>() / starts.len() as f64);
    }

    /// Tries again with those who were given up.
    pub(super) fn encourage(&mut self) {
        self.attempts.clear();
    }

    /// Looks at a frame `dt` (s) after the last one; renames the tracks whose names have become certain and gives what is
    /// asked of whom. `strangers` are pads that no robot was matched with, `hold` (s) as in the settings.
    pub(super) fn step(
        &mut self,
        dt: f64,
        tracks: &mut [Track],
        strangers: &[Pair],
        hold: f64,
        measurement: &Matrix3<f64>,
    ) -> Option<Turn> {
        let now = places(tracks);
        let open = now.iter().flatten().count();
        if open > self.open {
            self.encourage();
        }
        self.open = open;
        self.attempts.resize(tracks.len(), 0);
        if open == 0 {
            self.phase = Phase::Idle;
            return None;
        }
        self.phase = match std::mem::take(&mut self.phase) {
            // Somebody has said who it is.
            Phase::Turning { turn, .. } | Phase::Settling { turn, .. } if !is_nameless(&tracks[turn.robot], hold) => {
                Phase::Idle
            }
            Phase::Idle => Phase::Resting { since: now, elapsed: 0.0 },
            Phase::Resting { since, .. } if moved(&since, &now, None) => Phase::Resting { since: now, elapsed: 0.0 },
            Phase::Resting { since, elapsed } if elapsed + dt < REST => Phase::Resting { since, elapsed: elapsed + dt },
            Phase::Resting { .. } => self.begin(tracks, now, hold),
            Phase::Turning { turn, from, elapsed } => {
                let elapsed = elapsed + dt;
                self.course.push((elapsed, now.clone()));
                let direction = turn.omega.signum();
                let pad =
                    (0..now.len()).find(|pad| turned(&from, &now, *pad).is_some_and(|by| direction * by > TURNED));
                match pad {
                    Some(pad) if !moved(&from, &now, Some(pad)) => {
                        self.measure(turn, pad, &from);
                        Phase::Settling { turn, pad, from, elapsed: 0.0, last: f64::NAN }
                    }
                    None if elapsed < PATIENCE => Phase::Turning { turn, from, elapsed },
                    _ => self.fail(turn.robot, tracks, strangers, measurement),
                }
            }
            Phase::Settling { turn, pad, from, elapsed, last } => {
                let (elapsed, by) = (elapsed + dt, turned(&from, &now, pad));
                let stands = by.is_some_and(|by| (by - last).abs() < STILL[1] && by.abs() < TOO_FAR);
                match by {
                    Some(by) if elapsed < SETTLING => Phase::Settling { turn, pad, from, elapsed, last: by },
                    Some(_) if stands && !moved(&from, &now, Some(pad)) => {
                        self.attempts[turn.robot] = 0;
                        give(tracks, turn.robot, pad, hold);
                        self.begin(tracks, places(tracks), hold)
                    }
                    _ => self.fail(turn.robot, tracks, strangers, measurement),
                }
            }
        };
        match &self.phase {
            Phase::Turning { turn, .. } => Some(*turn),
            _ => None,
        }
    }

    /// The next robot to turn: of those whose pad is not known, one that was told least often.
    fn begin(&mut self, tracks: &[Track], now: Places, hold: f64) -> Phase {
        self.course.clear();
        let nameless = (0..tracks.len()).filter(|robot| is_nameless(&tracks[*robot], hold));
        let next = nameless.min_by_key(|robot| self.attempts[*robot]);
        match next.filter(|robot| self.attempts[*robot] < ATTEMPTS && now.iter().any(Option::is_some)) {
            Some(robot) => {
                let direction = if (robot + self.attempts[robot] as usize).is_multiple_of(2) { 1.0 } else { -1.0 };
                Phase::Turning { turn: Turn { robot, omega: direction * SPEED }, from: now, elapsed: 0.0 }
            }
            None => Phase::Resting { since: now, elapsed: 0.0 },
        }
    }

    /// Nobody turned, or not as told. Perhaps the robot's pad is one of those that no name was left for.
    fn fail(&mut self, robot: usize, tracks: &mut [Track], strangers: &[Pair], measurement: &Matrix3<f64>) -> Phase {
        let attempt = self.attempts[robot] as usize;
        self.attempts[robot] += 1;
        if let Some(stranger) = strangers.get(attempt % strangers.len().max(1)) {
            tracks[robot].put(stranger, measurement);
            tracks[robot].in_doubt = true;
        }
        Phase::Resting { since: places(tracks), elapsed: 0.0 }
    }
}

/// Whether it is not known which pad is this robot's.
fn is_nameless(track: &Track, hold: f64) -> bool {
    track.in_doubt || track.is_missing(hold)
}

/// Where the pads are that are seen and in doubt.
fn places(tracks: &[Track]) -> Places {
    let place = |track: &Track| {
        let seen = track.filter.as_ref().filter(|_| track.in_doubt && track.unseen == 0.0);
        seen.map(|filter| filter.state().pose)
    };
    tracks.iter().map(place).collect()
}

/// By how much the pad of a track has turned, rad; None if it is hidden or has left its place.
fn turned(from: &Places, now: &Places, pad: usize) -> Option<f64> {
    let (from, now) = (from[pad]?, now[pad]?);
    (libm::hypot(now.x - from.x, now.y - from.y) < 2.0 * STILL[0]).then(|| wrap(now.theta - from.theta))
}

/// Whether any pad but that of the track `except` has moved. One that is hidden has not.
fn moved(from: &Places, now: &Places, except: Option<usize>) -> bool {
    let is_elsewhere = |(from, now): (&Option<Pose2>, &Option<Pose2>)| {
        let (Some(from), Some(now)) = (from, now) else { return false };
        libm::hypot(now.x - from.x, now.y - from.y) > STILL[0] || wrap(now.theta - from.theta).abs() > STILL[1]
    };
    from.iter().zip(now).enumerate().any(|(pad, places)| Some(pad) != except && is_elsewhere(places))
}

/// The pad that goes under the name of track `pad` is that of `robot`: both exchange what they know.
pub(super) fn give(tracks: &mut [Track], robot: usize, pad: usize, hold: f64) {
    if let Ok([mine, theirs]) = tracks.get_disjoint_mut([robot, pad]) {
        std::mem::swap(&mut mine.filter, &mut theirs.filter);
        std::mem::swap(&mut mine.unseen, &mut theirs.unseen);
        std::mem::swap(&mut mine.was_seen, &mut theirs.was_seen);
        theirs.in_doubt = true;
        // Of a robot that is lost nobody knows where it was.
        if theirs.unseen > hold {
            (theirs.filter, theirs.unseen, theirs.in_doubt) = (None, f64::INFINITY, false);
        }
    }
    tracks[robot].in_doubt = false;
}
