//! Nearest points of several moving points at once, in the lanes of vector instructions.
use super::bend::{Bend, SHORT, SHORTEST};
use super::path::Path;
use super::{Curve, Warm};
use crate::lanes::{LANES, Vectors, mask};
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

/// Jets side by side.
#[derive(Clone, Copy)]
struct Jets {
    point: Vectors,
    first: Vectors,
    second: Vectors,
}

impl Jets {
    #[inline(always)]
    fn moved(&self, step: f64x4, third: Vectors) -> Self {
        let half = 0.5 * step;
        Self {
            point: self.point + step * (self.first + half * (self.second + step / 3.0 * third)),
            first: self.first + step * (self.second + half * third),
            second: self.second + step * third,
        }
    }
}

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
fn rest(bends: [Known<'_>; LANES], points: Vectors) -> (f64x4, f64x4, Jets) {
    let number = |of: fn(&Bend) -> f64| f64x4::new(bends.map(|(bend, _)| of(bend)));
    let jets = |of: fn(&Bend) -> &super::primitive::Jet| {
        let jets = bends.map(|(bend, _)| of(bend));
        Jets {
            point: Vectors::of(jets.map(|jet| jet.point)),
            first: Vectors::of(jets.map(|jet| jet.first)),
            second: Vectors::of(jets.map(|jet| jet.second)),
        }
    };
    let slope = |jets: &Jets| (jets.point - points).dot(&jets.first);
    let growth = |jets: &Jets| jets.first.norm_squared() + (jets.point - points).dot(&jets.second);
    let (start, middle, end) = (jets(|bend| &bend.ends[0]), jets(|bend| &bend.middle.jet), jets(|bend| &bend.ends[1]));
    let (calm, margin) = (number(|bend| bend.calm), number(|bend| bend.margin));
    let slopes = [slope(&start), slope(&end)];
    let near = (middle.point - points).norm_squared().simd_le(calm * calm);
    let beside = slopes[0].simd_lt(-margin) & slopes[1].simd_gt(margin);
    // The guess.
    let at_middle = slope(&middle);
    let forward = at_middle.simd_lt(f64x4::ZERO);
    let from = forward.select(f64x4::ZERO, f64x4::splat(-1.0));
    let (below, above) = (forward.select(at_middle, slopes[0]), forward.select(slopes[1], at_middle));
    let grows = growth(&middle);
    let low = forward.select(grows, growth(&start));
    let high = forward.select(growth(&end), grows);
    let rise = above - below;
    let share = -below / rise;
    let rest = 1.0 - share;
    let bend = rise * share * rest * (rest / low - share / high);
    let guess = from + share * share * (3.0 - 2.0 * share) + bend;
    // A step of third order.
    let (jets, third) = along(bends, guess);
    let away = jets.point - points;
    let (value, slope) = (away.dot(&jets.first), jets.first.norm_squared() + away.dot(&jets.second));
    let growth = 3.0 * jets.first.dot(&jets.second) + away.dot(&third);
    let step = -2.0 * value * slope / (2.0 * slope * slope - value * growth);
    let t = guess + step;
    let inside = from.simd_le(t) & t.simd_le(from + 1.0) & step.abs().simd_lt(f64x4::splat(SHORT));
    let moved = jets.moved(step, third);
    // One of second order, where that was not all.
    let there = step.abs().simd_lt(f64x4::splat(SHORTEST));
    let away = moved.point - points;
    let more = -away.dot(&moved.first) / (moved.first.norm_squared() + away.dot(&moved.second));
    let further = moved.moved(more, third);
    let t = there.select(t, t + more);
    let jets = Jets { point: moved.point.or(there, &further.point), ..moved };
    let parameter = number(|bend| bend.centre) + number(|bend| bend.half) * t;
    (near & beside & inside, parameter, jets)
}

/// [`Path::at`](super::path::Path::at): position and three derivatives.
#[inline(always)]
fn along(bends: [Known<'_>; LANES], t: f64x4) -> (Jets, Vectors) {
    let paths = bends.map(|(_, path)| path.coefficients());
    let count = bends.map(|(_, path)| path.count()).into_iter().max().unwrap_or(0);
    let zero = Vectors { x: f64x4::ZERO, y: f64x4::ZERO };
    let [mut point, mut first, mut second, mut third] = [zero; 4];
    for index in (0..count).rev() {
        let coefficients = paths.map(|path| path[index].to_array());
        third = t * third + second;
        second = t * second + first;
        first = t * first + point;
        point = t * point + Vectors::of(coefficients.map(|[x, y]| crate::Vector2::new(x, y)));
    }
    let times = |factor: f64, vectors: Vectors| f64x4::splat(factor) * vectors;
    (Jets { point, first, second: times(2.0, second) }, times(6.0, third))
}
