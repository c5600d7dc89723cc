//! What a robot's firmware does for others: hears them, and passes on what they cannot hear.

use trench_radio::{Freshness, MAX_ROBOTS, Packet, RELAY_SLOT, RelayList, Relaying, RobotSet, relayed_once_more};

/// Whom it heard this long ago is a neighbour, and for this long it stays a relay, ns.
const LATELY: u64 = 500_000_000;

/// A packet to be sent on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Relayed {
    /// How long the relay waits, so that relays speak one after the other, ns.
    pub after: u64,
    /// Whether it is for the base station (a report), not for robots.
    pub for_base: bool,
    /// As it goes over the air.
    pub packet: Vec<u8>,
}

/// The state of a relay.
#[derive(Debug, Clone)]
pub(crate) struct Relay {
    id: u8,
    /// When each robot's own voice was heard last, ns.
    heard: [Option<u64>; MAX_ROBOTS],
    /// Reports that were passed on.
    reports: [Freshness; MAX_ROBOTS],
    /// Its place in the last list that named it, and when that came.
    named: Option<(usize, u64)>,
    /// When the base named relays last, whoever they are.
    any_named: Option<u64>,
}

impl Relay {
    pub(crate) fn new(id: u8) -> Self {
        Self {
            id,
            heard: [None; MAX_ROBOTS],
            reports: [Freshness::default(); MAX_ROBOTS],
            named: None,
            any_named: None,
        }
    }

    /// A packet of the base that was new.
    pub(crate) fn pass_down(&mut self, now: u64, packet: &Packet, bytes: &[u8]) -> Option<Relayed> {
        let Relaying::By(list) = packet.relaying else { return None };
        self.any_named = Some(now);
        let place = RelayList::place(&list, self.id)?;
        self.named = Some((place, now));
        (packet.relayed < packet.relaying.limit()).then(|| Self::relayed(place, bytes, false))
    }

    /// A report of another robot.
    pub(crate) fn pass_up(&mut self, now: u64, packet: &Packet, bytes: &[u8], authentic: bool) -> Option<Relayed> {
        let report = packet.payload.report()?;
        let robot = usize::from(report.robot);
        if report.robot == self.id {
            return None;
        }
        if packet.relayed == 0 {
            *self.heard.get_mut(robot)? = Some(now);
        }
        let (place, _) = self.named.filter(|(_, at)| now.saturating_sub(*at) <= LATELY)?;
        let wanted = packet.relayed < packet.relaying.limit();
        let new = wanted && self.reports.get_mut(robot)?.accept(packet.counter, now, authentic).is_ok();
        new.then(|| Self::relayed(place, bytes, true))
    }

    /// Whose own voice was heard lately.
    pub(crate) fn neighbours(&self, now: u64) -> RobotSet {
        let lately = |at: &Option<u64>| at.is_some_and(|at| now.saturating_sub(at) <= LATELY);
        RobotSet(self.heard.iter().enumerate().map(|(id, at)| u32::from(lately(at)) << id).sum())
    }

    /// Whether reports that it hears may lead to something at the base station.
    pub(crate) fn is_relay(&self, now: u64) -> bool {
        self.named.is_some_and(|(_, at)| now.saturating_sub(at) <= LATELY)
    }

    /// Whether the base has lately wanted relays: it does not hear somebody, and who that is does not know it where it hears the base.
    pub(crate) fn are_wanted(&self, now: u64) -> bool {
        self.any_named.is_some_and(|at| now.saturating_sub(at) <= LATELY)
    }

    fn relayed(place: usize, bytes: &[u8], for_base: bool) -> Relayed {
        Relayed { after: place as u64 * RELAY_SLOT, for_base, packet: relayed_once_more(bytes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_radio::{Commands, Payload, Telemetry, Wheels};

    /// What a relay hears: `relayed` times on its way already, and to be relayed as `relaying` says.
    fn heard(relayed: u8, relaying: Relaying, payload: Payload) -> (Packet, Vec<u8>) {
        let packet = Packet { relayed, relaying, counter: 1, payload };
        let mut bytes = Vec::new();
        packet.encode(None, &mut bytes);
        (Packet::decode(&bytes, None).unwrap(), bytes)
    }

    fn hops(relayed: &Relayed) -> u8 {
        Packet::decode(&relayed.packet, None).unwrap().relayed
    }

    /// A list of n relays is a way of n hops at most, also for a copy that comes round in a circle.
    #[test]
    fn commands_go_as_many_hops_as_there_are_relays() {
        let mut commands = Commands { validity_ms: 80, ..Commands::default() };
        commands.wheels[4] = Some(Wheels::STOP);
        for count in 1..=3_u8 {
            let relaying = Relaying::by(RelayList::new(&[7, 8, 9][..usize::from(count)]));
            for relayed in 0..=15 {
                let (packet, bytes) = heard(relayed, relaying, Payload::Commands(commands));
                let passed = Relay::new(7).pass_down(0, &packet, &bytes);
                assert_eq!(
                    passed.as_ref().map(hops),
                    (relayed < count).then_some(relayed + 1),
                    "{count} relays, {relayed} hops"
                );
                assert_eq!(Relay::new(3).pass_down(0, &packet, &bytes), None, "it is not named");
            }
        }
    }

    #[test]
    fn reports_go_as_many_hops_as_they_may() {
        let report = Telemetry { robot: 4, ..Telemetry::default() };
        for limit in 1..=3_u8 {
            for relayed in 0..=15 {
                let (packet, bytes) = heard(relayed, Relaying::Anyone(limit), Payload::Telemetry(report));
                let mut relay = Relay::new(7);
                relay.named = Some((0, 0));
                let passed = relay.pass_up(1, &packet, &bytes, true);
                assert_eq!(
                    passed.as_ref().map(hops),
                    (relayed < limit).then_some(relayed + 1),
                    "limit {limit}, {relayed} hops"
                );
                assert_eq!(relay.pass_up(1, &packet, &bytes, true), None, "each report once");
            }
        }
    }
}
