//! What a robot's firmware does for others: hears them, and passes on what they cannot hear.

use trench_radio::{
    Freshness, MAX_ROBOTS, Packet, Payload, RELAY_SLOT, RelayList, Relaying, RobotSet, relayed_once_more,
};

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
}

impl Relay {
    pub(crate) fn new(id: u8) -> Self {
        Self { id, heard: [None; MAX_ROBOTS], reports: [Freshness::default(); MAX_ROBOTS], named: None }
    }

    /// A packet of the base that was new.
    pub(crate) fn pass_down(&mut self, now: u64, packet: &Packet, bytes: &[u8]) -> Option<Relayed> {
        let Relaying::By(list) = packet.relaying else { return None };
        let place = RelayList::place(&list, self.id)?;
        self.named = Some((place, now));
        (packet.relayed < packet.relaying.limit()).then(|| Self::relayed(place, bytes, false))
    }

    /// A report of another robot.
    pub(crate) fn pass_up(&mut self, now: u64, packet: &Packet, bytes: &[u8], authentic: bool) -> Option<Relayed> {
        let Payload::Telemetry(report) = packet.payload else { return None };
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

    fn relayed(place: usize, bytes: &[u8], for_base: bool) -> Relayed {
        Relayed { after: place as u64 * RELAY_SLOT, for_base, packet: relayed_once_more(bytes) }
    }
}
