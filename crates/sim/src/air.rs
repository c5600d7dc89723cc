//! Packets on their way between base station and robots.

use crate::fault::{Cuts, Intrusion};
use crate::intruder::Intruder;
use crate::medium::{Medium, MediumSetup, Way};
use std::collections::BTreeMap;
use std::sync::Arc;
use trench_optics::Pose2;

/// Who sends or hears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Station {
    Base,
    /// By index.
    Robot(usize),
}

/// A packet that arrives.
#[derive(Debug, Clone)]
pub(crate) struct Flying {
    /// Index of the robot that hears it; of the one that sent it, where the base station does.
    pub(crate) robot: usize,
    pub(crate) signal_dbm: i8,
    pub(crate) packet: Arc<[u8]>,
}

/// Packets of a time, by arrival, then by when they were sent.
type Flights = BTreeMap<(u64, u64), Flying>;

/// The air and what is in it.
#[derive(Debug, Clone)]
pub(crate) struct Air {
    medium: Medium,
    cuts: Cuts,
    intruder: Intruder,
    to_robots: Flights,
    to_base: Flights,
    sent: u64,
}

impl Air {
    /// `recorded`: whether somebody keeps all that the base station says.
    pub(crate) fn new(setup: MediumSetup, seed: u64, now: u64, recorded: bool) -> Self {
        let medium = Medium::new(setup, seed, now);
        Self {
            medium,
            cuts: Cuts::default(),
            intruder: Intruder::new(recorded),
            to_robots: Flights::new(),
            to_base: Flights::new(),
            sent: 0,
        }
    }

    /// The air becomes better or worse.
    pub(crate) fn set(&mut self, setup: MediumSetup, now: u64) {
        self.medium.set(setup, now);
    }

    /// Some do not hear each other from now on.
    pub(crate) fn cut(&mut self, cuts: Cuts) {
        self.cuts = cuts;
    }

    /// Somebody without a key does this from now on.
    pub(crate) fn intrude(&mut self, intrusion: Option<Intrusion>) {
        self.intruder.does = intrusion;
    }

    /// How well it carries.
    pub(crate) fn setup(&self) -> MediumSetup {
        *self.medium.setup()
    }

    /// A station sends a packet that is meant for the base station too, or for robots alone.
    pub(crate) fn send(&mut self, now: u64, from: Station, robots: &[Pose2], packet: &Arc<[u8]>, for_base: bool) {
        if let Station::Robot(robot) = from {
            if for_base {
                self.reach_base(now, robot, place(robots, robot), packet);
            }
            self.reach_robots(now, from, robots, packet);
            return;
        }
        let (packet, intruders) = self.intruder.disturb(now, packet);
        for packet in std::iter::once(packet).chain(intruders) {
            self.reach_robots(now, from, robots, &packet);
        }
    }

    // The air carries what nobody hears too: its chances do not depend on faults.

    fn reach_base(&mut self, now: u64, robot: usize, origin: [f64; 2], packet: &Arc<[u8]>) {
        let Some(arrival) = self.medium.carry(now, Way::Up, origin, self.medium.setup().antenna) else { return };
        if self.cuts.separates(Station::Robot(robot), Station::Base) {
            return;
        }
        self.sent += 1;
        let flying = Flying { robot, signal_dbm: arrival.signal_dbm, packet: Arc::clone(packet) };
        self.to_base.insert((arrival.at, self.sent), flying);
    }

    fn reach_robots(&mut self, now: u64, from: Station, robots: &[Pose2], packet: &Arc<[u8]>) {
        let (origin, way) = match from {
            Station::Base => (self.medium.setup().antenna, Way::Down),
            Station::Robot(robot) => (place(robots, robot), Way::Across),
        };
        for robot in (0..robots.len()).filter(|robot| from != Station::Robot(*robot)) {
            let Some(arrival) = self.medium.carry(now, way, origin, place(robots, robot)) else { continue };
            if self.cuts.separates(from, Station::Robot(robot)) {
                continue;
            }
            self.sent += 1;
            let flying = Flying { robot, signal_dbm: arrival.signal_dbm, packet: Arc::clone(packet) };
            self.to_robots.insert((arrival.at, self.sent), flying);
        }
    }

    /// When the next packet arrives at a robot, ns.
    pub(crate) fn next_at_robot(&self) -> Option<u64> {
        self.to_robots.keys().next().map(|(at, _)| *at)
    }

    /// When the next packet arrives at the base station, ns.
    pub(crate) fn next_at_base(&self) -> Option<u64> {
        self.to_base.keys().next().map(|(at, _)| *at)
    }

    /// Takes the next packet that arrives at a robot.
    pub(crate) fn pop_at_robot(&mut self) -> Option<Flying> {
        self.to_robots.pop_first().map(|(_, flying)| flying)
    }

    /// Takes the next packet that arrives at the base station.
    pub(crate) fn pop_at_base(&mut self) -> Option<Flying> {
        self.to_base.pop_first().map(|(_, flying)| flying)
    }
}

fn place(robots: &[Pose2], robot: usize) -> [f64; 2] {
    robots.get(robot).map_or([0.0; 2], |pose| [pose.x, pose.y])
}
