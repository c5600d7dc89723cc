//! What the bridge says of itself on /diagnostics.

use crate::core::{NO_KEY, RfBridge};
use crate::robot::Robot;
use trench_core::{Condition, Steady};
use trench_radio::Fault;

/// A robot that has not been heard for so long is named, s: three of its reports. Its link is down only after `silence`.
const UNHEARD: f64 = 0.35;

/// The base station answers each packet: without any answer for so long, s, and three packets, it is not there.
const UNANSWERED: f64 = 0.3;

impl RfBridge {
    /// Brings all parts up to date.
    pub(crate) fn diagnose(&mut self, now: Steady) {
        let unanswered =
            self.answered.is_some_and(|last| now.seconds_since(last) > UNANSWERED.max(3.0 * self.tuning.heartbeat));
        let (condition, text) = match (self.open, unanswered) {
            (true, false) => (Condition::Ok, "open"),
            (true, true) => (Condition::Error, "open, but no base station answers: it may be off, or another device"),
            (false, _) => (Condition::Error, "closed: nothing reaches the robots"),
        };
        self.health.set("serial port", condition, text);
        self.health.value("serial port", "frames", self.decoder.frames());
        for (name, count) in self.decoder.errors().iter().chain(self.errors.iter()) {
            self.health.value("serial port", name, count);
        }
        let (condition, text) = self.of_commands(now);
        self.health.set("commands", condition, text);
        self.health.value("commands", "expired", self.robots.iter().map(|robot| robot.expired).sum::<u64>());
        let (condition, text) = self.of_links(now);
        self.health.set("links", condition, text);
        // A part of its own: another word on links that are bad already would wait.
        let (condition, text) =
            if self.channel.is_bad() { (Condition::Warn, "much is lost") } else { (Condition::Ok, "in order") };
        self.health.set("air", condition, text);
        let relays = self.robots.iter().filter(|robot| self.relays.place(robot.id).is_some());
        let relays: Vec<&str> = relays.map(|robot| robot.name.as_str()).collect();
        self.health.value("links", "relays", relays.join(", "));
        let key = if self.downlink.key().is_some() { "in force" } else { NO_KEY };
        self.health.value("links", "key", key);
        self.refusals.settle(now, &mut self.health);
    }

    fn of_commands(&self, now: Steady) -> (Condition, String) {
        if self.stop.active() {
            return (Condition::Error, "emergency stop: call ~/reset".to_owned());
        }
        if !self.driving(now) {
            return if self.stop.reached_for(now) {
                (Condition::Warn, "resting: a new publisher of /emergency_stop has not spoken yet".to_owned())
            } else {
                (Condition::Ok, "not running: commands are zero".to_owned())
            };
        }
        // A controller that rests says so in every command: silence is a controller that died or a network that is cut.
        let silent = self.named(|robot| !robot.expected(now));
        if silent.is_empty() {
            (Condition::Ok, "driving".to_owned())
        } else {
            (Condition::Warn, format!("nobody commands: {silent}"))
        }
    }

    fn of_links(&self, now: Steady) -> (Condition, String) {
        let reports =
            |robot: &Robot, fault: Fault| robot.monitor.report().is_some_and(|report| report.fault.0 & fault.0 != 0);
        let problems = [
            ("two radios answer as", self.named(|robot| robot.twins.are_two(now))),
            ("switched on anew:", self.named(|robot| robot.monitor.is_anew(now))),
            ("not heard:", self.named(|robot| !robot.monitor.up(now, UNHEARD.min(self.tuning.silence)))),
            ("low battery:", self.named(|robot| reports(robot, Fault::LOW_BATTERY))),
            ("missed steps:", self.named(|robot| reports(robot, Fault::MISSED_STEPS))),
            ("poor link:", self.named(|robot| robot.monitor.is_poor())),
            ("forged or spoilt packets at:", self.named(|robot| reports(robot, Fault::NOT_AUTHENTIC))),
            ("replayed packets at:", self.named(|robot| reports(robot, Fault::REPLAYED))),
        ];
        let named = problems.iter().filter(|(_, robots)| !robots.is_empty());
        let texts: Vec<String> = named.map(|(problem, robots)| format!("{problem} {robots}")).collect();
        match texts.as_slice() {
            [] => (Condition::Ok, "all robots are heard".to_owned()),
            // Of an error the next message tells at once; and such a robot is lost to the team.
            texts if self.robots.iter().any(|robot| robot.twins.are_two(now)) => (Condition::Error, texts.join("; ")),
            texts => (Condition::Warn, texts.join("; ")),
        }
    }

    fn named(&self, concerns: impl Fn(&Robot) -> bool) -> String {
        let robots: Vec<&str> =
            self.robots.iter().filter(|robot| concerns(robot)).map(|robot| robot.name.as_str()).collect();
        robots.join(", ")
    }
}
