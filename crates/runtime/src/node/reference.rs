//! A node whose ROS time is another host's clock, and the node on that host that tells it.

use super::connect::Connections;
use super::{Node, NodeWake, Wake};
use crate::clock::{steady_now, wall_now};
use crate::reference::{Estimate, Exchange, Offset, Questions};
use crate::transport::TransportError;
use crate::transport::network::{Gid, NetworkWriter, ServiceClient, ServiceServer, TopicName};
use std::collections::BTreeSet;
use trench_core::{Condition, Level, Qos, RosTime, Sink, Steady};
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use trench_msgs::msg::{ExchangeTime, ExchangeTimeRequest, ExchangeTimeResponse};
use trench_msgs::std_msgs::Header;
use trench_msgs::{Encode, Message, service_info};

/// The serving end, for `node`.
pub(super) fn server(
    node: &str,
    index: usize,
    to: &mut Connections<'_>,
) -> Result<Box<dyn ServiceServer>, TransportError> {
    let mut server = to.network.server(node, &format!("{node}/{EXCHANGE}"), service_info::<ExchangeTime>())?;
    to.register(Wake::Node(index, NodeWake::ClockQuestions), server.as_mut())?;
    Ok(server)
}

/// ns: what a pose may be off by without a robot being so: 10 ms at 0.3 m/s are 3 mm.
const GOOD_BOUND: i64 = 10_000_000;

/// The service that tells a node's time, below its name.
const EXCHANGE: &str = "exchange_time";

/// The clock that this node goes by.
pub(super) struct ClockReference {
    of: String,
    /// This host's name.
    host: String,
    service: Box<dyn ServiceClient>,
    diagnostics: Box<dyn NetworkWriter>,
    estimate: Estimate,
    questions: Questions,
}

impl ClockReference {
    /// Goes by the clock of the node with the full name `of`.
    pub(super) fn open(of: &str, node: &str, index: usize, to: &mut Connections<'_>) -> Result<Self, TransportError> {
        let mut service = to.network.client(node, &format!("{of}/{EXCHANGE}"), service_info::<ExchangeTime>())?;
        to.register(Wake::Node(index, NodeWake::ClockAnswers), service.as_mut())?;
        let name = TopicName::new("/diagnostics", DiagnosticArray::TYPE);
        let diagnostics = to.network.writer(node, &name, Qos::RELIABLE)?;
        let (estimate, of) = (Estimate::default(), of.to_owned());
        // Without a name it is still a host.
        let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default().trim().to_owned();
        Ok(Self { of, host, service, diagnostics, estimate, questions: Questions::default() })
    }

    pub(super) fn next(&self) -> Steady {
        self.questions.next()
    }

    pub(super) fn readers_changed(&mut self, writer: &Gid, readers: &BTreeSet<Gid>) {
        self.service.readers_changed(writer, readers);
    }

