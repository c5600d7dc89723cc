//! Directions of attraction (6.3).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::Vector2;
use trench_formation::curve::Placed;

const EQUATION: &str =
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

/// Judges whether a direction of attraction is proper: a point of attraction exists all along the robot's way.
pub fn direction(subject: &str, segment: &Placed<'_>, approach: &Approach) -> Verdict {
    let verdict = |holds, finding: String| Verdict::new("direction", subject, holds, finding, EQUATION);
    let along = approach.direction;
    let across = Vector2::new(along.y, -along.x) / along.norm();
    let size = along.norm();
    if !(size.is_finite() && size > 0.0 && approach.damping > 0.0) {
        return verdict(false, "the direction has no length, or the damping is not positive: give both".to_owned());
    }
    let (low, high) = segment.extent(across);
    let (start, drift) = (approach.position.dot(&across), approach.velocity.dot(&across) / approach.damping);
    let (least, most) = (start.min(start + drift), start.max(start + drift));
    let (ranges, way) =
        (format!("[{}, {}] m", number(low), number(high)), format!("[{}, {}] m", number(least), number(most)));
    let holds = low <= least && most <= high;
    let finding = if holds {
        format!("across the direction the robot keeps to {way}, the segment spans {ranges}")
    } else {
        let missing = number((low - least).max(most - high));
        format!(
            "across the direction the robot keeps to {way}, but the segment spans {ranges}: turn the direction, or make the \
             segment {missing} m longer there"
        )
    };
    verdict(holds, finding)
}
