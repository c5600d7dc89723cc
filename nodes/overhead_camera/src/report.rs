//! What the camera says of itself on /diagnostics.

use trench_core::{Condition, Health, Level, Sink, Steady, Times};

/// Counts frames and faults.
pub(crate) struct Report {
    health: Health,
    port: usize,
    sent: u64,
    dropped: u64,
    /// Frames sent and when, at the start of the present second.
    window: Option<(Steady, u64)>,
    /// The present fault.
    fault: Option<String>,
}

const PART: &str = "camera";
/// How often conditions are published, s.
pub(crate) const PERIOD: f64 = 1.0;

impl Report {
    pub(crate) fn new(health: Health, port: usize) -> Self {
        let mut report = Self { health, port, sent: 0, dropped: 0, window: None, fault: None };
        report.health.set(PART, Condition::Warn, "no frame yet");
        report
    }

    /// A frame went out.
    pub(crate) fn sent(&mut self) {
        self.sent += 1;
        self.fault = None;
        self.health.set(PART, Condition::Ok, "frames are sent");
    }

    /// A frame was unusable.
    pub(crate) fn dropped(&mut self, reason: &str, sink: &mut dyn Sink) {
        self.dropped += 1;
        self.fault(reason, sink);
    }

    /// There are no frames, for this reason; said once in the log for as long as it stays the same.
    pub(crate) fn fault(&mut self, reason: &str, sink: &mut dyn Sink) {
        if self.fault.as_deref() != Some(reason) {
            sink.log(Level::Error, reason);
            self.fault = Some(reason.to_owned());
        }
        self.health.set(PART, Condition::Error, reason);
    }

    /// All frames are sent.
    pub(crate) fn ended(&mut self, sink: &mut dyn Sink) {
        sink.log(Level::Info, &format!("{} frames sent, {} dropped: the end", self.sent, self.dropped));
        self.health.set(PART, Condition::Ok, "all frames are sent");
    }

    /// Publishes the conditions if it is time or one has changed.
    pub(crate) fn publish(&mut self, at: Times, sink: &mut dyn Sink) {
        match self.window {
            None => self.window = Some((at.steady, self.sent)),
            Some((start, sent)) if at.steady.seconds_since(start) >= PERIOD => {
                let rate = self.sent.saturating_sub(sent) as f64 / at.steady.seconds_since(start);
                self.health.value(PART, "frames per second", format!("{rate:.1}"));
                self.window = Some((at.steady, self.sent));
            }
            Some(_) => {}
        }
        self.health.value(PART, "frames", self.sent);
        self.health.value(PART, "frames dropped", self.dropped);
        self.health.publish(at, self.port, sink);
    }
}
