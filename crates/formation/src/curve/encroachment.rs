//! Encroachment of a segment by obstacles, and the fragments that are left (7.5.1).
use super::Placed;
use crate::hull::Outline;

/// Length (m) below which a piece of the segment is no longer halved to look for an encroachment inside.
const FINEST: f64 = 1e-6;

/// Arc length interval, m.
pub type Interval = (f64, f64);

/// Parts of the segment between two arc lengths that are nearer than `reach` (m) to any of the outlines, in order and
/// apart. Ends are exact up to rounding. The distance changes by at most the arc length travelled, so that one value
/// decides a whole interval when it is far enough from `reach`; what merely touches may be missed below 1e-6 m.
pub fn encroached(segment: &Placed<'_>, within: Interval, outlines: &[Outline<'_>], reach: f64) -> Vec<Interval> {
    let mut found: Vec<Interval> = Vec::new();
    for outline in outlines {
        let (centre, radius) = outline.disc_around();
        if segment.nearest(centre).distance >= reach + radius {
            continue;
        }
        let excess = |arc_length: f64| outline.approach(segment.at(arc_length).point).gap - reach;
        let mut stack = vec![within];
        while let Some((from, to)) = stack.pop() {
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            let value = excess(middle);
            if value >= half {
                continue;
            }
            if value <= -half {
                found.push((from, to));
            } else if half > 0.5 * FINEST {
                stack.extend([(middle, to), (from, middle)]);
            } else {
                found.extend(refined((from, to), &excess));
            }
        }
    }
    united(found)
}

/// The encroached part of an interval across whose ends the sign may change once.
fn refined((from, to): Interval, excess: &impl Fn(f64) -> f64) -> Option<Interval> {
    match (excess(from) < 0.0, excess(to) < 0.0) {
        (true, true) => Some((from, to)),
        (false, false) => None,
        (starts_inside, _) => {
            let (mut low, mut high) = (from, to);
            while high - low > f64::EPSILON * (1.0 + high.abs()) {
                let middle = 0.5 * (low + high);
                if (excess(middle) < 0.0) == starts_inside {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            Some(if starts_inside { (from, low) } else { (high, to) })
        }
    }
}

/// Sorts intervals and joins those that overlap or touch.
fn united(mut intervals: Vec<Interval>) -> Vec<Interval> {
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    intervals.dedup_by(|next, kept| {
        let touches = next.0 <= kept.1 + 1e-12 * (1.0 + kept.1.abs());
        if touches {
            kept.1 = kept.1.max(next.1);
        }
        touches
    });
    intervals
}

/// What encroachments (in order and apart) leave of an interval: the fragments with at least `room` (m) for a robot.
pub fn qualified_fragments(within: Interval, encroached: &[Interval], room: f64) -> Vec<Interval> {
    let starts = core::iter::once(within.0).chain(encroached.iter().map(|interval| interval.1));
    let ends = encroached.iter().map(|interval| interval.0).chain(core::iter::once(within.1));
    starts.zip(ends).filter(|(start, end)| end - start >= room && end > start).collect()
}
