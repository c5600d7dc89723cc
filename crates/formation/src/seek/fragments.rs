//! Steps (1) to (3) of 7.5.2: what obstacles and robots ahead leave of a segment.
use crate::Vector2;
use crate::curve::{Interval, Placed, encroached, qualified_fragments};
use crate::hull::{ApparentObstacle, HullError, Obstacle, Outline, Shape, combine_unless};

/// The qualified fragments of a segment for one robot, S_fg of 7.5.1: arc length intervals in order and apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fragments {
    intervals: Vec<Interval>,
}

/// Step (1): apparent obstacles among real obstacles and the robots ahead, discs of `body_radius` (m). Combining is judged by
/// `clearance` (m), but obstacles that `adjoin` (by their ids) stay apart, see [`combine_unless`]. A robot ahead gets an id above those
/// of all obstacles.
///
/// # Errors
/// Robots ahead whose position is not finite, a radius or clearance that is no length, two obstacles of one id.
pub fn apparent_obstacles(
    real: &[Obstacle],
    ahead: &[Vector2<f64>],
    body_radius: f64,
    clearance: f64,
    adjoin: impl Fn(u32, u32) -> bool,
) -> Result<Vec<ApparentObstacle>, HullError> {
    let mut all = real.to_vec();
    let first = real.iter().map(|obstacle| obstacle.id.saturating_add(1)).max().unwrap_or(0);
    for (id, position) in (first..).zip(ahead) {
        all.push(Obstacle { id, shape: Shape::new(&[*position], body_radius)? });
    }
    combine_unless(&all, clearance, adjoin)
}

impl Fragments {
    /// The whole of `within`, encroached by nothing.
    pub fn whole(within: Interval) -> Self {
        Self { intervals: vec![within] }
    }

    /// Steps (2) and (3): what is left of `within` (finite) by repulsive zones that reach `clearance` (m) beyond the outlines,
    /// without pieces shorter than `room` (m). On a closed curve a fragment across the point where arc lengths begin counts as two.
    pub fn find(segment: &Placed<'_>, within: Interval, outlines: &[Outline<'_>], clearance: f64, room: f64) -> Self {
        let encroached = encroached(segment, within, outlines, clearance);
        Self { intervals: qualified_fragments(within, &encroached, room) }
    }

    /// The fragments; none if the whole segment is covered.
    pub fn intervals(&self) -> &[Interval] {
        &self.intervals
    }
}
