//! One browser's way through a recording.

use crate::history::{REACH, STEP};
use crate::recording::Recorded;
use crate::{Recording, Role, Snapshot, View};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;
use trench_core::RosTime;

/// What counts as now, s: what topics that are said again and again have said by then, is the state.
const PRESENT: f64 = 5.0;
/// The rates a browser may ask for, times real time.
const RATES: std::ops::RangeInclusive<f64> = 0.05..=50.0;

/// What a browser asks for.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Command {
    /// Go on, or stand still.
    Play(bool),
    /// Jump, s since the beginning.
    Seek(f64),
    /// Times real time.
    Rate(f64),
}

/// Where a player stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Standing {
    /// s since the beginning.
    time: f64,
    duration: f64,
    playing: bool,
    rate: f64,
}

/// Plays a recording to one browser.
#[derive(Debug)]
pub struct Player {
    recording: Arc<Recording>,
    /// The part that says what kind of picture this is.
    setup: String,
    view: View,
    /// Index of the first message that is not taken yet.
    next: usize,
    standing: Standing,
    /// Whether the next snapshot begins anew.
    jumped: bool,
}

impl Player {
    /// At the beginning, playing. `setup` is the JSON of what kind of picture this is.
    #[must_use]
    pub fn new(recording: Arc<Recording>, setup: String) -> Self {
        let standing = Standing { time: 0.0, duration: recording.duration(), playing: true, rate: 1.0 };
        let mut player = Self { recording, setup, view: View::default(), next: 0, standing, jumped: true };
        player.seek(0.0);
        player
    }

    /// Does what the browser asks for; a number that is none changes nothing.
    pub fn obey(&mut self, command: Command) {
        match command {
            Command::Play(playing) => {
                // At the end, play means again.
                if playing && self.standing.time >= self.standing.duration {
                    self.seek(0.0);
                }
                self.standing.playing = playing;
            }
            Command::Seek(time) if time.is_finite() => self.seek(time),
            Command::Rate(rate) if rate.is_finite() => {
                self.standing.rate = rate.clamp(*RATES.start(), *RATES.end());
            }
            Command::Seek(_) | Command::Rate(_) => {}
        }
    }

    /// `elapsed` seconds of real time have passed.
    pub fn advance(&mut self, elapsed: f64) {
        if !self.standing.playing {
            return;
        }
        self.standing.time += elapsed.max(0.0) * self.standing.rate;
        if self.standing.time >= self.standing.duration {
            (self.standing.time, self.standing.playing) = (self.standing.duration, false);
        }
        self.take_until_now();
    }

    /// Whether time stands still until the browser says otherwise.
    #[must_use]
    pub fn rests(&self) -> bool {
        !self.standing.playing
    }

    /// The picture now, and whether the browser has to begin anew with it.
    pub fn snapshot(&mut self) -> (Snapshot, bool) {
        self.view.put("player", serde_json::json!(self.standing).to_string());
        let jumped = std::mem::take(&mut self.jumped);
        (self.view.snapshot(jumped), jumped)
    }

    fn now(&self) -> RosTime {
        self.recording.start().plus_seconds(self.standing.time)
    }

    fn take_until_now(&mut self) {
        let now = self.now();
        while let Some(message) = self.recording.get(self.next).filter(|message| message.time <= now) {
            self.view.take(message.time, message.role, message.cdr);
            self.next += 1;
        }
        self.view.advance(now);
    }

    /// A new picture: what lasts, a thin history, and all of the last seconds.
    fn seek(&mut self, time: f64) {
        self.standing.time = time.clamp(0.0, self.standing.duration);
        self.jumped = true;
        let now = self.now();
        self.view = View::default();
        self.view.put("setup", self.setup.clone());
        let recording = Arc::clone(&self.recording);
        let end = recording.until(now);
        let present = recording.until(now.plus_seconds(-PRESENT)).min(end);
        let mut last: BTreeMap<&Role, RosTime> = BTreeMap::new();
        let is_thin = |message: &Recorded<'_>, last: &BTreeMap<&Role, RosTime>| {
            let before = last.get(message.role);
            message.role.has_history() && before.is_none_or(|before| message.time.seconds_since(*before) >= STEP)
        };
        let old = recording.lasting(present).filter_map(|index| recording.get(index));
        old.for_each(|message| self.view.take(message.time, message.role, message.cdr));
        for index in recording.until(now.plus_seconds(-REACH))..end {
            let Some(message) = recording.get(index) else { break };
            if index >= present || is_thin(&message, &last) {
                last.insert(message.role, message.time);
                self.view.take(message.time, message.role, message.cdr);
            }
        }
        self.next = end;
        self.view.advance(now);
    }
}
