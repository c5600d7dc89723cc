//! Commands to frames: one broadcast a camera frame, nothing old, nothing while not running.

use crate::core::RfBridge;
use crate::robot::{Order, Robot};
use trench_core::{Sink, Steady, Times};
use trench_radio::{Commands, Payload, USUAL_AGE, Wheels};

impl RfBridge {
    pub(crate) fn driving(&self, now: Steady) -> bool {
        !self.stop.active() && !self.stop.reached_for(now) && (self.run.is_running() || !self.tuning.needs_run_state)
    }

    /// A command came in: send at once if it was the last of its camera frame, else wait a moment for the others.
    pub(crate) fn gather(&mut self, at: Times, sink: &mut dyn Sink) {
        if !self.driving(at.steady) {
            let turning = self.turning(at.steady);
            self.halt_but(turning);
            if turning.is_none() {
                return;
            }
        }
        let mut stamps = self.robots.iter().filter(|robot| robot.expected(at.steady)).map(Robot::waiting);
        let first = stamps.next().flatten();
        let complete = first.is_some() && stamps.all(|stamp| stamp == first);
        let due = if complete { at.steady } else { at.steady.plus_seconds(self.tuning.gather) };
        // A busy line makes no frame wait behind another: the newest commands go out when it is free.
        let due = due.max(self.downlink.free_at());
        self.gathered_at = Some(self.gathered_at.map_or(due, |earlier| earlier.min(due)));
        if self.gathered_at.is_some_and(|due| due <= at.steady) {
            self.broadcast(at, sink);
        }
    }

    /// Sends one frame that tells every robot what it needs to be told.
    pub(crate) fn broadcast(&mut self, at: Times, sink: &mut dyn Sink) {
        self.gathered_at = None;
        self.heartbeat_at = at.steady.plus_seconds(self.tuning.heartbeat);
        if !self.open {
            self.robots.iter_mut().for_each(Robot::halt);
            return;
        }
        if !self.driving(at.steady) {
            let turning = self.turning(at.steady);
            self.halt_but(turning);
        }
        // Robots count as age what a packet takes beyond the usual, so that alone is subtracted here.
        let line = self.downlink.duration(self.robots.len()).max(USUAL_AGE as f64 * 1e-9);
        let (mut commands, mut validity) = (Commands::default(), self.tuning.frame_age);
        for robot in &mut self.robots {
            // Whose place is known is not who drives: both stand.
            if robot.twins.are_two(at.steady) {
                robot.halt();
            }
            let slot = &mut commands.wheels[usize::from(robot.id)];
            match robot.order(at.steady, line, &self.tuning) {
                Order::Drive(wheels, left) => {
                    *slot = Some(wheels);
                    validity = validity.min(left);
                }
                Order::Stop => *slot = Some(Wheels::STOP),
                Order::Silence => continue,
            }
            robot.monitor.sent += 1;
        }
        commands.validity_ms = (validity * 1e3) as u8;
        self.transmit(at, Payload::Commands(commands), sink);
    }

    pub(crate) fn transmit(&mut self, at: Times, payload: Payload, sink: &mut dyn Sink) {
        if self.downlink.extend_promise(at.steady) {
            self.checkpoint(sink);
        }
        let relaying = self.relaying(at.steady);
        self.downlink.send(at.steady, relaying, payload, sink);
    }

    pub(crate) fn checkpoint(&self, sink: &mut dyn Sink) {
        let mut bytes = self.downlink.promised().to_le_bytes().to_vec();
        bytes.push(u8::from(self.stop.active()));
        bytes.extend(self.stop.said_stop().flatten());
        sink.checkpoint(&bytes);
    }

    /// Everybody stands still, now.
    pub(crate) fn halt(&mut self, at: Times, sink: &mut dyn Sink) {
        self.robots.iter_mut().for_each(Robot::halt);
        self.broadcast(at, sink);
    }
}
