//! What the bridge says of itself on /diagnostics.

use crate::core::RfBridge;
use trench_core::{Condition, Steady};
use trench_radio::Fault;

/// A dropped message is worth a warning for this long, s.
const LATELY: f64 = 5.0;

impl RfBridge {
    /// Brings all parts up to date.
    pub(crate) fn diagnose(&mut self, now: Steady) {
        let (condition, text) =
            if self.open { (Condition::Ok, "open") } else { (Condition::Error, "closed: nothing reaches the robots") };
        self.health.set("serial port", condition, text);
        self.health.value("serial port", "frames", self.decoder.frames());
        for (name, count) in self.decoder.errors().iter().chain(self.errors.iter()) {
            self.health.value("serial port", name, count);
        }
        let (condition, text) = match (self.stop.active(), self.driving(now)) {
            (true, _) => (Condition::Error, "emergency stop: call ~/reset"),
            (false, false) if self.stop.reached_for(now) => {
                (Condition::Warn, "resting: a new publisher of /emergency_stop has not spoken yet")
            }
            (false, true) => (Condition::Ok, "driving"),
            (false, false) => (Condition::Ok, "not running: commands are zero"),
        };
        self.health.set("commands", condition, text);
        self.health.value("commands", "expired", self.robots.iter().map(|robot| robot.expired).sum::<u64>());
        let silent: Vec<&str> = self
            .robots
            .iter()
            .filter(|robot| !robot.monitor.up(now, self.tuning.silence))
            .map(|robot| robot.name.as_str())
            .collect();
        let weak: Vec<&str> = self
            .robots
            .iter()
            .filter(|robot| robot.monitor.report().is_some_and(|report| report.fault.0 & Fault::LOW_BATTERY.0 != 0))
            .map(|robot| robot.name.as_str())
            .collect();
        match (silent.is_empty(), weak.is_empty()) {
            (true, true) => self.health.set("links", Condition::Ok, "all robots are heard"),
            (false, _) => self.health.set("links", Condition::Warn, format!("not heard: {}", silent.join(", "))),
            (true, false) => self.health.set("links", Condition::Warn, format!("low battery: {}", weak.join(", "))),
        }
        let relays = self.robots.iter().filter(|robot| self.relays.place(robot.id).is_some());
        let relays: Vec<&str> = relays.map(|robot| robot.name.as_str()).collect();
        self.health.value("links", "relays", relays.join(", "));
        if self.refused_at.is_none_or(|at| now.seconds_since(at) > LATELY) {
            self.health.set("messages", Condition::Ok, "none was dropped lately");
        }
    }
}
