//! Encroachment of a segment by obstacles, and the fragments that are left (7.5.1).
use super::{Curve, Placed};
use crate::Vector2;
use crate::hull::Outline;

/// Length (m) below which a piece of the segment is no longer halved to look for an encroachment inside.
const FINEST: f64 = 1e-6;

/// Arc length interval, m.
pub type Interval = (f64, f64);

/// Parts of the segment between two arc lengths that are nearer than `reach` (m) to any of the outlines, in order and
/// apart. Ends are exact up to rounding. The distance changes by at most the length travelled, so that one value
/// decides a whole interval when it is far enough from `reach`; what merely touches may be missed below 1e-6 m.
///
/// On the extensions of an open queue `within` may be infinite: see `Curve::window_beyond`.
pub fn encroached(segment: &Placed<'_>, within: Interval, outlines: &[Outline<'_>], reach: f64) -> Vec<Interval> {
    let (curve, mut found) = (segment.curve(), Vec::new());
    let domain = curve.domain();
    let within = (within.0.max(domain.0), within.1.min(domain.1));
    let on_curve = (within.0.max(0.0), within.1.min(curve.length()));
    let beyond = [(within.0, within.1.min(0.0)), (within.0.max(curve.length()), within.1)];
    for outline in outlines {
        let (centre, radius) = outline.disc_around();
        let centre = segment.to_curve(centre);
        curve.tree.visit_near(centre, reach + radius, |index| {
            let excess = |point: Vector2<f64>| outline.approach(segment.point_to_map(point)).gap - reach;
            curve.encroached_on_piece(index, on_curve, excess, &mut found);
            reach + radius
        });
        for ((from, to), last) in beyond.into_iter().zip([false, true]) {
            if from < to {
                let window = curve.window_beyond(last, centre, reach + radius);
                // Arc lengths are parameters there.
                let excess = |arc_length: f64| (outline.approach(segment.at(arc_length).point).gap - reach, 1.0);
                below((from.max(window.0), to.min(window.1)), excess, |from, to| found.push((from, to)));
            }
        }
    }
    united(found)
}

impl Curve {
    /// The arc lengths at which the straight line beyond the first (or `last`) point, which never ends, can be within `reach` (m) of `centre`:
    /// it is run through at unit speed, so no more than `reach` to either side of where `centre` is abreast of it. Nothing that a disc there
    /// touches is cut off, so that to look no farther loses nothing.
    fn window_beyond(&self, last: bool, centre: Vector2<f64>, reach: f64) -> Interval {
        let (end, tangent) = self.at_end(last);
        let abreast = (centre - end).dot(&tangent) + if last { self.length } else { 0.0 };
        (abreast - reach, abreast + reach)
    }

    /// What of a piece, between two arc lengths, is where `excess` is negative.
    fn encroached_on_piece(
        &self,
        index: usize,
        within: Interval,
        excess: impl Fn(Vector2<f64>) -> f64,
        found: &mut Vec<Interval>,
    ) {
        let Some(part) = self.part_of_piece(index, within) else { return };
        let primitive = &self.primitives[part.primitive];
        let longest = 0.5 * (part.to - part.from);
        let (second, _) = primitive.derivative_bounds(0.5 * (part.from + part.to), longest);
        let value = |parameter: f64| {
            let jet = primitive.evaluate(parameter);
            (excess(jet.point), jet.first.norm() + longest * second)
        };
        below((part.from, part.to), value, |from, to| {
            let arc_length = |parameter: f64| self.arc_length_at(index, parameter).clamp(within.0, within.1);
            found.push((arc_length(from), arc_length(to)));
        });
    }
}

/// Calls `found`, in order, with the longest parameter intervals where a function is negative. `function` gives its value and a bound of
/// its slope anywhere.
fn below(whole: Interval, function: impl Fn(f64) -> (f64, f64), mut found: impl FnMut(f64, f64)) {
    let mut open: Option<Interval> = None;
    let mut stack = if whole.1 > whole.0 { vec![whole] } else { Vec::new() };
    while let Some((from, to)) = stack.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (value, slope) = function(middle);
        let change = half * slope;
        if value >= change {
            continue;
        }
        let negative = if value <= -change {
            Some((from, to))
        } else if change > 0.5 * FINEST && from < middle && middle < to {
            stack.extend([(middle, to), (from, middle)]);
            continue;
        } else {
            refined((from, to), &|at| function(at).0)
        };
        let Some((from, to)) = negative else { continue };
        match &mut open {
            Some(open) if open.1 == from => open.1 = to,
            _ => {
                if let Some((from, to)) = open.replace((from, to)) {
                    found(from, to);
                }
            }
        }
    }
    if let Some((from, to)) = open {
        found(from, to);
    }
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
pub(crate) fn united(mut intervals: Vec<Interval>) -> Vec<Interval> {
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
