//! What the localizer tells people: log lines when a robot's status changes, the state of camera and team once a second.

use crate::missing::{self, Missing};
use crate::refusal::Refusal;
use crate::stream::Stream;
use crate::track::{Status, Track};
use std::collections::BTreeMap;
use trench_core::{Condition, Health, Interface, Level, Refusals, Sink, Steady, Times};

/// Without frames for so long, s, something is wrong with the camera.
const SILENCE: f64 = 0.5;
/// One frame of so many may be missed: more, and something must be set right.
const MOST_MISSED: u64 = 100;
/// How often conditions are looked at, s.
pub(crate) const PERIOD: f64 = 0.25;

/// Keeps the counters that go to /diagnostics.
pub(crate) struct Report {
    health: Health,
    port: usize,
    statuses: Vec<Status>,
    /// Pads in the last frame.
    pads: usize,
    missing: Missing,
    /// Frames that were not understood, by reason.
    rejected: BTreeMap<String, u64>,
    /// Frames that do not count, once there are any.
    refusals: Option<Refusals>,
    last_frame: Option<Steady>,
    /// Its beginning, and what the stream had counted by then.
    window: Option<(Steady, Stream)>,
    rate: f64,
    /// Missed of the last window, of so many.
    missed: [u64; 2],
    rejected_at_window: u64,
    /// Whether frames began to be dropped since the last publication.
    is_urgent: bool,
}

impl Report {
    pub(crate) fn new(health: Health, port: usize) -> Self {
        Self {
            health,
            port,
            statuses: Vec::new(),
            pads: 0,
            missing: Missing::default(),
            rejected: BTreeMap::new(),
            refusals: None,
            last_frame: None,
            window: None,
            rate: 0.0,
            missed: [0, 0],
            rejected_at_window: 0,
            is_urgent: false,
        }
    }

    /// Counts a message that is no frame of this camera; the first of each kind goes to the log.
    pub(crate) fn reject(&mut self, reason: String, sink: &mut dyn Sink) {
        // A stream of ever different reasons must not fill the memory.
        let reason = if self.rejected.len() < 32 { reason } else { "other reasons".to_owned() };
        if !self.rejected.contains_key(&reason) {
            sink.log(Level::Error, &format!("frame dropped: {reason}"));
        }
        self.is_urgent |= self.rejected.values().sum::<u64>() == self.rejected_at_window;
        *self.rejected.entry(reason).or_default() += 1;
    }

    /// Counts a frame of this port that is another publisher's or of another time.
    pub(crate) fn refuse(&mut self, now: Steady, port: (&Interface, usize), why: Refusal, sink: &mut dyn Sink) {
        self.refusals.get_or_insert_default().tell_dropped(now, port, why, &mut self.health, sink);
        self.is_urgent = true;
    }

    /// Whether something has begun that nobody should hear of only when it is time.
    pub(crate) fn is_urgent(&self) -> bool {
        self.is_urgent
    }

    /// Of several cameras: how many frames did not come in time.
    pub(crate) fn cameras(&mut self, missing: u64) {
        self.health.value("camera", "frames not in time", missing);
    }

    /// The loop's delay by the turns that were seen, s.
    pub(crate) fn delay(&mut self, delay: f64, turns: usize) {
        self.health.value("robots", "loop delay, ms", format!("{:.1} by {turns} turns", 1e3 * delay));
    }

    /// Tells of every robot that was lost, found or became doubtful in this frame.
    pub(crate) fn frame(&mut self, at: Times, tracks: &[Track], pads: usize, stream: &Stream, sink: &mut dyn Sink) {
        self.last_frame = Some(at.steady);
        self.pads = pads;
        if let Some(text) = self.missing.look(at.steady, tracks, pads) {
            sink.log(Level::Warn, &text);
        }
        let before = std::mem::replace(&mut self.statuses, tracks.iter().map(|track| track.status).collect());
        for (index, track) in tracks.iter().enumerate() {
            let was = before.get(index).copied().unwrap_or(Status::Lost);
            let (level, text) = match (was, track.status) {
                (old, new) if old == new => continue,
                (_, Status::Lost) => (Level::Warn, "lost"),
                (_, Status::Ambiguous) => (Level::Warn, "seen, but it may be another robot"),
                (Status::Lost | Status::Ambiguous, _) => (Level::Info, "found"),
                _ => continue,
            };
            sink.log(level, &format!("{}: {text}", track.name));
        }
        if before != self.statuses {
            self.publish(at, tracks, stream, sink);
        }
    }

