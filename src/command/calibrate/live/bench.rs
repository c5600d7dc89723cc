//! The work itself: frames in, clicks in, limits and pictures out. Reads no clock and no socket.

use super::eye::{Eye, Seen};
use super::lessons::{Count, Lessons};
use super::shot::Shot;
use super::table::Message;
use serde_json::json;
use std::collections::VecDeque;
use trench_calibrate::Colours;
use trench_harness::vision::{Colour, Disc};
use trench_view::colours::Command;

/// A click may mean one of so many pictures: the newest ones.
const RECENT: usize = 4;
/// So many frames are learned from at once.
const FRAMES: u32 = 10;

/// What the work is for.
#[derive(Debug, Clone)]
pub(super) struct Names {
    /// By the lens file.
    pub(super) camera: String,
    pub(super) topic: String,
    pub(super) out: String,
    pub(super) localizer: String,
}

/// What the person is told.
#[derive(Debug, Clone, Default)]
struct Note {
    /// good, or bad
    level: &'static str,
    text: String,
}

/// What is to be done that the work itself cannot do.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Task {
    /// Write this colour file.
    Save(String),
    /// Give the localizer what this colour file says.
    Apply(String),
}

pub(super) struct Bench {
    names: Names,
    eye: Eye,
    limits: Colours,
    lessons: Lessons,
    /// Frames to be learned from still.
    gathers: u32,
    recent: VecDeque<Shot>,
    seen: Seen,
    jpeg: Vec<u8>,
    overlay: Vec<u8>,
    held: bool,
    /// Frames a second.
    rate: f64,
    note: Note,
}

impl Bench {
    pub(super) fn new(names: Names, eye: Eye, limits: Colours) -> Self {
        let note = Note { level: "", text: format!("waiting for {}", names.topic) };
        Self {
            names,
            eye,
            limits,
            lessons: Lessons::default(),
            gathers: 0,
            recent: VecDeque::new(),
            seen: Seen::default(),
            jpeg: Vec::new(),
            overlay: Vec::new(),
            held: false,
            rate: 0.0,
            note,
        }
    }

    /// Whether the picture stands.
    pub(super) fn is_held(&self) -> bool {
        self.held
    }

    pub(super) fn told_rate(&mut self, rate: f64) {
        self.rate = rate;
    }

    /// Takes a frame, or what is wrong with it.
    pub(super) fn take(&mut self, number: u64, cdr: &[u8], compressed: bool) {
        match Shot::read(number, cdr, compressed, self.eye.size()) {
            Ok(shot) => {
                if self.recent.is_empty() {
                    self.tell("", "click into the middle of a yellow disc, then of a blue one");
                }
                self.recent.push_front(shot);
                self.recent.truncate(RECENT);
                self.look();
                self.gather();
            }
            Err(reason) => self.tell("bad", &format!("frame dropped: {reason}")),
        }
    }

    /// Looks anew at the newest picture.
    fn look(&mut self) {
        let Some(shot) = self.recent.front() else { return };
        self.seen = self.eye.look(shot);
        match (shot.jpeg(), shot.overlay(&self.seen.cover)) {
            (Ok(jpeg), Ok(overlay)) => (self.jpeg, self.overlay) = (jpeg, overlay),
            (Err(error), _) | (_, Err(error)) => self.tell("bad", &error.to_string()),
        }
    }

    /// Learns from a frame, if it was asked to.
    fn gather(&mut self) {
        if self.gathers == 0 {
            return;
        }
        self.gathers -= 1;
        if let Some(shot) = self.recent.front() {
            self.lessons.add(self.eye.found(&shot.picture, &self.seen.discs));
        }
        if self.gathers == 0 {
            self.learn();
        }
    }

