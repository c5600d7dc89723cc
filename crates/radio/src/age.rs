//! How old a packet is, told by its counter.

/// What one step of a base station's counter stands for, ns: counters follow the host's clock.
pub const COUNTER_TICK: u64 = 1 << 20;

/// What a packet may take longer than the fastest without being late, ns: the host has subtracted it from the validity.
pub const USUAL_AGE: u64 = 20_000_000;

/// Clocks of host and robot may drift apart this fast, ns a second: 0.1 %.
const DRIFT: u64 = 1_000_000;

/// Measures how much longer than the fastest packet each packet took, without a common clock: the difference of the
/// robot's time and the counter is smallest for the fastest packet, and delays only make it larger.
#[derive(Debug, Clone, Copy, Default)]
pub struct AgeMeter {
    /// The smallest difference (ns) and when it was last brought up to date.
    fastest: Option<(i128, u64)>,
}

impl AgeMeter {
    /// The age (ns) of a packet with this counter that was received at `now` (ns of the robot's own clock), beyond that
    /// of the fastest packet so far. A sender whose counters leap ahead begins anew with age 0.
    pub fn age(&mut self, counter: u64, now: u64) -> u64 {
        let difference = i128::from(now) - i128::from(counter) * i128::from(COUNTER_TICK);
        let drifted = self.fastest.map(|(fastest, at)| {
            let seconds = i128::from(now.saturating_sub(at));
            fastest + seconds * i128::from(DRIFT) / 1_000_000_000
        });
        let fastest = drifted.map_or(difference, |drifted| drifted.min(difference));
        self.fastest = Some((fastest, now));
        u64::try_from(difference - fastest).unwrap_or(u64::MAX)
    }

    /// Forgets: the next packet's age is 0.
    pub fn reset(&mut self) {
        self.fastest = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    /// A packet of the host's time `sent` (ns) as its counter tells it.
    fn counter(sent: u64) -> u64 {
        sent / COUNTER_TICK + 5000
    }

    #[test]
    fn delays_beyond_the_shortest_are_age() {
        let mut meter = AgeMeter::default();
        for (sent, delay, expected) in [(0, 9, 0), (33, 5, 0), (66, 5, 0), (100, 45, 40), (133, 12, 7)] {
            let age = meter.age(counter(sent * MS), (7000 + sent + delay) * MS);
            assert!(age.abs_diff(expected * MS) <= 2 * COUNTER_TICK, "sent {sent}: {age}");
        }
    }

    #[test]
    fn drifting_clocks_are_followed() {
        let mut meter = AgeMeter::default();
        for second in 0..10_000 {
            // The robot's clock gains 200 us a second.
            let age = meter.age(counter(second * 1000 * MS), second * 1_000_200_000 + 50 * MS);
            assert!(age <= 2 * COUNTER_TICK, "{second}: {age}");
        }
    }

    #[test]
    fn counters_that_leap_ahead_begin_anew() {
        let mut meter = AgeMeter::default();
        assert_eq!(meter.age(1000, 0), 0);
        assert_eq!(meter.age(9000, MS), 0);
        assert!(meter.age(9001, 100 * MS) >= 97 * MS);
    }
}
