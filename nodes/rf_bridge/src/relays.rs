//! Which robots pass packets on to those that do not hear the base station (1.2: "with assistance from its neighbours").

use crate::core::RfBridge;
use trench_core::Steady;
use trench_radio::{MAX_RELAYS, RelayList, Relaying, RobotSet, Telemetry};

/// A robot's own voice counts for this long, and its link must be bad for this long before it gets a relay, s.
const PATIENCE: f64 = 0.5;

/// It keeps its relay for so long after its link was last bad, s.
const HOLD: f64 = 2.0;

/// How a robot and the base station hear each other without relays.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Reach {
    heard_directly: Option<Steady>,
    bad_since: Option<Steady>,
    needy_until: Option<Steady>,
}

impl Reach {
    /// A report came, relayed so often.
    pub(crate) fn heard(&mut self, now: Steady, relayed: u8) {
        if relayed == 0 {
            self.heard_directly = Some(now);
        }
    }

    /// Whether the robot needs a relay, judged by its last report.
    pub(crate) fn needs_relay(&mut self, now: Steady, report: Option<&Telemetry>) -> bool {
        let up = self.heard_directly.is_some_and(|at| now.seconds_since(at) <= PATIENCE);
        let down = report.is_some_and(|report| report.last_relayed == 0 && report.last_age_ms < u8::MAX);
        if up && down {
            self.bad_since = None;
        } else if now.seconds_since(*self.bad_since.get_or_insert(now)) >= PATIENCE {
            self.needy_until = Some(now.plus_seconds(HOLD));
        }
        self.needy_until.is_some_and(|until| now < until)
    }
}

/// A robot's id, whether it needs a relay, and whom it hears.
pub(crate) type Member = (u8, bool, RobotSet);

/// At most [`MAX_RELAYS`] robots that reach as many of those in need as can be reached: time and again the one through
/// which most are won, of equal ones one that was a relay before, then the lowest id. Robots that were won can be relays
/// for others. Whoever hears a robot is taken to be heard by it.
pub(crate) fn choose(team: &[Member], before: RelayList) -> RelayList {
    let mut needy: Vec<Member> = team.iter().copied().filter(|(_, needy, _)| *needy).collect();
    let mut reached: Vec<Member> = team.iter().copied().filter(|(_, needy, _)| !needy).collect();
    let mut chosen = Vec::new();
    while chosen.len() < MAX_RELAYS && !needy.is_empty() {
        let hear_each_other = |a: &Member, b: &Member| -> bool { a.2.contains(b.0) || b.2.contains(a.0) };
        let won = |relay: &Member| needy.iter().filter(|robot| hear_each_other(relay, robot)).count();
        let candidates = reached.iter().filter(|relay| !chosen.contains(&relay.0));
        let rank = |relay: &&Member| (won(relay), before.place(relay.0).is_some(), std::cmp::Reverse(relay.0));
        let Some(best) = candidates.max_by_key(rank).copied().filter(|best| won(best) > 0) else { break };
        chosen.push(best.0);
        let (gained, left) = needy.into_iter().partition(|robot| hear_each_other(&best, robot));
        reached.extend::<Vec<Member>>(gained);
        needy = left;
    }
    RelayList::new(&chosen)
}

impl RfBridge {
    /// Who passes the next packet on.
    pub(crate) fn relaying(&mut self, now: Steady) -> Relaying {
        if !self.tuning.relays {
            return Relaying::Direct;
        }
        let silence = self.tuning.silence;
        let team: Vec<Member> = self
            .robots
            .iter_mut()
            .map(|robot| {
                let report = robot.monitor.report().filter(|_| robot.monitor.up(now, silence));
                let needy = robot.reach.needs_relay(now, report);
                (robot.id, needy, report.map_or(RobotSet::default(), |report| report.neighbours))
            })
            .collect();
        self.relays = choose(&team, self.relays);
        Relaying::by(self.relays)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(robots: &[u8]) -> RobotSet {
        RobotSet(robots.iter().map(|id| 1 << id).sum())
    }

    #[test]
    fn relays_reach_as_many_as_they_can() {
        let check = |team: &[(u8, bool, &[u8])], before: &[u8], expected: &[u8]| {
            let team: Vec<Member> = team.iter().map(|(id, needy, hears)| (*id, *needy, set(hears))).collect();
            assert_eq!(choose(&team, RelayList::new(before)).as_slice(), expected, "{team:?}");
        };
        check(&[], &[], &[]);
        check(&[(1, false, &[2]), (2, false, &[1])], &[1], &[]);
        // Nobody hears robot 3.
        check(&[(1, false, &[2]), (2, false, &[1]), (3, true, &[])], &[], &[]);
        check(&[(1, false, &[2]), (2, false, &[1, 3]), (3, true, &[])], &[], &[2]);
        check(&[(1, false, &[3]), (2, false, &[3]), (3, true, &[])], &[], &[1]);
        check(&[(1, false, &[3]), (2, false, &[3]), (3, true, &[])], &[2], &[2]);
        // One that wins two is better than one that wins one.
        check(&[(1, false, &[3]), (2, false, &[3, 4]), (3, true, &[]), (4, true, &[])], &[], &[2]);
        // A line: 1 reaches 2, which reaches 3, which reaches 4, which reaches 5; three are the most.
        let line: [(u8, bool, &[u8]); 5] =
            [(1, false, &[2]), (2, true, &[1, 3]), (3, true, &[]), (4, true, &[3, 5]), (5, true, &[])];
        check(&line, &[], &[1, 2, 3]);
    }

    #[test]
    fn a_link_must_be_bad_for_a_while_and_good_for_longer() {
        let mut reach = Reach::default();
        let at = |tenths: u64| Steady(tenths * 100_000_000);
        let good = Telemetry { last_age_ms: 20, ..Telemetry::default() };
        let relayed = Telemetry { last_relayed: 1, ..good };
        reach.heard(at(0), 0);
        assert!(!reach.needs_relay(at(0), Some(&good)));
        assert!(!reach.needs_relay(at(4), Some(&relayed)));
        reach.heard(at(5), 0);
        assert!(!reach.needs_relay(at(5), Some(&good)), "a moment is forgiven");
        assert!(!reach.needs_relay(at(6), Some(&relayed)));
        assert!(reach.needs_relay(at(11), Some(&relayed)), "it hears through others alone");
        reach.heard(at(12), 0);
        assert!(reach.needs_relay(at(12), Some(&good)));
        reach.heard(at(32), 0);
        assert!(!reach.needs_relay(at(32), Some(&good)));
        reach.heard(at(40), 1);
        assert!(!reach.needs_relay(at(40), Some(&good)));
        assert!(reach.needs_relay(at(46), Some(&good)), "it is heard through others alone");
    }
}