    /// Does what the page asks for, or says what the caller must do.
    pub(super) fn obey(&mut self, command: Command) -> Option<Task> {
        match command {
            Command::Click { which, u, v, shot } => {
                let clicked = self.recent.iter().find(|one| one.number == shot);
                let samples = clicked.map(|one| self.eye.clicked(&one.picture, which, [u, v], &self.seen.discs));
                match samples {
                    Some(Some(samples)) => {
                        self.lessons.add(samples);
                        self.learn();
                    }
                    Some(None) => self.tell("bad", "this is too near to the edge of the picture"),
                    None => self.tell("bad", "the picture has gone on: hold it, then click"),
                }
            }
            Command::Undo => {
                self.lessons.take_back();
                self.learn();
            }
            Command::Gather if self.seen.discs.is_empty() => {
                self.tell("bad", "no disc is found yet: click on one of each colour");
            }
            Command::Gather => self.gathers = FRAMES,
            Command::Limits { yellow, blue, minimum } => {
                let (ratio, chroma) = (0.05..=2.0, 5.0..=510.0);
                if ratio.contains(&yellow) && ratio.contains(&blue) && chroma.contains(&minimum) {
                    self.limit(Colours { yellow, blue, minimum });
                }
            }
            Command::Hold(held) => self.held = held,
            Command::Save => return Some(Task::Save(self.limits.to_yaml(&self.names.camera))),
            Command::Apply => return Some(Task::Apply(self.limits.to_yaml(&self.names.camera))),
        }
        None
    }

    fn learn(&mut self) {
        let Count { yellow, blue } = self.lessons.count();
        match self.lessons.learn() {
            Some(Ok(limits)) => {
                self.limit(limits);
                let of = |colour| self.seen.discs.iter().filter(|disc| disc.colour == colour).count();
                let (yellows, blues) = (of(Colour::Yellow), of(Colour::Blue));
                let level = if yellows == blues { "good" } else { "" };
                self.tell(level, &format!("learned: {yellows} yellow and {blues} blue discs are found"));
            }
            Some(Err(error)) => self.tell("bad", &error.to_string()),
            None if yellow > 0 => self.tell("", "now click into the middle of a blue disc"),
            None if blue > 0 => self.tell("", "now click into the middle of a yellow disc"),
            None => self.tell("", "nothing is learned: click into the middle of a yellow disc"),
        }
    }

    fn limit(&mut self, limits: Colours) {
        self.limits = limits;
        self.eye.limit(&limits);
        self.look();
    }

    /// Tells the person something: `level` is good, bad, or nothing.
    pub(super) fn tell(&mut self, level: &'static str, text: &str) {
        self.note = Note { level, text: text.to_owned() };
    }

    /// What a browser gets: the lengths of header and picture (u32, little endian), the header as JSON, the picture as JPEG,
    /// what is covered as PNG.
    pub(super) fn message(&self) -> Message {
        // Colour (1 yellow, 2 blue), column, row, confidence.
        let disc =
            |disc: &Disc| (1 + u8::from(disc.colour == Colour::Blue), disc.centre.u, disc.centre.v, disc.confidence);
        let Names { camera, out, localizer, .. } = &self.names;
        let Count { yellow, blue } = self.lessons.count();
        let header = json!({
            "names": { "camera": camera, "out": out, "localizer": localizer },
            "shot": self.recent.front().map_or(0, |shot| shot.number),
            "size": self.eye.size(),
            "half": self.eye.half(),
            "discs": self.seen.discs.iter().map(disc).collect::<Vec<_>>(),
            "limits": [self.limits.yellow, self.limits.blue, self.limits.minimum],
            "lessons": { "yellow": yellow, "blue": blue },
            "gathers": self.gathers,
            "held": self.held,
            "rate": self.rate,
            "light": self.eye.light().gains(),
            "note": { "level": self.note.level, "text": self.note.text },
        });
        let header = header.to_string().into_bytes();
        let length = |part: &[u8]| (part.len() as u32).to_le_bytes();
        let lengths = [length(&header), length(&self.jpeg)].concat();
        [lengths.as_slice(), &header, &self.jpeg, &self.overlay].concat().into()
    }
}
