//! Noticing a local minimum.
use crate::Vector2;

/// When a robot counts as caught.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WatchSettings {
    /// It has stayed within this distance (m) of one place: wider than the bounces at an edge where the force jumps.
    pub radius: f64,
    /// For this time, s.
    pub patience: f64,
    /// And is farther than this from the point that draws it, m.
    pub arrived: f64,
}

/// Memory of one robot's progress. Who is near to what draws it has arrived; whether zones let it stay there is asked of another watch, with no
/// such point. Forces are not looked at: where they jump they never cancel, and a robot bounces about the
/// place where they change sign.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Watch {
    since: Option<(Vector2<f64>, f64)>,
}

impl Watch {
    /// Whether a robot at `position` at `time` (s) is caught. `deviation` (m) is the distance from the point that draws it, `repelled`
    /// whether anything pushes it away: a robot that rests without that waits for something else.
    pub fn is_caught(
        &mut self,
        settings: &WatchSettings,
        time: f64,
        position: Vector2<f64>,
        deviation: f64,
        repelled: bool,
    ) -> bool {
        let (anchor, since) = *self.since.get_or_insert((position, time));
        if deviation <= settings.arrived || (position - anchor).norm() > settings.radius {
            self.since = Some((position, time));
            return false;
        }
        repelled && time - since >= settings.patience
    }

    /// Starts anew, for instance once a remedy is in force.
    pub fn restart(&mut self) {
        self.since = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rest_is_not_arrival() {
        let settings = WatchSettings { radius: 0.1, patience: 1.0, arrived: 0.2 };
        let mut watch = Watch::default();
        let mut caught = |time: f64, x: f64, deviation: f64, repelled: bool| {
            watch.is_caught(&settings, time, Vector2::new(x, 0.0), deviation, repelled)
        };
        assert!(!caught(0.0, 0.0, 5.0, true));
        assert!(!caught(0.9, 0.05, 5.0, true));
        assert!(!caught(1.1, 0.05, 5.0, false), "nothing is in the way");
        assert!(caught(1.1, -0.05, 5.0, true));
        assert!(!caught(1.2, 0.3, 5.0, true), "it moves");
        assert!(!caught(2.1, 0.3, 5.0, true) && caught(2.2, 0.3, 5.0, true));
        assert!(!caught(2.3, 0.3, 0.1, true), "it is there");
    }
}
