//! The air between base station and robots: reach, delay, loss, signal strength, interference.

use crate::Random;
use crate::interference::{Bursts, Interference};

/// Share of the reach behind which losses grow, until nothing arrives at its end.
const EDGE: f64 = 0.9;

/// How well the air carries packets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MediumSetup {
    /// Shortest delay of a packet, s.
    pub delay_min: f64,
    /// Longest delay, s; delays are uniform between the two.
    pub delay_max: f64,
    /// Probability that a receiver misses a packet.
    pub loss: f64,
    /// Where the base station's antenna is, m.
    pub antenna: [f64; 2],
    /// How far robots hear the base station, m.
    pub reach_down: f64,
    /// How far the base station hears robots, m. Not the same: links may be asymmetric.
    pub reach_up: f64,
    /// How far robots hear one another (the thesis's rho_bar), m.
    pub reach_robots: f64,
    /// Interference.
    pub bursts: Bursts,
}

impl MediumSetup {
    /// The test bed's: 3 to 8 ms, 3 %, everybody in reach.
    pub const HONEST: Self = Self {
        delay_min: 0.003,
        delay_max: 0.008,
        loss: 0.03,
        antenna: [0.0, 0.0],
        reach_down: f64::INFINITY,
        reach_up: f64::INFINITY,
        reach_robots: f64::INFINITY,
        bursts: Bursts::NONE,
    };

    /// Carries everything at once.
    pub const IDEAL: Self = Self { delay_min: 0.0, delay_max: 0.0, loss: 0.0, ..Self::HONEST };
}

/// A packet at its receiver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// When, ns.
    pub at: u64,
    /// How strong, dBm.
    pub signal_dbm: i8,
}

/// Who speaks to whom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Base station to robot.
    Down,
    /// Robot to base station.
    Up,
    /// Robot to robot.
    Across,
}

/// The air.
#[derive(Debug, Clone)]
pub struct Medium {
    setup: MediumSetup,
    random: Random,
    /// Apart, so that the number of robots that listen to one another shifts no chance of the base station's.
    random_across: Random,
    interference: Interference,
}

impl Medium {
    /// From `now` (ns) on, all chance drawn from streams of `seed`.
    #[must_use]
    pub fn new(setup: MediumSetup, seed: u64, now: u64) -> Self {
        let interference = Interference::new(setup.bursts, Random::new(seed, 2), now);
        Self { setup, random: Random::new(seed, 1), random_across: Random::new(seed, 4), interference }
    }

    /// Changes how well it carries from `now` on.
    pub fn set(&mut self, setup: MediumSetup, now: u64) {
        self.interference.set(setup.bursts, now);
        self.setup = setup;
    }

    /// How well it carries.
    #[must_use]
    pub fn setup(&self) -> &MediumSetup {
        &self.setup
    }

    /// What becomes of a packet sent at `now` (which never goes back) from one place to another (m): nothing if it is
    /// lost.
    pub fn carry(&mut self, now: u64, way: Way, from: [f64; 2], to: [f64; 2]) -> Option<Arrival> {
        let (reach, random) = match way {
            Way::Down => (self.setup.reach_down, &mut self.random),
            Way::Up => (self.setup.reach_up, &mut self.random),
            Way::Across => (self.setup.reach_robots, &mut self.random_across),
        };
        // All draws are made for every packet, so that one setting never shifts the chances of later packets.
        let delay = random.between(self.setup.delay_min, self.setup.delay_max);
        let fading = 2.0 * random.normal();
        let luck = random.unit();
        let jammed = self.interference.jams(now);
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let distance = (x * x + y * y).sqrt();
        let lost = luck < self.loss(distance, reach);
        let signal = -45.0 - 20.0 * libm::log10(distance.max(0.5)) + fading;
        let arrival = Arrival { at: now + (delay * 1e9) as u64, signal_dbm: signal as i8 };
        (!lost && !jammed).then_some(arrival)
    }

    /// Rises from the usual one to 1 over the last part of the reach.
    fn loss(&self, distance: f64, reach: f64) -> f64 {
        let edge = EDGE * reach;
        if distance <= edge {
            return self.setup.loss;
        }
        let beyond = ((distance - edge) / (reach - edge)).min(1.0);
        // Written so that the end of the reach gives 1 exactly.
        1.0 - (1.0 - self.setup.loss) * (1.0 - beyond)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_and_losses_are_as_set() {
        let mut medium = Medium::new(MediumSetup::HONEST, 1, 0);
        let mut carry = || medium.carry(1000, Way::Down, [0.0, 0.0], [0.1, 0.1]);
        let arrivals: Vec<Arrival> = (0..10_000).filter_map(|_| carry()).collect();
        assert!((9650..9750).contains(&arrivals.len()), "{}", arrivals.len());
        assert!(arrivals.iter().all(|arrival| (3_001_000..8_001_000).contains(&arrival.at)));
        let mean = arrivals.iter().map(|arrival| f64::from(arrival.signal_dbm)).sum::<f64>() / arrivals.len() as f64;
        assert!((-40.0..-38.0).contains(&mean), "{mean}");
    }

    #[test]
    fn nothing_is_heard_beyond_the_reach() {
        let mut medium = Medium::new(MediumSetup { loss: 0.0, reach_up: 2.0, ..MediumSetup::HONEST }, 1, 0);
        let mut heard = |distance: f64| {
            let carried = (0..2000).filter_map(|_| medium.carry(0, Way::Up, [1.0, 1.0], [1.0, 1.0 + distance]));
            carried.count() as f64 / 2000.0
        };
        assert_eq!(heard(1.79), 1.0);
        assert!((0.45..0.55).contains(&heard(1.9)));
        assert_eq!(heard(2.0), 0.0);
        assert_eq!(heard(3.0), 0.0);
    }

    #[test]
    fn a_burst_takes_everything() {
        let bursts = Bursts { every: 1e-9, length: f64::INFINITY };
        let mut medium = Medium::new(MediumSetup { bursts, ..MediumSetup::IDEAL }, 1, 0);
        assert_eq!(medium.carry(1_000_000, Way::Across, [0.0; 2], [0.0; 2]), None);
    }
}
