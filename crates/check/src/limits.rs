//! Potential forces against what robots can do (9.2).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::laws::Capability;

const EQUATION: &str = "largest Phi' + Psi' + Psi_ob' <= acceleration (9.2, chapter 7 of docs/theory)";

/// The largest forces of a law, and what may be had of them, m/s^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Largest {
    pub(crate) trench: f64,
    pub(crate) zones: f64,
    pub(crate) obstacles: f64,
}

impl Largest {
    fn all(&self) -> [f64; 3] {
        [self.trench, self.zones, self.obstacles]
    }

    fn sum(&self) -> f64 {
        self.all().iter().sum()
    }

    fn text(&self) -> String {
        let [trench, zones, obstacles] = self.all().map(number);
        format!("trench {trench}, zones {zones}, obstacles {obstacles}")
    }
}

/// Whether the potential forces leave the stability argument whole when acceleration and speed are bounded: for a scenario, which claims it.
pub(crate) fn of_scenario(subject: &str, largest: &Largest, limits: &Capability) -> Verdict {
    let (forces, sum, able) = (largest.text(), number(largest.sum()), number(limits.acceleration));
    let holds = limits.fits(largest.all());
    let finding = if holds {
        format!("{forces}: {sum} m/s^2 at most, robots have {able}; V' <= 0 within limits")
    } else {
        format!(
            "{forces}: up to {sum} m/s^2, but robots have {able}: lower the trench or full_acceleration until they fit"
        )
    };
    Verdict::new("limits", subject, holds, finding, EQUATION)
}

/// The same for a controller, which ends in the safety filter: where forces do not fit that is no fault, but the argument ends there.
pub(crate) fn of_controller(subject: &str, largest: &Largest, acceleration: f64, oblique: bool) -> Verdict {
    let (forces, sum, able) = (largest.text(), number(largest.sum()), number(acceleration));
    let fits = largest.sum() <= acceleration;
    let turned = if oblique {
        "; along a direction at an angle alpha to the segment the trench counts Phi'/sin alpha"
    } else {
        ""
    };
    if fits {
        let finding = format!("{forces}: {sum} m/s^2 at most, robots have {able}; V' <= 0 within limits{turned}");
        return match oblique {
            true => Verdict::noted("limits", subject, finding, EQUATION),
            false => Verdict::new("limits", subject, true, finding, EQUATION),
        };
    }
    let alone = if largest.trench > acceleration {
        format!("; the trench alone is cut to {able}, which is a trench again")
    } else {
        String::new()
    };
    let finding = format!(
        "{forces}: up to {sum} m/s^2 at once, robots have {able} (motion.acceleration): that V falls is proved only where what acts adds \
         up to no more{alone}; elsewhere limits may let V rise, arrival is measured and not proved, and the safety filter still keeps bodies \
         apart{turned}"
    );
    Verdict::noted("limits", subject, finding, EQUATION)
}
