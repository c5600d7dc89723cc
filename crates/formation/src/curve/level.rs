//! Where a function along a curve is negative: by halving, certified by bounds of its values.
use super::Interval;

/// Length (m) below which a piece of the segment is no longer halved to look for a change of sign inside.
const FINEST: f64 = 1e-6;
/// Depth (m) by which a function may be below zero between places where it is not, or above, without being told. A half of a micrometre, so
/// that a face which is by a round one nearer than the reach is not at the mercy of rounding either.
pub(super) const SHALLOW: f64 = 5e-7;

/// A function of a curve's parameter, m.
pub(super) trait Level {
    /// Its value, and a bound of its slope anywhere.
    fn at(&self, parameter: f64) -> (f64, f64);

    /// Bounds of its values within `half` of `middle`, from below and above, by more than its slope. `ends` are those at both ends.
    fn bounds(&self, middle: f64, half: f64, ends: [f64; 2]) -> (f64, f64);
}

/// Parameters, or arc lengths, between which a function is negative, and by how much it was seen to be at most (at least half of what it is
/// somewhere), m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) depth: f64,
}

/// An interval and what is known of the values at its ends.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    ends: [Option<f64>; 2],
}

/// Calls `found`, in order, with the longest parameter intervals where a function is negative.
///
/// Only an interval across whose ends the sign changes must be halved down to [`FINEST`], and of its halves just one is such an interval.
/// Between ends of one sign the bounds decide as soon as they are within [`SHALLOW`]: that ends where the function is flat too.
pub(super) fn below(whole: Interval, function: &impl Level, mut found: impl FnMut(Run)) {
    let mut open: Option<Run> = None;
    let mut stack = Vec::new();
    if whole.1 > whole.0 {
        stack.push(Part { from: whole.0, to: whole.1, ends: [None; 2] });
    }
    while let Some(part) = stack.pop() {
        let run = match look_at(function, &part) {
            Seen::Positive => continue,
            Seen::Negative(run) => run,
            Seen::Halves(first, second) => {
                stack.extend([second, first]);
                continue;
            }
        };
        match &mut open {
            Some(open) if open.to == run.from => (open.to, open.depth) = (run.to, open.depth.max(run.depth)),
            _ => {
                if let Some(done) = open.replace(run) {
                    found(done);
                }
            }
        }
    }
    if let Some(done) = open {
        found(done);
    }
}

/// What is seen of a part.
enum Seen {
    Positive,
    Negative(Run),
    Halves(Part, Part),
}

fn look_at(function: &impl Level, part: &Part) -> Seen {
    let Part { from, to, .. } = *part;
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (value, slope) = function.at(middle);
    let change = half * slope;
    if value >= change {
        return Seen::Positive;
    }
    if value <= -change {
        return Seen::Negative(Run { from, to, depth: -value });
    }
    let known = |end: Option<f64>, at: f64| end.unwrap_or_else(|| function.at(at).0);
    let ends = [known(part.ends[0], from), known(part.ends[1], to)];
    let depth = (-ends[0]).max(-ends[1]);
    if !(change > 0.5 * FINEST && from < middle && middle < to) {
        let negative = refined((from, to), ends, &|at| function.at(at).0);
        return negative.map_or(Seen::Positive, |(from, to)| Seen::Negative(Run { from, to, depth }));
    }
    match decided(function, (middle, half), ends) {
        Some(true) => Seen::Negative(Run { from, to, depth: depth.max(-value) }),
        Some(false) => Seen::Positive,
        None => Seen::Halves(
            Part { from, to: middle, ends: [Some(ends[0]), Some(value)] },
            Part { from: middle, to, ends: [Some(value), Some(ends[1])] },
        ),
    }
}

/// Whether a function is negative all over an interval, but for what is shallow; nothing if that is not seen.
fn decided(function: &impl Level, (middle, half): (f64, f64), ends: [f64; 2]) -> Option<bool> {
    let [starts_inside, ends_inside] = ends.map(|value| value < 0.0);
    if starts_inside != ends_inside {
        return None;
    }
    let (low, high) = function.bounds(middle, half, ends);
    let is_seen = if starts_inside { high <= SHALLOW } else { low >= -SHALLOW };
    is_seen.then_some(starts_inside)
}

/// The negative part of an interval across whose ends, at which the function is so, the sign may change once.
fn refined((from, to): Interval, ends: [f64; 2], function: &impl Fn(f64) -> f64) -> Option<Interval> {
    match (ends[0] < 0.0, ends[1] < 0.0) {
        (true, true) => Some((from, to)),
        (false, false) => None,
        (starts_inside, _) => {
            let (mut low, mut high) = (from, to);
            while high - low > f64::EPSILON * (1.0 + high.abs()) {
                let middle = 0.5 * (low + high);
                if (function(middle) < 0.0) == starts_inside {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            Some(if starts_inside { (from, low) } else { (high, to) })
        }
    }
}
