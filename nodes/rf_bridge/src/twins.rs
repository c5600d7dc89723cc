//! Whether two radios answer as one robot.
//!
//! One robot's counters go up, and so do those that it names as the last of ours that it accepted. Where of two reports the one
//! with the higher counter names an older packet of ours, no one robot can have sent both; nor two that differ under one
//! counter. This asks no clock: reports that are late, repeated, relayed or replayed keep their order, and so does a robot that is
//! switched off and on.

use std::collections::VecDeque;
use trench_core::Steady;
use trench_radio::Telemetry;

/// Reports are compared with those of this time before, s.
const COMPARED: f64 = 1.0;

/// One contradiction may be chance: a report names the lowest 16 bits of a counter only.
const ENOUGH: usize = 2;

/// After the last contradiction the robot is not trusted for so long, s: the other radio may be out of reach for a while.
const HOLD: f64 = 2.0;

#[derive(Debug, Clone, Copy)]
struct Seen {
    at: Steady,
    counter: u64,
    /// How many packets of ours went out before the one that it names.
    names: Option<u64>,
    report: Telemetry,
}

/// The reports under one id.
#[derive(Debug, Clone, Default)]
pub(crate) struct Twins {
    seen: VecDeque<Seen>,
    contradictions: VecDeque<Steady>,
    until: Option<Steady>,
}

impl Twins {
    /// A report came, be it new or not; `names`: how many packets of ours went out before the last one that it accepted.
    pub(crate) fn hear(&mut self, at: Steady, counter: u64, names: Option<u64>, report: &Telemetry) {
        let old = |then: Steady| at.seconds_since(then) > COMPARED;
        while self.seen.front().is_some_and(|seen| old(seen.at)) {
            self.seen.pop_front();
        }
        while self.contradictions.front().is_some_and(|then| old(*then)) {
            self.contradictions.pop_front();
        }
        let now = Seen { at, counter, names, report: *report };
        match self.seen.iter().position(|seen| contradict(seen, &now)) {
            // Neither counts any more: one report that is wrong contradicts once.
            Some(index) => {
                self.seen.remove(index);
                self.contradictions.push_back(at);
            }
            None => self.seen.push_back(now),
        }
        if self.contradictions.len() >= ENOUGH {
            self.until = Some(at.plus_seconds(HOLD));
        }
    }

    /// Whether two radios answer.
    pub(crate) fn are_two(&self, now: Steady) -> bool {
        self.until.is_some_and(|until| now < until)
    }
}

fn contradict(one: &Seen, other: &Seen) -> bool {
    let names = one.names.zip(other.names).map(|(one, other)| one.cmp(&other));
    match one.counter.cmp(&other.counter) {
        std::cmp::Ordering::Equal => one.report != other.report,
        order => names == Some(order.reverse()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reports as (ms, counter, named, steps), in the order in which they are heard: when two radios are first known of.
    fn known_at(reports: &[(u64, u64, Option<u64>, i32)]) -> Option<u64> {
        let mut twins = Twins::default();
        reports.iter().find_map(|(ms, counter, names, steps_left)| {
            let at = Steady(ms * 1_000_000);
            twins.hear(at, *counter, *names, &Telemetry { steps_left: *steps_left, ..Telemetry::default() });
            twins.are_two(at).then_some(*ms)
        })
    }

    /// One radio, its counters from `first` on: a report each 100 ms that names one of 3 packets sent meanwhile.
    fn radio(first: u64, begins: u64, rounds: u64) -> Vec<(u64, u64, Option<u64>, i32)> {
        (0..rounds).map(|k| (begins + 100 * k, first + k, Some((begins + 100 * k) / 33), k as i32)).collect()
    }

    #[test]
    fn two_radios_are_known_within_three_rounds() {
        for (counter, offset) in [(5000, 0), (5000, 3), (101, 0), (101, 3), (100, 0), (100, 3)] {
            let mut both = radio(100, 1000, 9);
            both.extend(
                radio(counter, 1000 + offset, 9)
                    .iter()
                    .map(|(at, counter, names, steps)| (*at, *counter, *names, steps + 7)),
            );
            both.sort_by_key(|report| report.0);
            let known = known_at(&both);
            assert!(known.is_some_and(|ms| ms <= 1210), "{counter} {offset}: {known:?}");
        }
    }

    #[test]
    fn one_radio_is_one_whatever_happens_on_its_way() {
        let life = radio(100, 1000, 9);
        assert_eq!(known_at(&life), None);
        // Switched on again: higher counters, at first without a packet that it names.
        let mut lives = life.clone();
        lives.extend([(2000, 900, None, 0), (2100, 901, Some(64), 0)]);
        lives.extend(radio(902, 2200, 9));
        assert_eq!(known_at(&lives), None);
        // Copies, and reports that somebody replays half a second later, or says in another order.
        let mut replayed = life.clone();
        replayed.extend(life.iter().map(|(at, counter, names, steps)| (at + 503, *counter, *names, *steps)));
        replayed.extend(life.iter().map(|(at, counter, names, steps)| (at + 4, *counter, *names, *steps)));
        replayed.sort_by_key(|report| report.0);
        assert_eq!(known_at(&replayed), None);
        replayed.reverse();
        assert_eq!(
            known_at(&replayed.iter().map(|report| (1000, report.1, report.2, report.3)).collect::<Vec<_>>()),
            None
        );
        // One that names what it cannot know, once.
        let mut once = life;
        once.insert(5, (1401, 50, Some(1000), 0));
        assert_eq!(known_at(&once), None);
    }
}
