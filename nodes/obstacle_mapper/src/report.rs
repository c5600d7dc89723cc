//! What the mapper tells people of its input.

use std::collections::BTreeSet;
use trench_core::{Condition, Health, Level, Sink, Steady};

/// Complaints are logged once each; different ones no more than these.
const MOST_KINDS: usize = 64;
/// Silence is logged once it has lasted so long, s: at the start everybody is silent for a moment.
const LASTING: f64 = 1.0;

/// Who must speak is silent.
struct Silence {
    what: String,
    since: Steady,
    logged: bool,
}

/// One kind of input: how often it was refused, and why last; and whether it stays away.
pub(crate) struct Report {
    part: &'static str,
    fine: &'static str,
    refused: u64,
    wrong: Option<String>,
    silence: Option<Silence>,
    said: BTreeSet<String>,
}

impl Report {
    /// For a part of /diagnostics.
    pub(crate) fn new(part: &'static str) -> Self {
        let fine = "nobody is waited for";
        Self { part, fine, refused: 0, wrong: None, silence: None, said: BTreeSet::new() }
    }

    /// Something cannot be used as it is. The log hears of each reason once.
    pub(crate) fn refuse(&mut self, what: &str, health: &mut Health, sink: &mut dyn Sink) {
        self.refused += 1;
        self.wrong = Some(what.to_owned());
        self.tell(health);
        self.say(what, sink);
    }

    /// What comes is used.
    pub(crate) fn accept(&mut self, message: &'static str, health: &mut Health) {
        (self.wrong, self.fine) = (None, message);
        self.tell(health);
    }

    /// Who must speak and does not, or nobody; whether that is somebody. The log hears of it once a silence.
    pub(crate) fn wait(&mut self, at: Steady, what: Option<String>, health: &mut Health, sink: &mut dyn Sink) -> bool {
        let before = self.silence.take();
        let Some(what) = what else {
            if before.is_some() {
                self.tell(health);
            }
            return false;
        };
        let (since, logged) = before.map_or((at, false), |silence| (silence.since, silence.logged));
        let lasts = at.seconds_since(since) >= LASTING;
        if lasts && !logged {
            self.say(&what, sink);
        }
        self.silence = Some(Silence { what, since, logged: logged || lasts });
        self.tell(health);
        true
    }

    fn tell(&self, health: &mut Health) {
        let (condition, message) = match (&self.silence, &self.wrong) {
            (Some(silence), Some(wrong)) => (Condition::Stale, format!("{}; {wrong}", silence.what)),
            (Some(silence), None) => (Condition::Stale, silence.what.clone()),
            (None, Some(wrong)) => (Condition::Error, wrong.clone()),
            (None, None) => (Condition::Ok, self.fine.to_owned()),
        };
        health.set(self.part, condition, message);
        if self.refused > 0 {
            health.value(self.part, "refused", self.refused);
        }
    }

    fn say(&mut self, what: &str, sink: &mut dyn Sink) {
        if self.said.len() < MOST_KINDS && self.said.insert(what.to_owned()) {
            sink.log(Level::Warn, what);
        }
    }
}
