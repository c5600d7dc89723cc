//! Whether the extensions of an open queue meet the curve, or each other: they are straight and never end (2.1).
use super::piece::Piece;
use super::primitive::Primitive;
use super::simple::{TOUCH, meeting};
use super::{Curve, error::CurveError};
use nalgebra::Vector2;

/// Error if what lies beyond an open end meets the curve or what lies beyond the other end.
pub(super) fn check(curve: &Curve) -> Result<(), CurveError> {
    // Beyond its ends a graph goes on to where nothing of it is.
    if let [only] = curve.primitives.as_slice()
        && only.is_graph()
    {
        return Ok(());
    }
    let [start, end] =
        [(curve.open_start, false), (curve.open_end, true)].map(|(open, last)| open.then(|| Ray::beyond(curve, last)));
    for (ray, end) in [(&start, "start"), (&end, "end")] {
        if let Some((beyond, arc_length)) = ray.as_ref().and_then(|ray| ray.meets(curve)) {
            return Err(CurveError::OpenEndMeets { end, beyond, arc_length });
        }
    }
    match start.zip(end).and_then(|(start, end)| start.crosses(&end, curve.length)) {
        Some((before, behind)) => Err(CurveError::OpenEndsMeet { before, behind }),
        None => Ok(()),
    }
}

/// What lies beyond an open end.
struct Ray {
    from: Vector2<f64>,
    /// Unit vector, away from the curve.
    outward: Vector2<f64>,
    /// The piece that it goes on from, which turns too little to come back to it.
    own: usize,
}

impl Ray {
    fn beyond(curve: &Curve, last: bool) -> Self {
        let (from, tangent) = curve.at_end(last);
        let own = if last { curve.pieces.len() - 1 } else { 0 };
        Self { from, outward: if last { tangent } else { -tangent }, own }
    }

    /// How far beyond the end it meets the curve, and the arc length there, m.
    fn meets(&self, curve: &Curve) -> Option<(f64, f64)> {
        let primitive = Primitive::Line { start: self.from, direction: self.outward };
        let others = || curve.pieces.iter().enumerate().filter(|(index, _)| *index != self.own).map(|(_, piece)| piece);
        // Farther out than all of the curve it meets nothing.
        let far = |piece: &Piece| (piece.start - self.from).norm().max((piece.end - self.from).norm()) + piece.sagitta;
        let length = others().map(far).fold(0.0, f64::max);
        let ray = Piece {
            primitive: 0,
            from: 0.0,
            to: length,
            offset: 0.0,
            length,
            start: self.from,
            end: self.from + length * self.outward,
            sagitta: 0.0,
            bend: None,
        };
        let end = if self.own == 0 { 0.0 } else { curve.length };
        let counts = |beyond: f64, arc_length: f64| !curve.is_beside(end, arc_length) || beyond > TOUCH * curve.length;
        others().find_map(|piece| {
            meeting(curve.length, (&primitive, &ray), (&curve.primitives[piece.primitive], piece), counts)
        })
    }

    /// How far from the ends two of them cross, m. Those that are parallel but for rounding, so that they would cross farther away than a
    /// thousand million lengths of the curve, do not; if they lie on one line, [`Self::meets`] has told.
    fn crosses(&self, other: &Self, length: f64) -> Option<(f64, f64)> {
        let (between, sine) = (other.from - self.from, self.outward.perp(&other.outward));
        let (here, there) = (between.perp(&other.outward) / sine, between.perp(&self.outward) / sine);
        let meets = |far: f64| far >= 0.0 && far <= length / TOUCH;
        (meets(here) && meets(there)).then_some((here, there))
    }
}
