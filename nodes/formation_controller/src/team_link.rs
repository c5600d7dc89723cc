//! The team link: over it leader states go from robot to robot. On the test bed, where all controllers hear each other, the
//! robots' radios say who would; on the robots' own hosts what arrives is what was heard.

use crate::inputs::Heard;
use trench_core::Steady;

/// What the robot's radio reported counts for this long, s; a report comes every 100 ms.
const REPORT: f64 = 1.0;

/// A robot has found its team again when it has heard somebody for this long, s.
const FOUND: f64 = 0.5;

/// Whom the robot hears.
#[derive(Debug, Clone, Default)]
pub(crate) struct TeamLink {
    /// The robots that its radio hears.
    radio: Option<Heard<Vec<String>>>,
    lost: bool,
    /// Since when what is heard speaks against `lost`.
    contrary_since: Option<Steady>,
}

impl TeamLink {
    /// Takes what the radio reports.
    pub(crate) fn report(&mut self, now: Steady, hears: Vec<String>) {
        self.radio = Some(Heard { at: now, message: hears });
    }

    /// Whether what `robot` says reaches this one. Nothing is held back while the radio is silent itself: then the command
    /// link is down, and the robot stands.
    pub(crate) fn carries(&self, now: Steady, robot: &str) -> bool {
        let fresh = self.radio.as_ref().filter(|report| now.seconds_since(report.at) <= REPORT);
        fresh.is_none_or(|report| report.message.iter().any(|heard| heard == robot))
    }

    /// Whether the robot has lost its team: for `patience` seconds it has heard nobody, and since then nobody for long.
    pub(crate) fn lost(&mut self, now: Steady, hears_somebody: bool, patience: f64) -> bool {
        if hears_somebody != self.lost {
            self.contrary_since = None;
            return self.lost;
        }
        let since = *self.contrary_since.get_or_insert(now);
        let needed = if self.lost { FOUND } else { patience };
        if now.seconds_since(since) >= needed {
            (self.lost, self.contrary_since) = (!self.lost, None);
        }
        self.lost
    }

    /// The robot rests: whether it has lost its team is asked anew when it drives again.
    pub(crate) fn rest(&mut self) {
        (self.lost, self.contrary_since) = (false, None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(tenths: u64) -> Steady {
        Steady(tenths * 100_000_000)
    }

    #[test]
    fn the_radio_s_reach_decides_as_long_as_it_is_known() {
        let mut link = TeamLink::default();
        assert!(link.carries(at(0), "robot2"), "nothing is known of the radio");
        link.report(at(0), vec!["robot2".to_owned()]);
        assert!(link.carries(at(5), "robot2") && !link.carries(at(5), "robot3"));
        assert!(link.carries(at(11), "robot3"), "the report is old");
    }

    #[test]
    fn a_team_is_lost_after_a_while_and_found_after_another() {
        let mut link = TeamLink::default();
        let told: Vec<bool> = (0..30).map(|tenths| link.lost(at(tenths), !(5..17).contains(&tenths), 1.0)).collect();
        let expected: Vec<bool> = (0..30).map(|tenths| (15..22).contains(&tenths)).collect();
        assert_eq!(told, expected, "silent from 0.5 s to 1.7 s");
        let mut link = TeamLink::default();
        assert!((0..30).all(|tenths| !link.lost(at(tenths), tenths % 9 == 0, 1.0)), "now and then is enough");
    }
}
