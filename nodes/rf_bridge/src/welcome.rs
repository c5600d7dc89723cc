//! Welcomes for robots that were switched on: what they drew, said back under a counter that is new.

use crate::core::RfBridge;
use trench_core::{Sink, Steady, Times};
use trench_radio::{MAX_WELCOMED, Payload, RobotSet, Welcome};

/// What robots said that wait for a welcome.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hellos {
    /// Robot and nonce, by when they asked.
    waiting: Vec<(u8, u64)>,
    /// When those that found the line busy are answered.
    pub(crate) due: Option<Steady>,
}

impl Hellos {
    /// A robot asks. What it asked before, nobody need answer. A hello that is not `new` may be replayed: it does not take
    /// the place of one.
    fn hear(&mut self, robot: u8, nonce: u64, new: bool) {
        match self.waiting.iter_mut().find(|(id, _)| *id == robot) {
            Some(before) if new => before.1 = nonce,
            Some(_) => {}
            None => self.waiting.push((robot, nonce)),
        }
    }

    /// Takes the next ones.
    fn take(&mut self) -> Option<Welcome> {
        let count = self.waiting.len().min(MAX_WELCOMED);
        let next: Vec<(u8, u64)> = self.waiting.drain(..count).collect();
        (count > 0).then(|| Welcome::new(&next))
    }
}

impl RfBridge {
    /// A robot that was switched on asks for the counter.
    pub(crate) fn greet(&mut self, at: Times, robot: u8, nonce: u64, new: bool, sink: &mut dyn Sink) {
        // Without a key nobody would believe the answer.
        if self.downlink.key().is_some() {
            self.hellos.hear(robot, nonce, new);
            self.welcome(at, sink);
        }
    }

    /// Answers those who wait, once the line is free: commands never wait behind more than one answer.
    pub(crate) fn welcome(&mut self, at: Times, sink: &mut dyn Sink) {
        self.hellos.due = None;
        let free_at = self.downlink.free_at();
        if !self.open {
            self.hellos = Hellos::default();
        } else if free_at > at.steady {
            self.hellos.due = Some(free_at);
        } else if let Some(welcome) = self.hellos.take() {
            self.transmit(at, Payload::Welcome(welcome), sink);
            if self.stop.active() {
                self.transmit(at, Payload::EmergencyStop(RobotSet::ALL), sink);
            }
            self.hellos.due = (!self.hellos.waiting.is_empty()).then(|| self.downlink.free_at());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_robot_is_answered_once_with_its_newest_nonce() {
        let mut hellos = Hellos::default();
        for robot in 0..6 {
            hellos.hear(robot, u64::from(robot), true);
        }
        hellos.hear(2, 72, true);
        hellos.hear(2, 99, false);
        hellos.hear(9, 79, false);
        let mut taken = || hellos.take().map(|welcome| welcome.as_slice().to_vec());
        assert_eq!(taken(), Some(vec![(0, 0), (1, 1), (2, 72), (3, 3)]));
        assert_eq!(taken(), Some(vec![(4, 4), (5, 5), (9, 79)]));
        assert_eq!(taken(), None);
    }
}