    /// Publishes the conditions if it is time or one has changed.
    pub(crate) fn publish(&mut self, at: Times, tracks: &[Track], stream: &Stream, sink: &mut dyn Sink) {
        self.is_urgent = false;
        self.measure_rate(at, stream);
        if let Some(refusals) = &mut self.refusals {
            refusals.settle(at.steady, &mut self.health);
        }
        let rejected: u64 = self.rejected.values().sum();
        let silent = self.last_frame.is_none_or(|last| at.steady.seconds_since(last) > SILENCE);
        let (condition, message) = match self.rejected.iter().max_by_key(|(_, count)| **count) {
            Some((reason, _)) if rejected > self.rejected_at_window => (Condition::Error, format!("dropped: {reason}")),
            _ if silent => (Condition::Error, "no frames".to_owned()),
            _ if self.missed[0] * MOST_MISSED > self.missed[1] => (Condition::Warn, too_many_missed(self.missed)),
            _ => (Condition::Ok, "frames arrive".to_owned()),
        };
        self.health.set("camera", condition, message);
        self.health.value("camera", "frames", stream.frames);
        self.health.value("camera", "frames per second", format!("{:.1}", self.rate));
        self.health.value("camera", "frames missed", stream.missed);
        self.health.value("camera", "frames out of order", stream.stale);
        self.health.value("camera", "frames dropped", rejected);

        let names = |status: Status| missing::names(tracks, |track| track.status == status);
        let (lost, doubtful) = (names(Status::Lost), names(Status::Ambiguous));
        let unseen = names(Status::Predicted);
        let (condition, message) = match (missing::shortage(tracks, self.pads), doubtful.is_empty()) {
            (Some(shortage), true) => (Condition::Warn, shortage),
            (Some(shortage), false) => (Condition::Error, format!("in doubt: {doubtful}; {shortage}")),
            (None, false) if lost.is_empty() => (Condition::Error, format!("in doubt: {doubtful}")),
            (None, false) => (Condition::Error, format!("in doubt: {doubtful}; lost: {lost}")),
            (None, true) if !lost.is_empty() => (Condition::Warn, format!("lost: {lost}")),
            (None, true) if !unseen.is_empty() => (Condition::Warn, format!("not seen: {unseen}")),
            (None, true) => (Condition::Ok, "all robots are seen".to_owned()),
        };
        self.health.value("robots", "pads", self.pads);
        self.health.set("robots", condition, message);
        self.health.publish(at, self.port, sink);
    }

    fn measure_rate(&mut self, at: Times, stream: &Stream) {
        match &self.window {
            None => self.window = Some((at.steady, stream.clone())),
            Some((start, before)) => {
                let elapsed = at.steady.seconds_since(*start);
                if elapsed >= 1.0 {
                    let taken = stream.frames.saturating_sub(before.frames);
                    let missed = stream.missed.saturating_sub(before.missed);
                    self.rate = taken as f64 / elapsed;
                    self.missed = [missed, missed + taken];
                    self.window = Some((at.steady, stream.clone()));
                    self.rejected_at_window = self.rejected.values().sum();
                }
            }
        }
    }
}

/// What to do about it: a frame is larger than what Linux lets a socket hold unless told otherwise, 208 KiB.
fn too_many_missed([missed, all]: [u64; 2]) -> String {
    format!(
        "{missed} of {all} frames missed: a camera over the network needs sockets that hold a frame \
         (sysctl -w net.core.rmem_max=4194304, here and there) or CompressedImage; one of this host, a faster host"
    )
}
