//! Encroachment of a segment by obstacles (7.5.1).
use super::excess::Excess;
use super::level::{Run, SHALLOW, below};
use super::primitive::Jet;
use super::{Curve, Placed};
use crate::Vector2;
use crate::hull::Outline;
use core::cell::Cell;

/// Arc length interval, m.
pub type Interval = (f64, f64);

/// Parts of the segment between two arc lengths that are nearer than `reach` (m) to any of the outlines, in order and
/// apart. Ends are exact up to rounding. The distance changes by at most the length travelled, so that one value decides
/// a whole interval when it is far enough from `reach`; where it runs along the reach, its curvature decides.
///
/// What merely touches may be missed: below 1e-6 m of length, and what of an outline reaches in by no more than 5e-7 m
/// anywhere is free as a whole (more than 1e-6 m is always found). So a face that lies at the reach takes nothing, however
/// the frame it is seen from rounds: repulsion begins there with nothing, while to lose the segment would leave a team
/// nowhere. Between two encroachments by one outline what is free by no more than 5e-7 m may count as encroached.
///
/// On the extensions of an open queue `within` may be infinite: see `Curve::window_beyond`.
pub fn encroached(segment: &Placed<'_>, within: Interval, outlines: &[Outline<'_>], reach: f64) -> Vec<Interval> {
    let evaluations = Cell::new(0);
    united(outlines.iter().flat_map(|outline| taken_by(segment, within, outline, reach, &evaluations)).collect())
}

/// What one outline takes; counts how often its gap was asked for.
fn taken_by(
    segment: &Placed<'_>,
    within: Interval,
    outline: &Outline<'_>,
    reach: f64,
    evaluations: &Cell<u32>,
) -> Vec<Interval> {
    let (curve, mut runs) = (segment.curve(), Vec::new());
    let domain = curve.domain();
    let within = (within.0.max(domain.0), within.1.min(domain.1));
    let on_curve = (within.0.max(0.0), within.1.min(curve.length()));
    let beyond = [(within.0, within.1.min(0.0)), (within.0.max(curve.length()), within.1)];
    let straight = Excess { segment, outline, reach, slack: 0.0, second: 0.0, third: 0.0, circle: None, evaluations };
    let (centre, radius) = outline.disc_around();
    let centre = segment.to_curve(centre);
    curve.tree.visit_near(centre, reach + radius, |index| {
        curve.encroached_on_piece(index, on_curve, &straight, &mut runs);
        reach + radius
    });
    for ((from, to), last) in beyond.into_iter().zip([false, true]) {
        if from < to {
            let window = curve.window_beyond(last, centre, reach + radius);
            // Arc lengths are parameters there.
            let excess = straight.along(|arc_length| {
                let foot = curve.at(arc_length);
                Jet { point: foot.point, first: foot.tangent, second: Vector2::zeros() }
            });
            below((from.max(window.0), to.min(window.1)), &excess, |run| runs.push(run));
        }
    }
    deep(runs, curve)
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

    /// What of a piece, between two arc lengths, is nearer to an outline than the reach.
    fn encroached_on_piece(&self, index: usize, within: Interval, to: &Excess<'_>, runs: &mut Vec<Run>) {
        let Some(part) = self.part_of_piece(index, within) else { return };
        let primitive = &self.primitives[part.primitive];
        let longest = 0.5 * (part.to - part.from);
        let (second, third) = primitive.derivative_bounds(0.5 * (part.from + part.to), longest);
        let excess = Excess { slack: longest * second, second, third, circle: primitive.circle(), ..*to };
        below((part.from, part.to), &excess.along(|parameter| primitive.evaluate(parameter)), |run| {
            let arc_length = |parameter: f64| self.arc_length_at(index, parameter).clamp(within.0, within.1);
            runs.push(Run { from: arc_length(run.from), to: arc_length(run.to), ..run });
        });
    }
}

/// The encroachments that are made up of these runs, without those that are shallow everywhere.
fn deep(mut runs: Vec<Run>, curve: &Curve) -> Vec<Interval> {
    runs.sort_by(|a, b| a.from.total_cmp(&b.from));
    runs.dedup_by(|next, kept| {
        let touches = touches(kept.to, next.from);
        if touches {
            (kept.to, kept.depth) = (kept.to.max(next.to), kept.depth.max(next.depth));
        }
        touches
    });
    // Across the point where a closed curve begins it is one.
    if let [first, .., last] = runs.as_mut_slice()
        && curve.is_closed()
        && touches(last.to, first.from + curve.length())
    {
        let depth = first.depth.max(last.depth);
        (first.depth, last.depth) = (depth, depth);
    }
    runs.into_iter().filter(|run| run.depth > SHALLOW).map(|run| (run.from, run.to)).collect()
}

/// Whether nothing but rounding is between the end of an interval and the start of one that begins no earlier.
fn touches(end: f64, start: f64) -> bool {
    start <= end + 1e-12 * (1.0 + end.abs())
}

/// Sorts intervals and joins those that overlap or touch.
pub(crate) fn united(mut intervals: Vec<Interval>) -> Vec<Interval> {
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    intervals.dedup_by(|next, kept| {
        let touches = touches(kept.1, next.0);
        if touches {
            kept.1 = kept.1.max(next.1);
        }
        touches
    });
    intervals
}

#[cfg(test)]
mod tests;
