//! Curves of segments (2.1, 7.2): arc length, tangent, curvature, certified nearest points.
//!
//! A [`Curve`] lives in the formation's frame; [`Placed`] looks at it from the frame in which the formation moves.
mod abreast;
mod along;
mod arc_table;
mod bend;
mod box_tree;
mod build;
mod candidates;
mod directed;
mod encroachment;
mod error;
mod excess;
mod extensions;
mod fragments;
mod graph;
mod least_sine;
mod level;
mod minimum;
mod nearest;
mod path;
mod piece;
mod placed;
mod primitive;
mod quadrature;
mod reach;
mod shape;
mod simple;
mod spline;
mod transit;
mod warm;
mod within;

pub(crate) use abreast::Feet;
pub(crate) use encroachment::united;
pub use encroachment::{Interval, encroached};
pub use error::CurveError;
pub use fragments::qualified_fragments;
pub use nearest::NearestSet;
pub use placed::Placed;
pub use reach::Reach;
pub use shape::CurveShape;
pub use transit::Transit;
pub use warm::Warm;

use nalgebra::Vector2;

/// A point of a curve with its frame, and its distance from the point that was asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Arc length from the curve's first point, m; negative or above the length on the extensions of open queues.
    pub arc_length: f64,
    /// The point, m.
    pub point: Vector2<f64>,
    /// Unit tangent, towards growing arc length.
    pub tangent: Vector2<f64>,
    /// Curvature, 1/m; positive turns left.
    pub curvature: f64,
    /// Distance from the point asked about, m.
    pub distance: f64,
}

/// A curve of finite length without self-intersections, perhaps closed, perhaps with open ends (Definition 2.1.2).
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    primitives: Vec<primitive::Primitive>,
    pieces: Vec<piece::Piece>,
    /// One for each piece if all are straight.
    straights: Vec<piece::Straight>,
    tree: box_tree::BoxTree,
    candidates: candidates::Candidates,
    /// Tells this curve from others, for what was learnt of it before.
    stamp: u64,
    length: f64,
    /// The greatest of the pieces, m.
    sagitta: f64,
    closed: bool,
    open_start: bool,
    open_end: bool,
}

impl Curve {
    /// Length between the end points, m; extensions of open queues do not count.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Whether the curve ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Arc lengths that belong to the curve: infinite at open ends.
    pub fn domain(&self) -> (f64, f64) {
        let from = if self.open_start { f64::NEG_INFINITY } else { 0.0 };
        (from, if self.open_end { f64::INFINITY } else { self.length })
    }

    /// Point, tangent and curvature at `arc_length` (m): round and round on a closed curve, along the tangent beyond
    /// open ends, at the end point beyond others. The distance is 0.
    pub fn at(&self, arc_length: f64) -> Foot {
        let (start, end) = self.domain();
        let wrapped = arc_length - libm::floor(arc_length / self.length) * self.length;
        let arc_length = if self.closed { wrapped } else { arc_length.clamp(start, end) };
        let on_curve = arc_length.clamp(0.0, self.length);
        let (index, parameter) = self.locate(on_curve);
        let jet = self.primitives[self.pieces[index].primitive].evaluate(parameter);
        let speed = jet.first.norm();
        let (tangent, beyond) = (jet.first / speed, arc_length - on_curve);
        let curvature = if beyond == 0.0 { jet.first.perp(&jet.second) / (speed * speed * speed) } else { 0.0 };
        Foot { arc_length, point: jet.point + beyond * tangent, tangent, curvature, distance: 0.0 }
    }

    /// The piece that an arc length lies on.
    fn piece_at(&self, arc_length: f64) -> usize {
        self.pieces.partition_point(|piece| piece.offset <= arc_length).saturating_sub(1)
    }

    /// Piece and parameter at an arc length between 0 and the length.
    fn locate(&self, arc_length: f64) -> (usize, f64) {
        let index = self.piece_at(arc_length);
        let piece = &self.pieces[index];
        let primitive = &self.primitives[piece.primitive];
        let wanted = (arc_length - piece.offset).clamp(0.0, piece.length);
        let mut parameter = piece.from + wanted / piece.length * (piece.to - piece.from);
        for _ in 0..4 {
            let error = piece.length_to(primitive, parameter) - wanted;
            let step = error / primitive.evaluate(parameter).first.norm();
            parameter = (parameter - step).clamp(piece.from, piece.to);
            if error.abs() <= 1e-15 * self.length {
                break;
            }
        }
        (index, parameter)
    }

    #[inline]
    fn arc_length_at(&self, index: usize, parameter: f64) -> f64 {
        let piece = &self.pieces[index];
        // Exactly there.
        if parameter == piece.from {
            return piece.offset;
        } else if parameter == piece.to {
            return piece.offset + piece.length;
        }
        piece.offset + piece.length_to(&self.primitives[piece.primitive], parameter)
    }

    /// First (or last) point and the tangent there.
    fn at_end(&self, last: bool) -> (Vector2<f64>, Vector2<f64>) {
        let piece = if last { &self.pieces[self.pieces.len() - 1] } else { &self.pieces[0] };
        let jet = self.primitives[piece.primitive].evaluate(if last { piece.to } else { piece.from });
        (jet.point, jet.first.normalize())
    }

    /// Index of the piece before piece `index`, round a closed curve.
    fn piece_before(&self, index: usize) -> usize {
        if index == 0 { self.pieces.len() - 1 } else { index - 1 }
    }

    /// Unit tangents before and after the start of piece `joint`; at an end of the curve both are the one there is.
    fn tangents_around(&self, joint: usize) -> (Vector2<f64>, Vector2<f64>) {
        let tangent = |index: usize, end: bool| {
            let piece = &self.pieces[index];
            let parameter = if end { piece.to } else { piece.from };
            self.primitives[piece.primitive].evaluate(parameter).first.normalize()
        };
        (tangent(self.piece_before(joint), true), tangent(joint % self.pieces.len(), false))
    }

    /// [`Self::tangents_around`], or nothing where the curve is not joined.
    fn tangents_at_joint(&self, joint: usize) -> Option<(Vector2<f64>, Vector2<f64>)> {
        (joint > 0 || self.closed).then(|| self.tangents_around(joint))
    }
}
