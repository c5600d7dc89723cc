//! Potential forces against what robots can do (9.2).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::laws::Capability;

const EQUATION: &str = "largest Phi' + Psi' + Psi_ob' <= acceleration (9.2, chapter 7 of docs/theory)";

/// The largest forces of a law, m/s^2: that of one robot ahead, that of one obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Largest {
    pub(crate) trench: f64,
    pub(crate) zones: f64,
    pub(crate) obstacles: f64,
    /// Robots ahead, and obstacles, that may act at once, of which (7.12) takes the sum; `usize::MAX` where nobody knows.
    pub(crate) at_once: [usize; 2],
}

impl Largest {
    fn all(&self) -> [f64; 3] {
        [self.trench, self.zones, self.obstacles]
    }

    fn sum(&self) -> f64 {
        self.all().iter().sum()
    }

    /// Whether more may act at once than one robot ahead and one obstacle, and add up to more than robots are able to.
    fn may_exceed(&self, able: f64) -> bool {
        let [robots, obstacles] = self.at_once.map(|count| count as f64);
        self.trench + robots * self.zones + obstacles * self.obstacles > able
    }

    fn text(&self) -> String {
        let [trench, zones, obstacles] = self.all().map(number);
        format!("trench {trench}, zones {zones}, obstacles {obstacles}")
    }
}

/// Whether the potential forces leave the stability argument whole when acceleration and speed are bounded: for a scenario, which claims it.
pub(crate) fn of_scenario(subject: &str, largest: &Largest, limits: &Capability) -> Verdict {
    let (forces, sum, able) = (largest.text(), number(largest.sum()), number(limits.acceleration));
    if !limits.fits(largest.all()) {
        let finding = format!(
            "{forces}: up to {sum} m/s^2, but robots have {able}: lower the trench or full_acceleration until they fit"
        );
        return Verdict::new("limits", subject, false, finding, EQUATION);
    }
    fitting(subject, largest, limits.acceleration, "")
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
        return fitting(subject, largest, acceleration, turned);
    }
    let alone = if largest.trench > acceleration {
        format!("; the trench alone is cut to {able}, which is a trench again")
    } else {
        String::new()
    };
    let finding = format!(
        "{forces}: up to {sum} m/s^2 by one robot ahead and one obstacle, robots have {able} (motion.acceleration): that V falls is proved only where what acts adds \
         up to no more{alone}; elsewhere limits may let V rise, arrival is measured and not proved, and the safety filter still keeps bodies \
         apart{turned}"
    );
    Verdict::noted("limits", subject, finding, EQUATION)
}

/// Forces of one robot ahead and of one obstacle fit: that is the whole claim where no more of them are, else a note says what it is not about.
fn fitting(subject: &str, largest: &Largest, able: f64, besides: &str) -> Verdict {
    let (forces, sum, limit) = (largest.text(), number(largest.sum()), number(able));
    let several = largest.may_exceed(able);
    let claim = if several {
        format!(
            "{sum} m/s^2 at most by one robot ahead and one obstacle, robots have {limit}; V' <= 0 within limits while no more than these act \
             at once. Several add up (7.12): beyond {limit} damping gives way first, then the trench, and V may rise"
        )
    } else {
        format!("{sum} m/s^2 at most, robots have {limit}; V' <= 0 within limits")
    };
    let finding = format!("{forces}: {claim}{besides}");
    Verdict { note: several || !besides.is_empty(), ..Verdict::new("limits", subject, true, finding, EQUATION) }
}
