//! Nearest points of several moving points at once, in the lanes of vector instructions.
use super::bend::{Bend, SHORT, SHORTEST, guess};
use super::path::{Path, horner};
use super::primitive::Jet;
use super::{Curve, Warm};
use crate::Vector2;
use crate::lanes::{LANES, Plane, Vectors, mask};
use wide::f64x4;

/// Nearest points, in the lanes that `known` is set in: bit for bit those that [`Curve::nearest_again`] finds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Feet {
    pub(crate) known: f64x4,
    pub(crate) point: Vectors,
    pub(crate) arc_length: [f64; LANES],
}

/// A piece that is not straight, and where it lies.
type Known<'a> = (&'a Bend, &'a Path);

impl Curve {
    /// Lets what a point near `warm` will be asked about come nearer to the processor.
    #[inline]
    pub(crate) fn call_for(&self, warm: &Warm) {
        if let Some(bend) = warm.piece_on(self).and_then(|piece| self.pieces.get(piece)?.bend.as_deref()) {
            bend.call();
        }
    }

    /// The nearest points of those for whom it is quickly told, as [`Bend::rest`] does for one; none if there are no such points.
    #[inline]
    pub(crate) fn nearest_abreast(&self, points: Vectors, warm: [&Warm; LANES]) -> Option<Feet> {
        if self.open_start || self.open_end {
            return None;
        }
        let pieces = warm.map(|warm| warm.piece_on(self));
        let bends = pieces.map(|piece| {
            let bend = self.pieces.get(piece?)?.bend.as_deref()?;
            Some((bend, bend.path.as_ref()?))
        });
        // Lanes of which nothing is known do as another does, for nothing.
        let any = bends.into_iter().flatten().next()?;
        let known = mask(bends.map(|bend| bend.is_some()));
        let bends = bends.map(|bend| bend.unwrap_or(any));
        let (certain, parameter, jets) = rest(bends, points);
        let distance = (jets.point - points).norm();
        let moved = (points - Vectors::of(warm.map(|warm| warm.centre))).norm();
        let known = known & certain & (distance + moved).simd_lt(f64x4::new(warm.map(|warm| warm.room)));
        let parameter = parameter.to_array();
        let arc_length = core::array::from_fn(|lane| match pieces[lane] {
            Some(piece) => self.arc_length_at(piece, parameter[lane]),
            None => 0.0,
        });
        Some(Feet { known, point: jets.point, arc_length })
    }
}

/// [`Bend::rest`]: where that has an answer, the parameters and what is there.
#[inline(always)]
fn rest(bends: [Known<'_>; LANES], points: Vectors) -> (f64x4, f64x4, Jet<Vectors>) {
    let number = |of: fn(&Bend) -> f64| f64x4::new(bends.map(|(bend, _)| of(bend)));
    let jets = |of: fn(&Bend) -> &Jet| {
        let jets = bends.map(|(bend, _)| of(bend));
        Jet {
            point: Vectors::of(jets.map(|jet| jet.point)),
            first: Vectors::of(jets.map(|jet| jet.first)),
            second: Vectors::of(jets.map(|jet| jet.second)),
        }
    };
    let (start, middle, end) = (jets(|bend| &bend.ends[0]), jets(|bend| &bend.middle.jet), jets(|bend| &bend.ends[1]));
    let (calm, margin) = (number(|bend| bend.calm), number(|bend| bend.margin));
    let slopes = [start.slope(points), end.slope(points)];
    let near = (middle.point - points).norm_squared().simd_le(calm * calm);
    let beside = slopes[0].simd_lt(-margin) & slopes[1].simd_gt(margin);
    let (from, guess) = guess([&start, &middle, &end], slopes, points);
    let (jets, third) = along(bends, guess);
    let step = jets.step_of_third_order(third, points);
    let t = guess + step;
    let inside = from.simd_le(t) & t.simd_le(from + 1.0) & step.abs().simd_lt(f64x4::splat(SHORT));
    let moved = jets.moved(step, third);
    // A step of second order, where that was not all.
    let there = step.abs().simd_lt(f64x4::splat(SHORTEST));
    let more = moved.step_of_second_order(points);
    let further = moved.moved(more, third);
    let t = there.select(t, t + more);
    let jets = Jet { point: moved.point.or(there, &further.point), ..moved };
    let parameter = number(|bend| bend.centre) + number(|bend| bend.half) * t;
    (near & beside & inside, parameter, jets)
}

/// [`Path::at`](super::path::Path::at): position and three derivatives.
#[inline(always)]
fn along(bends: [Known<'_>; LANES], t: f64x4) -> (Jet<Vectors>, Vectors) {
    let paths = bends.map(|(_, path)| path.coefficients());
    let count = bends.map(|(_, path)| path.count()).into_iter().max().unwrap_or(0);
    let terms = (0..count).rev().map(|index| {
        let coefficients = paths.map(|path| path[index].to_array());
        Vectors::of(coefficients.map(|[x, y]| Vector2::new(x, y)))
    });
    let [point, first, second, third] = horner(terms, t, Vectors::splat(Vector2::zeros()));
    (Jet { point, first, second: f64x4::splat(2.0) * second }, f64x4::splat(6.0) * third)
}
