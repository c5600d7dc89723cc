//! Steps (1) to (3) of 7.5.2: what obstacles and robots ahead leave of a segment.
use crate::Vector2;
use crate::curve::{Curve, Interval, Placed, encroached, qualified_fragments, united};
use crate::hull::{ApparentObstacle, HullError, Obstacle, Outline, Shape, combine_unless};
use std::sync::Arc;

/// The qualified fragments of a segment for one robot, S_fg of 7.5.1: arc length intervals in order and apart. On a closed curve a fragment
/// across the point where arc lengths begin is two of them, the first and the last, and counts as one ([`Curve::joins`]).
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
    /// without fragments shorter than `room` (m).
    pub fn find(segment: &Placed<'_>, within: Interval, outlines: &[Outline<'_>], clearance: f64, room: f64) -> Self {
        Self::beside(segment.curve(), within, &encroached(segment, within, outlines, clearance), room)
    }

    /// What is left of `within` by the intervals of the segment that are taken, in any order, without fragments shorter than `room` (m).
    pub fn beside<'a>(
        segment: &Curve,
        within: Interval,
        taken: impl IntoIterator<Item = &'a Interval>,
        room: f64,
    ) -> Self {
        let taken = united(taken.into_iter().copied().collect());
        Self { intervals: qualified_fragments(segment, within, &taken, room).into() }
    }

    /// What of the fragments of the segment lies in intervals (in order and apart), without fragments shorter than `room` (m); nothing where
    /// none is left.
    pub fn meeting(&self, segment: &Curve, intervals: &[Interval], room: f64) -> Option<Self> {
        let meet = |(from, to): &Interval| {
            let (from, to) = (*from, *to);
            intervals.iter().map(move |interval| (from.max(interval.0), to.min(interval.1)))
        };
        let intervals: Arc<[Interval]> = segment.with_room(self.intervals.iter().flat_map(meet), room).into();
        (!intervals.is_empty()).then_some(Self { intervals })
    }

    /// Fragments that are no more than `gap` (m) apart along the segment, from where to where, with how many robots at least find places
    /// there, `pitch` (m) from each other: they choose one after the other, and what a robot leaves beside it may be just too short. On an
    /// open queue there are as many places as can be counted. A group across the point where a closed curve begins is two, each with all places.
    pub fn groups(&self, segment: &Curve, gap: f64, pitch: f64) -> Vec<(Interval, usize)> {
        let mut groups: Vec<(Interval, usize)> = Vec::new();
        let places_on = |length: f64| (libm::floor(length / (2.0 * pitch)) as usize).saturating_add(1);
        let joined = self.intervals.last().filter(|_| segment.joins(&self.intervals));
        for (index, &(from, to)) in self.intervals.iter().enumerate() {
            let places = match joined {
                // The half at the end is counted with that at the beginning.
                Some(last) if index == 0 => places_on(to - from + (last.1 - last.0)),
                Some(_) if index + 1 == self.intervals.len() => 0,
                _ => places_on(to - from),
            };
            match groups.last_mut() {
                Some((span, sum)) if from - span.1 <= gap => {
                    span.1 = to;
                    *sum = sum.saturating_add(places);
                }
                _ => groups.push(((from, to), places)),
            }
        }
        if let [(first, before), .., (last, behind)] = groups.as_mut_slice()
            && segment.is_closed()
            && (joined.is_some() || first.0 + segment.length() - last.1 <= gap)
        {
            let all = before.saturating_add(*behind);
            (*before, *behind) = (all, all);
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
    use crate::curve::CurveShape;

    fn fragments(intervals: &[Interval]) -> Fragments {
        Fragments { intervals: intervals.into() }
    }

    fn line() -> Curve {
        Curve::new(&CurveShape::Line(Vector2::zeros(), Vector2::new(40.0, 0.0)), false, false).unwrap()
    }

    /// 40 m long.
    fn circle() -> Curve {
        let (radius, sweep) = (20.0 / core::f64::consts::PI, core::f64::consts::TAU);
        Curve::new(&CurveShape::Arc { centre: Vector2::zeros(), radius, start_angle: 0.0, sweep }, false, false)
            .unwrap()
    }

    #[test]
    fn fragments_meet_intervals_in_order() {
        let free = fragments(&[(0.0, 2.0), (4.0, 9.0)]);
        let met = free.meeting(&line(), &[(1.0, 5.0), (8.95, 12.0)], 0.1);
        assert_eq!(met, Some(fragments(&[(1.0, 2.0), (4.0, 5.0)])));
        assert_eq!(free.meeting(&line(), &[(2.5, 3.5)], 0.0), None);
    }

    #[test]
    fn what_meets_across_the_beginning_of_a_closed_curve_is_one() {
        let (circle, end) = (circle(), circle().length());
        let whole = Fragments::whole((0.0, end));
        let near = [(0.0, 1.0), (38.5, end)];
        assert_eq!(whole.meeting(&circle, &near, 2.0), Some(fragments(&near)));
        assert_eq!(whole.meeting(&circle, &near, 3.0), None);
        assert_eq!(whole.meeting(&line(), &near, 2.0), None);
    }

    #[test]
    fn groups_count_places_whoever_chooses_what() {
        // 17 m hold nine robots at least: eight in the middle of what is left, 1.99 m apart, and one at an end.
        let free = fragments(&[(0.0, 17.0), (19.0, 25.0), (36.0, 38.5)]);
        assert_eq!(free.groups(&line(), 5.0, 1.0), [((0.0, 25.0), 9 + 4), ((36.0, 38.5), 2)]);
        assert_eq!(free.groups(&line(), 1.0, 1.0).len(), 3);
        // Round a circle the last of them is near the first.
        assert_eq!(free.groups(&circle(), 5.0, 1.0), [((0.0, 25.0), 9 + 4 + 2), ((36.0, 38.5), 9 + 4 + 2)]);
        // 3 m and 3.5 m that are one hold no more than 6.5 m.
        let end = circle().length();
        let halves = fragments(&[(0.0, 3.0), (10.0, 11.0), (36.5, end)]);
        assert_eq!(halves.groups(&circle(), 1.0, 1.0), [((0.0, 3.0), 4), ((10.0, 11.0), 1), ((36.5, end), 4)]);
    }

    #[test]
    fn what_is_taken_may_overlap() {
        let taken = [(5.0, 7.0), (1.0, 2.0), (6.0, 8.0)];
        assert_eq!(Fragments::beside(&line(), (0.0, 9.0), &taken, 1.5), fragments(&[(2.0, 5.0)]));
    }
}
