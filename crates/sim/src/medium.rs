//! The air between base station and robots: delay, loss, signal strength.

use crate::Random;
use trench_optics::Pose2;

/// How well the air carries packets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MediumSetup {
    /// Shortest delay of a packet, s.
    pub delay_min: f64,
    /// Longest delay, s; delays are uniform between the two.
    pub delay_max: f64,
    /// Probability that a receiver misses a packet.
    pub loss: f64,
}

impl MediumSetup {
    /// The test bed's: 3 to 8 ms, 3 %.
    pub const HONEST: Self = Self { delay_min: 0.003, delay_max: 0.008, loss: 0.03 };

    /// Carries everything at once.
    pub const IDEAL: Self = Self { delay_min: 0.0, delay_max: 0.0, loss: 0.0 };
}

/// A packet at its receiver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// When, ns.
    pub at: u64,
    /// How strong, dBm.
    pub signal_dbm: i8,
}

/// The air. Its antenna hangs above the field's corner at the origin.
#[derive(Debug, Clone)]
pub struct Medium {
    setup: MediumSetup,
    random: Random,
}

impl Medium {
    /// With losses and delays drawn from `random`.
    #[must_use]
    pub fn new(setup: MediumSetup, random: Random) -> Self {
        Self { setup, random }
    }

    /// Changes how well it carries from now on.
    pub fn set(&mut self, setup: MediumSetup) {
        self.setup = setup;
    }

    /// What becomes of a packet between the base station and a robot at `pose`, sent at `now`: nothing if it is lost.
    pub fn carry(&mut self, now: u64, pose: Pose2) -> Option<Arrival> {
        // All draws are made for every packet, so that one setting never shifts the chances of later packets.
        let delay = self.random.between(self.setup.delay_min, self.setup.delay_max);
        let fading = 2.0 * self.random.normal();
        let lost = self.random.chance(self.setup.loss);
        let distance = (pose.x * pose.x + pose.y * pose.y).sqrt().max(0.5);
        let signal = -45.0 - 20.0 * libm::log10(distance) + fading;
        let arrival = Arrival { at: now + (delay * 1e9) as u64, signal_dbm: signal as i8 };
        (!lost).then_some(arrival)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_and_losses_are_as_set() {
        let mut medium = Medium::new(MediumSetup::HONEST, Random::new(1, 1));
        let arrivals: Vec<Arrival> = (0..10_000).filter_map(|_| medium.carry(1000, Pose2::default())).collect();
        assert!((9650..9750).contains(&arrivals.len()), "{}", arrivals.len());
        assert!(arrivals.iter().all(|arrival| (3_001_000..8_001_000).contains(&arrival.at)));
        let mean = arrivals.iter().map(|arrival| f64::from(arrival.signal_dbm)).sum::<f64>() / arrivals.len() as f64;
        assert!((-40.0..-38.0).contains(&mean), "{mean}");
    }
}
