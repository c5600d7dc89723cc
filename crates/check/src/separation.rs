//! How far apart two robots of a scenario must stand.

use crate::Verdict;
use crate::verdict::number;

const EQUATION: &str = "|x_i - x_j| >= 2 (R + margin) of any two robots' places; without bodies more than tolerance";
/// Of distances that are as long as they must be, m.
const ROUNDING: f64 = 1e-9;

/// What two robots need from one to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Needed {
    /// Bodies of R + margin (m) beside each other.
    Bodies(f64),
    /// Points that are told apart: farther from each other than the scenario's tolerance (m).
    Points(f64),
}

impl Needed {
    /// By the radius of bodies with their margin (m), where there are bodies.
    pub(crate) fn of(body: Option<f64>, tolerance: f64) -> Self {
        body.map_or(Self::Points(tolerance), Self::Bodies)
    }

    /// m.
    pub(crate) fn distance(self) -> f64 {
        match self {
            Self::Bodies(radius) => 2.0 * radius,
            Self::Points(tolerance) => tolerance,
        }
    }

    /// A distance that would do, for people.
    pub(crate) fn or_more(self) -> String {
        let text = number(self.distance());
        match self {
            Self::Bodies(_) => format!("{text} m or more"),
            Self::Points(_) => format!("more than {text} m"),
        }
    }

    pub(crate) fn is_met_by(self, distance: f64) -> bool {
        match self {
            Self::Bodies(_) => distance >= self.distance() - ROUNDING,
            Self::Points(tolerance) => distance > tolerance,
        }
    }
}

/// The two that come nearest to each other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Nearest {
    /// m.
    pub(crate) distance: f64,
    /// Who is how far from whom, for people: "places 1 and 2 are 3 m apart".
    pub(crate) finding: String,
    /// What would bring them apart.
    pub(crate) remedy: String,
}

/// Judges the two that come nearest to each other.
pub(crate) fn separation(subject: &str, needed: Needed, nearest: Nearest) -> Verdict {
    let Nearest { distance, finding, remedy } = nearest;
    let room = match needed {
        Needed::Bodies(radius) => {
            format!("two bodies of R + margin = {} m need {} m", number(radius), number(needed.distance()))
        }
        Needed::Points(tolerance) => {
            format!("robots that are not in one place need more than the tolerance of {} m", number(tolerance))
        }
    };
    let holds = needed.is_met_by(distance);
    let finding = if holds { format!("{finding}; {room}") } else { format!("{finding}, but {room}: {remedy}") };
    Verdict::new("separation", subject, holds, finding, EQUATION)
}
