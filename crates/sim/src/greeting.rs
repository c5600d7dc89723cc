//! How a robot that was switched on finds out what is new: it draws a number and asks the base to say it back.
//!
//! What was recorded before names none of its numbers, and what is held back names one that is too old: until it hears an
//! answer it obeys nothing.

use crate::Random;
use trench_radio::{Packet, Payload};

/// Answers to this many hellos, the last ones, count: 200 ms.
const ANSWERS: usize = 2;

/// What a packet of the base is to a robot that has not been welcomed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Heard {
    /// It may be old.
    Nothing,
    /// An emergency stop. It may be old too, but stopping is safe.
    Stop,
    /// The answer. With the counter of an emergency stop that was heard before and is newer.
    Welcome(Option<u64>),
}

/// A robot that has not been welcomed.
#[derive(Debug, Clone)]
pub(crate) struct Greeting {
    id: u8,
    nonces: Random,
    said: [Option<u64>; ANSWERS],
    stopped: Option<u64>,
}

impl Greeting {
    /// Its numbers come from `nonces`; a robot's own firmware takes noise that nobody else can know.
    pub(crate) fn new(id: u8, nonces: Random) -> Self {
        Self { id, nonces, said: [None; ANSWERS], stopped: None }
    }

    /// The number of the next hello.
    pub(crate) fn draw(&mut self) -> u64 {
        let nonce = self.nonces.number();
        self.said.rotate_right(1);
        self.said[0] = Some(nonce);
        nonce
    }

    /// An authentic packet of the base.
    pub(crate) fn hear(&mut self, packet: &Packet) -> Heard {
        match packet.payload {
            Payload::Welcome(welcome)
                if welcome.nonce(self.id).is_some_and(|nonce| self.said.contains(&Some(nonce))) =>
            {
                Heard::Welcome(self.stopped.filter(|counter| *counter > packet.counter))
            }
            Payload::EmergencyStop(robots) if robots.contains(self.id) => {
                self.stopped = self.stopped.max(Some(packet.counter));
                Heard::Stop
            }
            _ => Heard::Nothing,
        }
    }
}
