//! Bytes from the base station to messages.

use crate::core::RfBridge;
use crate::interface::{BATTERY, LINK, ODOMETRY, RANGES, REPORTS};
use crate::report;
use trench_core::{Sink, Times};
use trench_radio::{LinkFrame, Packet, Payload, Telemetry};

impl RfBridge {
    pub(crate) fn hear(&mut self, at: Times, data: &[u8], sink: &mut dyn Sink) {
        let mut decoder = std::mem::take(&mut self.decoder);
        decoder.push(data, |frame| {
            if let LinkFrame::Uplink { packet, .. } = frame {
                self.hear_packet(at, packet, sink);
            }
        });
        self.decoder = decoder;
    }

    pub(crate) fn hear_packet(&mut self, at: Times, packet: &[u8], sink: &mut dyn Sink) {
        let key = self.downlink.key();
        let packet = match Packet::decode(packet, key) {
            Ok(packet) => packet,
            Err(error) => return self.errors.count(error.name()),
        };
        let authenticated = key.is_some();
        let Payload::Telemetry(telemetry) = packet.payload else { return self.errors.count("not_telemetry") };
        let Some(index) = self.robots.iter().position(|robot| robot.id == telemetry.robot) else {
            return self.errors.count("unknown_robot");
        };
        let sent = self.downlink.sent(telemetry.last_counter);
        let robot = &mut self.robots[index];
        if robot.monitor.accept(packet.counter, at.steady, authenticated).is_err() {
            return;
        }
        robot.reach.heard(at.steady, packet.relayed);
        robot.monitor.update(at, telemetry, packet.relayed, sent);
        robot.odometry.update(&telemetry, self.tuning.half_axle);
        self.report(at, index, &telemetry, sink);
    }

    pub(crate) fn report(&self, at: Times, index: usize, telemetry: &Telemetry, sink: &mut dyn Sink) {
        let (robot, first) = (&self.robots[index], self.first_port(index));
        sink.publish(first + BATTERY, &report::battery(at.ros, &robot.name, telemetry));
        sink.publish(first + ODOMETRY, &report::odometry(at.ros, &robot.name, &robot.odometry));
        sink.publish(first + LINK, &robot.monitor.status(at, &robot.name, self.tuning.silence));
        for (sensor, reading) in telemetry.ranges.as_slice().iter().enumerate().take(self.ranges) {
            sink.publish(first + RANGES + sensor, &report::range(at.ros, &robot.name, sensor, *reading));
        }
    }

    pub(crate) fn first_port(&self, index: usize) -> usize {
        REPORTS + index * (RANGES + self.ranges)
    }
}
