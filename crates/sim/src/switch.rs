//! A robot with its switch: its firmware begins anew whenever it is switched on.

use crate::firmware::{Firmware, Sensors};
use crate::{Random, Relayed, Wheel};
use trench_radio::{Key, Wheels};

/// Streams of a seed for the numbers that robots draw, one a robot.
const NONCES: u64 = 1 << 32;

/// How a robot's switch is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Switched {
    Off,
    /// With this id.
    On(u8),
}

/// A robot of the test bed.
#[derive(Debug, Clone)]
pub(crate) struct Robot {
    id: u8,
    key: Option<Key>,
    nonces: Random,
    state: Switched,
    firmware: Firmware,
    /// Steps that the wheels had made when it was switched on: it counts from there. Made by each wheel, and lost by both.
    before: ([f64; 2], f64),
}

impl Robot {
    /// Switched on at `start`, ns.
    pub(crate) fn new(id: u8, key: Option<Key>, start: u64, nonces: u64) -> Self {
        let mut nonces = Random::new(nonces, NONCES + u64::from(id));
        let firmware = Firmware::new(id, key.clone(), start, drawn(&mut nonces));
        Self { id, key, nonces, state: Switched::On(id), firmware, before: ([0.0; 2], 0.0) }
    }

    /// The id that is its own.
    pub(crate) fn own_id(&self) -> u8 {
        self.id
    }

    /// Somebody may have used its switch, or changed its id, which counts when it is switched on.
    pub(crate) fn switch(&mut self, state: Switched, now: u64, wheels: [Wheel; 2]) {
        if std::mem::replace(&mut self.state, state) == state {
            return;
        }
        if let Switched::On(id) = state {
            self.firmware = Firmware::new(id, self.key.clone(), now, drawn(&mut self.nonces));
            self.before = counted(wheels);
        }
    }

    /// Steps told since it was switched on, and lost.
    pub(crate) fn counted(&self, wheels: [Wheel; 2]) -> ([f64; 2], f64) {
        let ([left, right], lost) = counted(wheels);
        let ([left_before, right_before], lost_before) = self.before;
        ([left - left_before, right - right_before], lost - lost_before)
    }

    /// What its motors are told.
    pub(crate) fn wheels(&mut self, now: u64) -> Wheels {
        if self.is_off() { Wheels::STOP } else { self.firmware.wheels(now) }
    }

    /// Its radio hears a packet.
    pub(crate) fn receive(&mut self, now: u64, bytes: &[u8], signal_dbm: i8) -> Option<Relayed> {
        if self.is_off() { None } else { self.firmware.receive(now, bytes, signal_dbm) }
    }

    /// What it would say in its slot; nobody hears who is off.
    pub(crate) fn report(&mut self, now: u64, sensors: Sensors, out: &mut Vec<u8>) {
        self.firmware.report(now, sensors, out);
    }

    /// Whether it may send on what it hears.
    pub(crate) fn is_relay(&self, now: u64) -> bool {
        !self.is_off() && self.firmware.is_relay(now)
    }

    fn is_off(&self) -> bool {
        self.state == Switched::Off
    }
}

fn counted(wheels: [Wheel; 2]) -> ([f64; 2], f64) {
    (wheels.map(|wheel| wheel.steps), wheels[0].lost + wheels[1].lost)
}

/// A stream that is like none before.
fn drawn(nonces: &mut Random) -> Random {
    Random::new(nonces.number(), NONCES)
}
