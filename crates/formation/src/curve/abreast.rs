//! Nearest points of several moving points at once, in the lanes of vector instructions.
use super::bend::{Bend, SHORT, SHORTEST, guess};
use super::path::{Path, horner};
use super::primitive::Jet;
use super::{Curve, Warm};
use crate::Vector2;
use crate::lanes::{LANES, Lanes, Plane, Vectors};

/// Nearest points, in the lanes that `known` is set in: bit for bit those that [`Curve::nearest_again`] finds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Feet<L> {
    pub(crate) known: L,
    pub(crate) point: Vectors<L>,
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
    #[inline(always)]
    pub(crate) fn nearest_abreast<L: Lanes>(&self, points: Vectors<L>, warm: [&Warm; LANES]) -> Option<Feet<L>> {
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
        let known = L::mask(bends.map(|bend| bend.is_some()));
        let bends = bends.map(|bend| bend.unwrap_or(any));
        let (certain, parameter, jets) = rest::<L>(bends, points);
        let distance = (jets.point - points).norm();
        let moved = (points - Vectors::<L>::of(warm.map(|warm| warm.centre))).norm();
        let known = known & certain & (distance + moved).is_below(L::new(warm.map(|warm| warm.room)));
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
fn rest<L: Lanes>(bends: [Known<'_>; LANES], points: Vectors<L>) -> (L, L, Jet<Vectors<L>>) {
    let number = |of: fn(&Bend) -> f64| L::new(bends.map(|(bend, _)| of(bend)));
    let jets = |of: fn(&Bend) -> &Jet| {
        let jets = bends.map(|(bend, _)| of(bend));
        Jet {
            point: Vectors::<L>::of(jets.map(|jet| jet.point)),
            first: Vectors::<L>::of(jets.map(|jet| jet.first)),
            second: Vectors::<L>::of(jets.map(|jet| jet.second)),
        }
    };
    let (start, middle, end) = (jets(|bend| &bend.ends[0]), jets(|bend| &bend.middle.jet), jets(|bend| &bend.ends[1]));
    let (calm, margin) = (number(|bend| bend.calm), number(|bend| bend.margin));
    let slopes = [start.slope(points), end.slope(points)];
    let near = (middle.point - points).norm_squared().is_at_most(calm * calm);
    let beside = slopes[0].is_below(-margin) & margin.is_below(slopes[1]);
    let (from, guess) = guess([&start, &middle, &end], slopes, points);
    let (jets, third) = along(bends, guess);
    let step = jets.step_of_third_order(third, points);
    let t = guess + step;
    let inside = from.is_at_most(t) & t.is_at_most(from + L::splat(1.0)) & step.magnitude().is_below(L::splat(SHORT));
    let moved = jets.moved(step, third);
    // A step of second order, where that was not all.
    let there = step.magnitude().is_below(L::splat(SHORTEST));
    let more = moved.step_of_second_order(points);
    let further = moved.moved(more, third);
    let t = t.or(there, t + more);
    let jets = Jet { point: moved.point.or(there, &further.point), ..moved };
    let parameter = number(|bend| bend.centre) + number(|bend| bend.half) * t;
    (near & beside & inside, parameter, jets)
}

/// [`Path::at`](super::path::Path::at): position and three derivatives.
#[inline(always)]
fn along<L: Lanes>(bends: [Known<'_>; LANES], t: L) -> (Jet<Vectors<L>>, Vectors<L>) {
    let paths = bends.map(|(_, path)| path.coefficients());
    let count = bends.map(|(_, path)| path.count()).into_iter().max().unwrap_or(0);
    let terms = (0..count).rev().map(|index| {
        let coefficients = paths.map(|path| path[index].to_array());
        Vectors::<L>::of(coefficients.map(|[x, y]| Vector2::new(x, y)))
    });
    let [point, first, second, third] = horner(terms, t, Vectors::splat(Vector2::zeros()));
    (Jet { point, first, second: L::splat(2.0) * second }, L::splat(6.0) * third)
}
