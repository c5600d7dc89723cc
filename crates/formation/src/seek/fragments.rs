//! Steps (1) to (3) of 7.5.2: what obstacles and robots ahead leave of a segment.
use crate::Vector2;
use crate::curve::{Interval, Placed, encroached, qualified_fragments, united};
use crate::hull::{ApparentObstacle, HullError, Obstacle, Outline, Shape, combine_unless};
use std::sync::Arc;

/// The qualified fragments of a segment for one robot, S_fg of 7.5.1: arc length intervals in order and apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fragments {
    /// Shared: where robots do not encroach, all have the same.
    intervals: Arc<[Interval]>,
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
        Self { intervals: Arc::new([within]) }
    }

    /// Steps (2) and (3): what is left of `within` (infinite where a queue is open) by repulsive zones that reach `clearance` (m) beyond the outlines,
    /// without pieces shorter than `room` (m). On a closed curve a fragment across the point where arc lengths begin counts as two.
    pub fn find(segment: &Placed<'_>, within: Interval, outlines: &[Outline<'_>], clearance: f64, room: f64) -> Self {
        Self::beside(within, &encroached(segment, within, outlines, clearance), room)
    }

    /// What is left of `within` by the intervals that are taken, in any order, without pieces shorter than `room` (m).
    pub fn beside<'a>(within: Interval, taken: impl IntoIterator<Item = &'a Interval>, room: f64) -> Self {
        let taken = united(taken.into_iter().copied().collect());
        Self { intervals: qualified_fragments(within, &taken, room).into() }
    }

    /// What of the fragments lies in intervals (in order and apart), without pieces shorter than `room` (m); nothing where no piece is left.
    pub fn meeting(&self, intervals: &[Interval], room: f64) -> Option<Self> {
        let meet = |(from, to): &Interval| {
            let (from, to) = (*from, *to);
            intervals.iter().map(move |interval| (from.max(interval.0), to.min(interval.1)))
        };
        let pieces = self.intervals.iter().flat_map(meet).filter(|(from, to)| to - from >= room && to > from);
        let intervals: Arc<[Interval]> = pieces.collect();
        (!intervals.is_empty()).then_some(Self { intervals })
    }

    /// Fragments that are no more than `gap` (m) apart along the segment, from where to where, with how many robots at least find places
    /// there, `pitch` (m) from each other: they choose one after the other, and what a robot leaves beside it may be just too short. On an
    /// open queue there are as many places as can be counted.
    pub fn groups(&self, gap: f64, pitch: f64) -> Vec<(Interval, usize)> {
        let mut groups: Vec<(Interval, usize)> = Vec::new();
        for &(from, to) in self.intervals.iter() {
            let places = (libm::floor((to - from) / (2.0 * pitch)) as usize).saturating_add(1);
            match groups.last_mut() {
                Some((span, sum)) if from - span.1 <= gap => {
                    span.1 = to;
                    *sum = sum.saturating_add(places);
                }
                _ => groups.push(((from, to), places)),
            }
        }
        groups
    }

    /// The fragments; none if the whole segment is covered.
    #[inline]
    pub fn intervals(&self) -> &[Interval] {
        &self.intervals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fragments(intervals: &[Interval]) -> Fragments {
        Fragments { intervals: intervals.into() }
    }

    #[test]
    fn fragments_meet_intervals_in_order() {
        let free = fragments(&[(0.0, 2.0), (4.0, 9.0)]);
        assert_eq!(free.meeting(&[(1.0, 5.0), (8.95, 12.0)], 0.1), Some(fragments(&[(1.0, 2.0), (4.0, 5.0)])));
        assert_eq!(free.meeting(&[(2.5, 3.5)], 0.0), None);
    }

    #[test]
    fn groups_count_places_whoever_chooses_what() {
        // 17 m hold nine robots at least: eight in the middle of what is left, 1.99 m apart, and one at an end.
        let free = fragments(&[(0.0, 17.0), (19.0, 25.0), (36.0, 38.5)]);
        assert_eq!(free.groups(5.0, 1.0), [((0.0, 25.0), 9 + 4), ((36.0, 38.5), 2)]);
        assert_eq!(free.groups(1.0, 1.0).len(), 3);
    }

    #[test]
    fn what_is_taken_may_overlap() {
        let taken = [(5.0, 7.0), (1.0, 2.0), (6.0, 8.0)];
        assert_eq!(Fragments::beside((0.0, 9.0), &taken, 1.5), fragments(&[(2.0, 5.0)]));
    }
}
