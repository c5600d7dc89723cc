//! Somebody on the air who has no key: what a team must not obey.

use crate::fault::Intrusion;
use std::collections::VecDeque;
use std::sync::Arc;
use trench_radio::{COUNTER_TICK, Packet, Payload, WheelTimer, Wheels};

/// How old what it replays is, ns.
const REPLAY_AGE: u64 = 500_000_000;

/// Packets that it can keep: more than half an hour.
const MOST: usize = 1 << 16;

/// Listens to the base station and speaks after it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Intruder {
    pub(crate) does: Option<Intrusion>,
    heard: VecDeque<(u64, Arc<[u8]>)>,
    /// Whether it keeps all that the base station says, and what that is.
    records: bool,
    recorded: VecDeque<Arc<[u8]>>,
    count: usize,
}

impl Intruder {
    /// `records`: whether it keeps all that the base station says.
    pub(crate) fn new(records: bool) -> Self {
        Self { records, ..Self::default() }
    }

    /// What becomes of a packet of the base station, and what follows it.
    pub(crate) fn disturb(&mut self, now: u64, packet: &Arc<[u8]>) -> (Arc<[u8]>, Option<Arc<[u8]>>) {
        let untouched = Arc::clone(packet);
        self.count += 1;
        if self.records && self.recorded.len() < MOST && self.does != Some(Intrusion::Recorded) {
            self.recorded.push_back(Arc::clone(packet));
        }
        match self.does {
            None => {
                self.heard.clear();
                (untouched, None)
            }
            Some(Intrusion::Forged) => (untouched, forged(packet)),
            Some(Intrusion::Recorded) => {
                self.recorded.rotate_left(1.min(self.recorded.len()));
                (untouched, self.recorded.back().cloned())
            }
            Some(Intrusion::Corrupted) => {
                (if self.count.is_multiple_of(2) { self.spoilt(packet) } else { untouched }, None)
            }
            Some(Intrusion::Replayed) => {
                self.heard.push_back((now, Arc::clone(packet)));
                let old = self.heard.front().is_some_and(|(at, _)| now - at >= REPLAY_AGE);
                (untouched, if old { self.heard.pop_front().map(|(_, packet)| packet) } else { None })
            }
        }
    }

    /// One bit is another, each time a different one.
    fn spoilt(&self, packet: &[u8]) -> Arc<[u8]> {
        let mut packet = packet.to_vec();
        let bit = self.count * 7 % (8 * packet.len()).max(1);
        if let Some(byte) = packet.get_mut(bit / 8) {
            *byte ^= 1 << (bit % 8);
        }
        packet.into()
    }
}

/// Full speed ahead for all whom a packet commands, a minute newer than it: without the key there is no tag.
fn forged(packet: &[u8]) -> Option<Arc<[u8]>> {
    let mut packet = Packet::decode(packet, None).ok()?;
    let Payload::Commands(commands) = &mut packet.payload else { return None };
    let ahead = Wheels { left: WheelTimer::from_speed(0.29), right: WheelTimer::from_speed(0.29) };
    commands.wheels.iter_mut().flatten().for_each(|wheels| *wheels = ahead);
    packet.counter += 60_000_000_000 / COUNTER_TICK;
    let mut bytes = Vec::new();
    packet.encode(None, &mut bytes);
    Some(bytes.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_radio::{Commands, Key, Relaying};

    fn key() -> Key {
        Key::new([7; 16])
    }

    fn packet(counter: u64) -> Arc<[u8]> {
        let mut wheels = [None; trench_radio::MAX_ROBOTS];
        wheels[2] = Some(Wheels { left: WheelTimer::from_speed(0.05), right: WheelTimer::from_speed(0.1) });
        let payload = Payload::Commands(Commands { validity_ms: 80, wheels });
        let mut bytes = Vec::new();
        Packet { relayed: 0, relaying: Relaying::default(), counter, payload }.encode(Some(&key()), &mut bytes);
        bytes.into()
    }

    #[test]
    fn forges_what_only_robots_without_a_key_believe() {
        let mut intruder = Intruder { does: Some(Intrusion::Forged), ..Intruder::default() };
        let said = packet(5);
        let (heard, forged) = intruder.disturb(0, &said);
        assert_eq!(heard, said);
        let forged = forged.unwrap();
        assert!(Packet::decode(&forged, Some(&key())).is_err());
        let Payload::Commands(commands) = Packet::decode(&forged, None).unwrap().payload else { unreachable!() };
        assert_eq!(commands.wheels[2].unwrap().left, WheelTimer::from_speed(0.29));
    }

    #[test]
    fn replays_what_is_half_a_second_old() {
        let mut intruder = Intruder { does: Some(Intrusion::Replayed), ..Intruder::default() };
        let old = packet(5);
        assert_eq!(intruder.disturb(0, &old).1, None);
        assert_eq!(intruder.disturb(REPLAY_AGE - 1, &packet(6)).1, None);
        assert_eq!(intruder.disturb(REPLAY_AGE, &packet(7)).1, Some(old));
        intruder.does = None;
        assert_eq!(intruder.disturb(2 * REPLAY_AGE, &packet(8)), (packet(8), None));
    }

    #[test]
    fn plays_a_record_from_the_beginning_round_and_round() {
        let mut intruder = Intruder { records: true, ..Intruder::default() };
        assert!((1..4).all(|counter| intruder.disturb(0, &packet(counter)).1.is_none()));
        intruder.does = Some(Intrusion::Recorded);
        for counter in [1, 2, 3, 1] {
            assert_eq!(intruder.disturb(0, &packet(9)), (packet(9), Some(packet(counter))));
        }
    }

    #[test]
    fn spoils_every_second_packet() {
        let mut intruder = Intruder { does: Some(Intrusion::Corrupted), ..Intruder::default() };
        let said = packet(5);
        let spoilt = (0..100).filter(|_| intruder.disturb(0, &said).0 != said).count();
        assert_eq!(spoilt, 50);
    }
}
