//! Fragments of a segment: what encroachments leave of it (7.5.1). They are told as intervals of arc length between 0 and the length, so that
//! a fragment across the point where a closed curve begins is told as two, the first and the last: here they are known to be one.
use super::{Curve, Interval};

/// What encroachments (in order and apart) leave of an interval: the fragments with at least `room` (m) for a robot.
pub fn qualified_fragments(segment: &Curve, within: Interval, encroached: &[Interval], room: f64) -> Vec<Interval> {
    let starts = core::iter::once(within.0).chain(encroached.iter().map(|interval| interval.1));
    let ends = encroached.iter().map(|interval| interval.0).chain(core::iter::once(within.1));
    segment.with_room(starts.zip(ends), room)
}

impl Curve {
    /// Whether the first and the last of some intervals (in order and apart) are one, across the point where a closed curve begins.
    pub fn joins(&self, intervals: &[Interval]) -> bool {
        self.across(intervals).is_some()
    }

    /// The fragment that goes across that point, in one piece: it begins before 0.
    pub(crate) fn across(&self, intervals: &[Interval]) -> Option<Interval> {
        match intervals {
            [first, .., last] if self.closed && first.0 <= 0.0 && last.1 >= self.length => {
                Some((last.0 - self.length, first.1))
            }
            _ => None,
        }
    }

    /// How many fragments intervals (in order and apart) are.
    pub fn count_fragments(&self, intervals: &[Interval]) -> usize {
        intervals.len() - usize::from(self.joins(intervals))
    }

    /// Of pieces (in order and apart) those that are at least so long (m), each with what it is one with.
    pub(crate) fn with_room(&self, pieces: impl Iterator<Item = Interval>, room: f64) -> Vec<Interval> {
        let mut pieces: Vec<Interval> = pieces.filter(|(from, to)| to > from).collect();
        let joined = self.across(&pieces).map(|(from, to)| to - from);
        let last = pieces.len().saturating_sub(1);
        let mut index = 0;
        pieces.retain(|(from, to)| {
            let length = joined.filter(|_| index == 0 || index == last).unwrap_or(to - from);
            index += 1;
            length >= room
        });
        pieces
    }

    /// All of the fragment that an interval is of, among intervals (in order and apart).
    pub(crate) fn fragment_of<'a>(
        &self,
        intervals: &'a [Interval],
        interval: Interval,
    ) -> impl Iterator<Item = Interval> + use<'a> {
        let is_half = |half: &Interval| *half == intervals[0] || *half == intervals[intervals.len() - 1];
        let halved = self.joins(intervals) && is_half(&interval);
        let other = intervals.iter().copied().filter(move |half| halved && is_half(half) && *half != interval);
        core::iter::once(interval).chain(other)
    }

    /// The arc length on a closed curve that is the same point as `arc_length` and less than half a round away from `at`.
    pub(crate) fn next_to(&self, at: f64, arc_length: f64) -> f64 {
        arc_length - self.length * libm::round((arc_length - at) / self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector2;
    use crate::curve::CurveShape;

    /// A circle that is 10 m long.
    fn circle() -> Curve {
        let (radius, sweep) = (5.0 / core::f64::consts::PI, core::f64::consts::TAU);
        Curve::new(&CurveShape::Arc { centre: Vector2::zeros(), radius, start_angle: 0.0, sweep }, false, false)
            .unwrap()
    }

    #[test]
    fn a_fragment_across_the_beginning_is_measured_as_a_whole() {
        let (closed, open) =
            (circle(), Curve::new(&CurveShape::Line(Vector2::zeros(), Vector2::new(10.0, 0.0)), false, false).unwrap());
        let (whole, taken) = ((0.0, closed.length()), [(1.0, 4.0), (4.5, 8.5)]);
        let both = [(0.0, 1.0), (8.5, closed.length())];
        assert_eq!(qualified_fragments(&closed, whole, &taken, 2.0), both);
        assert_eq!(qualified_fragments(&closed, whole, &taken, 0.0).len(), 3);
        assert_eq!(qualified_fragments(&closed, whole, &taken, 2.6), []);
        assert_eq!(qualified_fragments(&open, (0.0, 10.0), &taken, 1.2), [(8.5, 10.0)]);
        // Whose ends are taken joins nothing, and a whole circle is one as it is.
        assert_eq!(qualified_fragments(&closed, whole, &[(0.0, 0.5), (2.0, 7.0)], 2.0), [(7.0, closed.length())]);
        assert_eq!(qualified_fragments(&closed, whole, &[], 9.0), [whole]);
        assert_eq!([&both[..], &[whole]].map(|intervals| closed.count_fragments(intervals)), [1, 1]);
        assert_eq!(open.count_fragments(&[(0.0, 1.0), (8.5, 10.0)]), 2);
    }

    #[test]
    fn halves_know_each_other() {
        let closed = circle();
        let intervals = [(0.0, 1.0), (3.0, 4.0), (8.5, closed.length())];
        let of = |index: usize| closed.fragment_of(&intervals, intervals[index]).collect::<Vec<_>>();
        assert_eq!(of(0), [intervals[0], intervals[2]]);
        assert_eq!(of(1), [intervals[1]]);
        assert_eq!(of(2), [intervals[2], intervals[0]]);
        assert!((closed.next_to(9.5, 0.25) - 10.25).abs() < 1e-12 && (closed.next_to(0.5, 9.0) + 1.0).abs() < 1e-12);
    }
}
