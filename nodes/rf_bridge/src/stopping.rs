//! Emergency stop and reset towards the robots: said again until they confirm.

use crate::core::RfBridge;
use crate::robot::Robot;
use trench_core::{Level, Sink, Times};
use trench_msgs::std_srvs::TriggerResponse;
use trench_radio::{Fault, Payload, RobotSet};

/// Stop and reset packets are repeated at this interval, s.
const REPEAT: f64 = 0.05;

/// A reset is repeated to robots that do not confirm it for this long, s.
const RESET_PATIENCE: f64 = 2.0;

impl RfBridge {
    pub(crate) fn begin_stop(&mut self, at: Times, sink: &mut dyn Sink) {
        sink.log(Level::Warn, "emergency stop");
        self.reset_until = None;
        // The file may have to wait for a disk, the robots not.
        self.repeat(at, sink);
        self.checkpoint(sink);
        self.diagnose(at.steady);
    }

    /// Says stop, or reset, again.
    pub(crate) fn repeat(&mut self, at: Times, sink: &mut dyn Sink) {
        let payload = if self.stop.active() {
            self.robots.iter_mut().for_each(Robot::halt);
            Some(Payload::EmergencyStop(RobotSet::ALL))
        } else {
            self.reset_until.filter(|until| at.steady < *until).and_then(|_| self.unconfirmed()).map(Payload::Reset)
        };
        self.repeat_at = payload.map(|_| at.steady.plus_seconds(REPEAT));
        if let Some(payload) = payload
            && self.open
        {
            self.transmit(at, payload, sink);
        }
    }

    /// The robots that do not say that their stop is over.
    pub(crate) fn unconfirmed(&self) -> Option<RobotSet> {
        let stopped = |robot: &&Robot| robot.monitor.report().is_none_or(|r| r.fault.has(Fault::EMERGENCY_STOP));
        let set = self.robots.iter().filter(stopped).map(|robot| 1 << robot.id).sum();
        (set != 0).then_some(RobotSet(set))
    }

    pub(crate) fn reset(&mut self, at: Times, sink: &mut dyn Sink) -> TriggerResponse {
        match self.stop.reset(at.steady) {
            Ok(()) => {
                sink.log(Level::Info, "the emergency stop is over");
                self.reset_until = Some(at.steady.plus_seconds(RESET_PATIENCE));
                self.checkpoint(sink);
                // Once to all: a robot's last report may be older than its stop.
                let everybody = self.robots.iter().map(|robot| 1 << robot.id).sum();
                if self.open {
                    self.transmit(at, Payload::Reset(RobotSet(everybody)), sink);
                }
                self.repeat_at = Some(at.steady.plus_seconds(REPEAT));
                self.diagnose(at.steady);
                TriggerResponse { success: true, message: "the robots obey commands again".to_owned() }
            }
            Err(reason) => TriggerResponse { success: false, message: reason.to_owned() },
        }
    }
}
