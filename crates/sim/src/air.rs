//! Packets on their way between base station and robots.

use crate::fault::Cuts;
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
    to_robots: Flights,
    to_base: Flights,
    sent: u64,
}

impl Air {
    pub(crate) fn new(setup: MediumSetup, seed: u64, now: u64) -> Self {
        let medium = Medium::new(setup, seed, now);
        Self { medium, cuts: Cuts::default(), to_robots: Flights::new(), to_base: Flights::new(), sent: 0 }
    }

    /// The air becomes better or worse.
    pub(crate) fn set(&mut self, setup: MediumSetup, now: u64) {
        self.medium.set(setup, now);
    }

    /// Some do not hear each other from now on.
    pub(crate) fn cut(&mut self, cuts: Cuts) {
        self.cuts = cuts;
    }

    /// How well it carries.
    pub(crate) fn setup(&self) -> MediumSetup {
        *self.medium.setup()
    }

    /// A station sends a packet that is meant for the base station too, or for robots alone.
    pub(crate) fn send(&mut self, now: u64, from: Station, robots: &[Pose2], packet: &Arc<[u8]>, for_base: bool) {
        let place = |robot: usize| robots.get(robot).map_or([0.0; 2], |pose| [pose.x, pose.y]);
        let antenna = self.medium.setup().antenna;
        let (origin, way) = match from {
            Station::Base => (antenna, Way::Down),
            Station::Robot(robot) => (place(robot), Way::Across),
        };
        // The air carries what nobody hears too: its chances do not depend on faults.
        let silent = |robot: usize| self.cuts.silent.contains(&robot);
        if let Station::Robot(robot) = from
            && for_base
            && let Some(arrival) = self.medium.carry(now, Way::Up, origin, antenna)
            && !silent(robot)
        {
            self.sent += 1;
            let flying = Flying { robot, signal_dbm: arrival.signal_dbm, packet: Arc::clone(packet) };
            self.to_base.insert((arrival.at, self.sent), flying);
        }
        for robot in (0..robots.len()).filter(|robot| from != Station::Robot(*robot)) {
            let Some(arrival) = self.medium.carry(now, way, origin, place(robot)) else { continue };
            let cut = matches!(from, Station::Robot(from) if silent(from) || self.cuts.separates(from, robot));
            if cut || silent(robot) {
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
