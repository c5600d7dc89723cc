//! Directions of attraction (6.3).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::Vector2;
use trench_formation::curve::Placed;

pub(crate) const EQUATION: &str =
    "the segment's projection across the direction reaches v0 |cos theta| / k beyond the robot (6.3)";

/// A robot that is about to approach a segment along a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// m, frame `map`.
    pub position: Vector2<f64>,
    /// m/s.
    pub velocity: Vector2<f64>,
    /// y_a, not zero.
    pub direction: Vector2<f64>,
    /// k, 1/s.
    pub damping: f64,
}

/// What a robot's way and the segment reach across a direction of attraction, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Across {
    /// Of the segment: least and greatest.
    pub(crate) segment: (f64, f64),
    /// Of the robot's way.
    pub(crate) way: (f64, f64),
}

impl Across {
    /// Nothing for directions without length and damping that is not positive.
    pub(crate) fn of(segment: &Placed<'_>, approach: &Approach) -> Option<Self> {
        let (along, size) = (approach.direction, approach.direction.norm());
        if !(size.is_finite() && size > 0.0 && approach.damping > 0.0) {
            return None;
        }
        let across = Vector2::new(along.y, -along.x) / size;
        let (start, drift) = (approach.position.dot(&across), approach.velocity.dot(&across) / approach.damping);
        Some(Self { segment: segment.extent(across), way: (start.min(start + drift), start.max(start + drift)) })
    }

    /// How far the way keeps from the ends of the segment, m; negative where it passes one.
    pub(crate) fn spare(&self) -> f64 {
        (self.way.0 - self.segment.0).min(self.segment.1 - self.way.1)
    }

    /// "across the direction the robot keeps to [0, 1] m", "the segment spans [0, 2]": for people.
    fn texts(&self) -> [String; 2] {
        [self.segment, self.way].map(|(low, high)| format!("[{}, {}] m", number(low), number(high)))
    }
}

/// Judges whether a direction of attraction is proper: a point of attraction exists all along the robot's way.
pub fn direction(subject: &str, segment: &Placed<'_>, approach: &Approach) -> Verdict {
    let verdict = |holds, finding: String| Verdict::new("direction", subject, holds, finding, EQUATION);
    let Some(across) = Across::of(segment, approach) else {
        return verdict(false, "the direction has no length, or the damping is not positive: give both".to_owned());
    };
    let [ranges, way] = across.texts();
    let holds = across.spare() >= 0.0;
    let finding = if holds {
        format!("across the direction the robot keeps to {way}, the segment spans {ranges}")
    } else {
        let missing = number(-across.spare());
        format!(
            "across the direction the robot keeps to {way}, but the segment spans {ranges}: turn the direction, or make the \
             segment {missing} m longer there"
        )
    };
    verdict(holds, finding)
}
