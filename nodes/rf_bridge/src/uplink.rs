//! Bytes from the base station to messages.

use crate::core::RfBridge;
use crate::interface::{BATTERY, LINK, ODOMETRY, RANGES, REPORTS};
use crate::report;
use trench_core::{Sink, Steady, Times};
use trench_radio::{Ack, AckStatus, LinkFrame, Packet, Payload, Telemetry};

impl RfBridge {
    pub(crate) fn hear(&mut self, at: Times, data: &[u8], sink: &mut dyn Sink) {
        let mut decoder = std::mem::take(&mut self.decoder);
        decoder.push(data, |frame| match frame {
            LinkFrame::Uplink { packet, .. } => self.hear_packet(at, packet, sink),
            LinkFrame::Ack(ack) => self.hear_answer(at.steady, ack),
            LinkFrame::Downlink { .. } => {}
        });
        self.decoder = decoder;
        self.miss(at);
    }

    /// The base station says what became of a packet.
    fn hear_answer(&mut self, now: Steady, ack: Ack) {
        self.answered = Some(now);
        match ack.status {
            AckStatus::Sent => {}
            AckStatus::Refused => self.errors.count("refused_by_the_base"),
            AckStatus::Expired => self.errors.count("expired_at_the_base"),
        }
    }

    /// Counts reports that did not come in their slots: what lies between the base station and the bridge has just been read.
    fn miss(&mut self, at: Times) {
        let since = self.channel.attentive_since();
        let missed = self.robots.iter_mut().map(|robot| robot.monitor.overdue(at.steady, since)).sum();
        if self.channel.hear(0, missed) {
            self.diagnose(at.steady);
        }
    }

    pub(crate) fn hear_packet(&mut self, at: Times, packet: &[u8], sink: &mut dyn Sink) {
        let key = self.downlink.key();
        let packet = match Packet::decode(packet, key) {
            Ok(packet) => packet,
            Err(error) => return self.errors.count(error.name()),
        };
        let authenticated = key.is_some();
        let Some(telemetry) = packet.payload.report().copied() else { return self.errors.count("not_telemetry") };
        let Some(index) = self.robots.iter().position(|robot| robot.id == telemetry.robot) else {
            return self.errors.count("unknown_robot");
        };
        // Who has been welcomed by nobody names no packet of ours.
        let nonce = if let Payload::Hello { nonce, .. } = packet.payload { Some(nonce) } else { None };
        let sent = self.downlink.sent(telemetry.last_counter).filter(|_| nonce.is_none());
        let robot = &mut self.robots[index];
        let (were_two, was_anew) = (robot.twins.are_two(at.steady), robot.monitor.is_anew(at.steady));
        let names = sent.filter(|_| telemetry.last_age_ms < u8::MAX).map(|sent| sent.before);
        robot.twins.hear(at.steady, packet.counter, names, &telemetry);
        let are_two = robot.twins.are_two(at.steady);
        let new = robot.monitor.accept(packet.counter, at.steady, authenticated).is_ok();
        let mut told = are_two != were_two;
        if new {
            robot.reach.heard(at.steady, packet.relayed);
            let (received, lost) = robot.monitor.update(at, telemetry, packet.relayed, sent);
            told |= robot.monitor.is_anew(at.steady) != was_anew;
            if !are_two {
                robot.odometry.update(&telemetry, self.tuning.half_axle);
                told |= self.channel.hear(received + 1, lost);
            }
        }
        if told {
            self.diagnose(at.steady);
        }
        if let Some(nonce) = nonce {
            self.greet(at, telemetry.robot, nonce, new, sink);
        }
        match (new, are_two) {
            (true, false) => self.report(at, index, &telemetry, sink),
            // Whose steps and ranges they are nobody knows.
            (true, true) => self.tell_link(at, index, sink),
            (false, _) => {}
        }
    }

    pub(crate) fn report(&self, at: Times, index: usize, telemetry: &Telemetry, sink: &mut dyn Sink) {
        let (robot, first) = (&self.robots[index], self.first_port(index));
        sink.publish(first + BATTERY, &report::battery(at.ros, &robot.name, telemetry));
        sink.publish(first + ODOMETRY, &report::odometry(at.ros, &robot.name, &robot.odometry));
        self.tell_link(at, index, sink);
        for (sensor, reading) in telemetry.ranges.as_slice().iter().enumerate().take(self.ranges) {
            sink.publish(first + RANGES + sensor, &report::range(at.ros, &robot.name, sensor, *reading));
        }
    }

    /// Tells how good the link to a robot is.
    fn tell_link(&self, at: Times, index: usize, sink: &mut dyn Sink) {
        let robot = &self.robots[index];
        // A robot that is not heard itself may hear anybody or nobody.
        let report = robot.monitor.report().filter(|_| robot.monitor.up(at.steady, self.tuning.silence));
        let neighbours = report.map(|report| report.neighbours).unwrap_or_default();
        let heard = self.robots.iter().filter(|other| neighbours.contains(other.id));
        let hears = heard.map(|other| other.name.clone()).collect();
        let mut status = robot.monitor.status(at, &robot.name, hears, self.tuning.silence);
        status.up &= !robot.twins.are_two(at.steady);
        sink.publish(self.first_port(index) + LINK, &status);
    }

    /// Says of robots that have fallen silent that they have: no report of theirs brings it.
    pub(crate) fn tell_silence(&mut self, at: Times, sink: &mut dyn Sink) {
        for index in 0..self.robots.len() {
            let robot = &mut self.robots[index];
            let up = robot.monitor.up(at.steady, self.tuning.silence);
            if std::mem::replace(&mut robot.was_up, up) && !up {
                self.tell_link(at, index, sink);
            }
        }
    }

    pub(crate) fn first_port(&self, index: usize) -> usize {
        REPORTS + index * (RANGES + self.ranges)
    }
}