    pub(super) fn writers_changed(&mut self, reader: &Gid, writers: usize) {
        self.service.writers_changed(reader, writers);
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(super) fn flush(&mut self) -> bool {
        self.service.flush() & self.diagnostics.flush()
    }

    /// Asks if it is time to; true if it is.
    fn ask(&mut self, now: Steady) -> bool {
        let good = self.estimate.at(now).is_some_and(|known| known.bound <= GOOD_BOUND);
        if !self.questions.are_due(now, good) {
            return false;
        }
        if self.service.is_ready()
            && let Ok(count) = self.service.call(ExchangeTimeRequest::default().to_cdr().into())
        {
            self.questions.ask(count, now);
        }
        true
    }

    /// Takes what was answered. Whether the other clock was set meanwhile, or what cannot be read.
    fn hear(&mut self, now: impl Fn() -> Steady) -> Result<bool, String> {
        self.service.clear_wakeup();
        let mut was_set = false;
        while let Some(taken) = self.service.take() {
            let (count, cdr) = taken?;
            let back = now();
            let Some(asked) = self.questions.answer(count) else { continue };
            let answer = ExchangeTimeResponse::decode(&cdr).map_err(|error| error.to_string())?;
            let (heard, answered) = (RosTime::from(&answer.received), RosTime::from(&answer.sent));
            was_set |= !self.estimate.add(Exchange { asked, heard, answered, back });
        }
        Ok(was_set)
    }

    /// Says on /diagnostics how far the host's clocks are apart.
    fn report(&mut self, node: &str, stamp: RosTime) {
        // Both clocks of this host at once: whoever waits for the processor in between is wrong by no more than that.
        let (before, own, now) = (steady_now(), wall_now(), steady_now());
        let apart = i64::try_from(now.0.saturating_sub(before.0)).unwrap_or(i64::MAX);
        let wider = |known: Offset| Offset { bound: known.bound.saturating_add(apart), ..known };
        let known = self.estimate.at(now).map(wider);
        let status = DiagnosticStatus {
            level: condition(known) as u8,
            name: format!("{node}: clock"),
            message: message(&self.of, known),
            hardware_id: self.host.clone(),
            values: known.map_or_else(Vec::new, |known| values(known, own, now)),
        };
        let header = Header { stamp: stamp.into(), ..Header::default() };
        let _congested = self.diagnostics.write(DiagnosticArray { header, status: vec![status] }.to_cdr().into());
    }
}

fn condition(known: Option<Offset>) -> Condition {
    match known {
        None => Condition::Error,
        Some(known) if known.bound > GOOD_BOUND => Condition::Warn,
        Some(_) => Condition::Ok,
    }
}

fn message(of: &str, known: Option<Offset>) -> String {
    match known {
        None => format!("the clock of {of} is not known yet: ROS time stands at zero"),
        Some(known) => format!("goes by the clock of {of}, known to {:.3} ms", known.bound as f64 * 1e-6),
    }
}

fn values(known: Offset, own: RosTime, now: Steady) -> Vec<KeyValue> {
    let reference = i64::try_from(now.0).unwrap_or(i64::MAX).saturating_add(known.offset);
    let value = |key: &str, nanoseconds: i64| KeyValue {
        key: key.to_owned(),
        value: format!("{:.6}", nanoseconds as f64 * 1e-9),
    };
    vec![value("offset of this host's clock, s", own.0.saturating_sub(reference)), value("known to, s", known.bound)]
}

impl Node {
    /// Asks the other clock, if this node goes by one and it is time to.
    pub(super) fn ask_clock(&mut self, now: Steady) {
        let Some(reference) = &mut self.reference else { return };
        if reference.ask(now) {
            let stamp = self.ports.clock.now().ros;
            reference.report(&self.full_name, stamp);
        }
    }

    /// Sends what waits for the clocks; true when nothing waits any longer.
    pub(super) fn flush_clock(&mut self) -> bool {
        self.reference.as_mut().is_none_or(ClockReference::flush)
            & self.time_server.as_mut().is_none_or(|server| server.flush())
    }

    /// Takes the other clock's answers.
    pub(super) fn take_clock_answers(&mut self) {
        let Some(reference) = &mut self.reference else { return };
        let heard = reference.hear(steady_now);
        let known = reference.estimate.at(steady_now());
        let of = reference.of.clone();
        if let Some(known) = known {
            self.ports.clock.refer(known.latest());
        }
        match heard {
            Ok(false) => {}
            Ok(true) => self.ports.log(Level::Warn, &format!("the clock of {of} was set: this node follows")),
            Err(problem) => self.ports.warn(&format!("{of}/{EXCHANGE}: {problem}")),
        }
    }

    /// Tells this node's time to whoever asks.
    pub(super) fn take_clock_questions(&mut self) {
        let Some(server) = &mut self.time_server else { return };
        server.clear_wakeup();
        while let Some(taken) = server.take() {
            let received = self.ports.clock.now().ros.into();
            match taken {
                Ok((request, _)) => {
                    let response = ExchangeTimeResponse { received, sent: self.ports.clock.now().ros.into() };
                    let _not_sent = server.respond(request, response.to_cdr().into());
                }
                Err(problem) => self.ports.warn(&problem),
            }
        }
    }
}
