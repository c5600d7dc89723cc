//! How many robots find room on what obstacles leave of a segment, each outside of the repulsive zones of all others (7.5.1).
use crate::Vector2;
use crate::curve::{Curve, Interval};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// What rounding may take from a pitch, as a share of it.
const ROUNDING: f64 = 1e-9;
/// Places that are found lie up to this share of a pitch farther along than need be.
const STRIDE: f64 = 1e-4;
/// The farthest point of a piece is sought no further in parts shorter than this share of a pitch.
const FINEST: f64 = 1e-3;
/// A place is sought in so many strides: after them it is taken for nearer than it is.
const STRIDES: usize = 1000;

/// Bounds of how many places there are: on straight segments both are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Room {
    /// So many have been found.
    pub found: usize,
    /// More are not there, wherever robots stand.
    pub most: usize,
}

impl Room {
    /// Room on the `fragments` of `segment` (finite, in order and apart) for robots that stand at least `pitch` (m, positive) from each other,
    /// in a straight line: along the segment they may be farther. Both bounds are counted up to `enough`.
    pub fn count(segment: &Curve, fragments: &[Interval], pitch: f64, enough: usize) -> Self {
        let unrolled = unrolled(segment, fragments);
        let fragments = &*unrolled;
        let found = found(segment, fragments, pitch, enough);
        let covers = |(from, to): &Interval| to - from >= segment.length();
        let round = if segment.is_closed() && fragments.iter().any(covers) {
            // The last robot stands a pitch before the first.
            (segment.length() * (1.0 + ROUNDING) / pitch).max(1.0) as usize
        } else {
            enough
        };
        Self { found, most: most(segment, fragments, pitch, enough).min(round).max(found) }
    }
}

/// The same fragments, a closed curve's from before where it begins: one that goes on behind there is in one piece then.
fn unrolled<'a>(segment: &Curve, fragments: &'a [Interval]) -> Cow<'a, [Interval]> {
    match (segment.across(fragments), fragments) {
        (Some(across), [_, between @ .., _]) => core::iter::once(&across).chain(between).copied().collect(),
        _ => Cow::Borrowed(fragments),
    }
}

/// Robots that stand one after the other, each as soon as it is a pitch from all before it.
fn found(segment: &Curve, fragments: &[Interval], pitch: f64, enough: usize) -> usize {
    let cell = |point: Vector2<f64>| [point.x, point.y].map(|along| libm::floor(along / pitch) as i64);
    let mut standing = BTreeMap::<[i64; 2], Vec<Vector2<f64>>>::new();
    let (mut count, mut at) = (0, f64::NEG_INFINITY);
    while let Some(here) = first_from(fragments, at, pitch).filter(|_| count < enough) {
        let point = segment.at(here).point;
        let [column, row] = cell(point);
        let around = (-1..=1).flat_map(|right| (-1..=1).map(move |up| (right, up)));
        let beside = around.map(|(right, up)| [column.saturating_add(right), row.saturating_add(up)]);
        let others = beside.filter_map(|cell| standing.get(&cell)).flatten();
        let nearest = others.map(|other| (other - point).norm()).fold(f64::INFINITY, f64::min);
        let stands = nearest >= pitch * (1.0 - 2.0 * ROUNDING);
        if stands {
            standing.entry([column, row]).or_default().push(point);
            count += 1;
        }
        at = here + if stands { pitch } else { (pitch - nearest).max(STRIDE * pitch) };
        // A pitch that is lost in the rounding of arc lengths.
        if at <= here {
            break;
        }
    }
    count
}

/// Let e be where the k-th of any robots, counted along the segment, can stand at the earliest. The next one stands a pitch from some point
/// behind e: not before the piece from e to itself has that diameter. So pieces of that diameter, one after the other, bound the count.
fn most(segment: &Curve, fragments: &[Interval], pitch: f64, enough: usize) -> usize {
    let (mut count, mut earliest) = (0, first_from(fragments, f64::NEG_INFINITY, pitch));
    while let Some(from) = earliest.filter(|_| count < enough) {
        count += 1;
        earliest = Some(from);
        for _ in 0..STRIDES {
            let Some(here) = earliest else { break };
            // No distance grows faster than the way.
            let lacking = pitch - farthest(segment, fragments, (from, here), pitch);
            if lacking <= ROUNDING * pitch {
                break;
            }
            earliest = first_from(fragments, here + lacking, pitch);
        }
    }
    count
}

/// The first arc length on the fragments, not before `at` but for rounding.
fn first_from(fragments: &[Interval], at: f64, pitch: f64) -> Option<f64> {
    let next = fragments.get(fragments.partition_point(|(_, to)| *to < at - ROUNDING * pitch))?;
    Some(at.max(next.0).min(next.1))
}

/// An upper bound of the distance from the end of a piece to what lies in it on fragments, m. Where distances are a and b at both ends of
/// a part of length l, none in it is above (a + b + l)/2.
fn farthest(segment: &Curve, fragments: &[Interval], (from, here): Interval, pitch: f64) -> f64 {
    let end = segment.at(here).point;
    let distance = |at: f64| (segment.at(at).point - end).norm();
    let first = fragments.partition_point(|(_, to)| *to < from);
    let within = fragments[first..].iter().take_while(|fragment| fragment.0 <= here);
    let mut parts: Vec<_> = within
        .map(|(start, end)| (start.max(from), end.min(here)))
        .map(|(start, end)| ((start, distance(start)), (end, distance(end))))
        .collect();
    let mut greatest = parts.iter().map(|(start, end)| start.1.max(end.1)).fold(0.0, f64::max);
    while let Some((start, end)) = parts.pop() {
        let (length, bound) = (end.0 - start.0, 0.5 * (start.1 + end.1 + end.0 - start.0));
        if bound <= greatest + ROUNDING * pitch {
            continue;
        }
        if length <= FINEST * pitch {
            greatest = bound;
            continue;
        }
        let middle = 0.5 * (start.0 + end.0);
        let middle = (middle, distance(middle));
        greatest = greatest.max(middle.1);
        parts.extend([(start, middle), (middle, end)]);
    }
    greatest
}
