//! From a description to primitives and pieces.
use super::{
    Curve,
    box_tree::BoxTree,
    candidates::Candidates,
    error::CurveError,
    extensions, graph,
    piece::{LARGEST, Piece, Straight, cut},
    primitive::Primitive,
    shape::CurveShape,
    simple, spline,
};
use core::f64::consts::TAU;
use nalgebra::Vector2;

/// Joints where the tangent turns by less than this (rad) are smooth: rounding turns it so far.
const SMOOTH: f64 = 1e-9;

/// A primitive and its parameter interval.
pub(super) type Span = (Primitive, (f64, f64));

impl Curve {
    /// Builds the curve. `open_start` and `open_end` let it extend beyond its first and last point along the tangent
    /// there (an open queue).
    ///
    /// # Errors
    /// See [`CurveError`]: numbers that are not finite, length zero, too few points, cusps, self-intersections.
    pub fn new(shape: &CurveShape, open_start: bool, open_end: bool) -> Result<Self, CurveError> {
        let (spans, closed) = spans(shape)?;
        if closed && (open_start || open_end) {
            return Err(CurveError::ClosedCurveExtended);
        }
        let (mut pieces, mut primitives, mut length) = (Vec::new(), Vec::new(), 0.0);
        for (index, (primitive, interval)) in spans.into_iter().enumerate() {
            length = cut(&primitive, index, interval, length, &mut pieces)?;
            primitives.push(primitive);
        }
        let length = sized("the length of the curve", length)?;
        let tree = BoxTree::new(&pieces);
        let stamp = stamp(&pieces);
        let candidates = Candidates::default();
        let sagitta = pieces.iter().fold(0.0, |most: f64, piece| most.max(piece.sagitta));
        let straight = |piece: &Piece| Straight::of(&primitives[piece.primitive]);
        let straights = pieces.iter().map(straight).collect::<Option<Vec<_>>>().unwrap_or_default();
        let mut curve = Self {
            primitives,
            pieces,
            straights,
            tree,
            candidates,
            stamp,
            length,
            sagitta,
            closed,
            open_start,
            open_end,
        };
        simple::check(&curve)?;
        extensions::check(&curve)?;
        curve.candidates = Candidates::new(&curve.pieces, length);
        for index in 0..curve.pieces.len() {
            let shielded = curve.shielded(index);
            if let Some(bend) = &mut curve.pieces[index].bend {
                bend.learn(shielded);
            }
        }
        Ok(curve)
    }

    /// How far from the middle of a piece points may be, m, for the pieces beside it to be no nearer than the joints, if its own slopes
    /// say that these are farther than something in between; 0 at corners.
    fn shielded(&self, index: usize) -> f64 {
        let piece = &self.pieces[index];
        let Some(bend) = &piece.bend else { return 0.0 };
        let [before, after] = self.beside(index);
        let side = |other: Option<usize>, end: bool| {
            let Some(other) = other else { return f64::INFINITY };
            let (joint, corner) = if end { (index + 1, piece.end) } else { (index, piece.start) };
            let (one, next) = self.tangents_around(joint);
            if one.perp(&next).abs() > SMOOTH || one.dot(&next) < 0.0 {
                return 0.0;
            }
            let other = &self.pieces[other];
            other.shields(&self.primitives[other.primitive], !end) - (bend.middle.jet.point - corner).norm()
        };
        side(before, false).min(side(after, true))
    }
}

/// A hash (Fowler, Noll and Vo) of where the pieces are.
fn stamp(pieces: &[Piece]) -> u64 {
    let numbers = pieces.iter().flat_map(|piece| {
        let Piece { from, to, offset, start, end, .. } = piece;
        [*from, *to, *offset, start.x, start.y, end.x, end.y]
    });
    let mix = |hash: u64, number: f64| (hash ^ number.to_bits()).wrapping_mul(0x0100_0000_01b3);
    // Never 0, which stands for no curve.
    numbers.fold(0xcbf2_9ce4_8422_2325, mix).max(1)
}

/// Primitives in order, and whether the last ends where the first begins.
fn spans(shape: &CurveShape) -> Result<(Vec<Span>, bool), CurveError> {
    match shape {
        CurveShape::Line(start, end) => Ok((lines(&[*start, *end])?, false)),
        CurveShape::Polyline(corners) => {
            at_least_two("a polyline", corners)?;
            Ok((lines(corners)?, corners.first() == corners.last()))
        }
        CurveShape::Spline(knots) => {
            at_least_two("a spline", knots)?;
            apart(knots)?;
            let pieces = spline::natural_cubic(knots).into_iter().map(|cubic| (cubic, (0.0, 1.0))).collect();
            Ok((pieces, knots.first() == knots.last()))
        }
        CurveShape::Bezier(control) => bezier(control),
        &CurveShape::Arc { centre, radius, start_angle, sweep } => arc(centre, radius, start_angle, sweep),
        &CurveShape::Ellipse { centre, semi_axes: [a, b], rotation } => {
            all_finite("a point", &[centre])?;
            let (a, b) = (positive("the first semi-axis", a)?, positive("the second semi-axis", b)?);
            let direction = unit(finite("the rotation", rotation)?);
            let primitive = Primitive::Ellipse { centre, cosine: a * direction, sine: b * left_of(direction) };
            Ok((vec![(primitive, (0.0, TAU))], true))
        }
        &CurveShape::Sinusoid { origin, direction, length, amplitude, wavelength, phase } => {
            all_finite("a point", &[origin])?;
            let along = unit(finite("the direction", direction)?);
            let length = positive("the length", length)?;
            let wave_number = TAU / positive("the wavelength", wavelength)?;
            let amplitude = finite("the amplitude", amplitude)?;
            if amplitude != 0.0 {
                sized("the amplitude", amplitude.abs())?;
            }
            let across = amplitude * left_of(along);
            let phase = finite("the phase", phase)?;
            Ok((vec![(Primitive::Sinusoid { origin, along, across, wave_number, phase }, (0.0, length))], false))
        }
        CurveShape::Graph { function, from, to } => graph::primitive(function, *from, *to),
    }
}

fn lines(corners: &[Vector2<f64>]) -> Result<Vec<Span>, CurveError> {
    apart(corners)?;
    let line = |pair: &[Vector2<f64>]| {
        let (start, chord) = (pair[0], pair[1] - pair[0]);
        let length = chord.norm();
        (Primitive::Line { start, direction: chord / length }, (0.0, length))
    };
    Ok(corners.windows(2).map(line).collect())
}

fn bezier(control: &[Vector2<f64>]) -> Result<(Vec<Span>, bool), CurveError> {
    if control.len() < 4 || control.len() % 3 != 1 {
        let expected = "4, 7, 10, ... (3 n + 1)";
        return Err(CurveError::PointCount { shape: "a Bezier curve", got: control.len(), expected });
    }
    all_finite("a control point", control)?;
    let piece = |i: usize| [control[i], control[i + 1], control[i + 2], control[i + 3]];
    let cubics = (0..control.len() - 1).step_by(3).map(|i| (Primitive::bezier(piece(i)), (0.0, 1.0))).collect();
    Ok((cubics, control.first() == control.last()))
}

fn arc(centre: Vector2<f64>, radius: f64, start_angle: f64, sweep: f64) -> Result<(Vec<Span>, bool), CurveError> {
    all_finite("the centre", &[centre])?;
    let radius = positive("the radius", radius)?;
    let start = unit(finite("the start angle", start_angle)?);
    let turned = finite("the sweep", sweep)?.abs();
    if turned == 0.0 || turned > TAU * (1.0 + 1e-12) {
        return Err(CurveError::Sweep(sweep));
    }
    let sine = radius * sweep.signum() * left_of(start);
    let primitive = Primitive::Ellipse { centre, cosine: radius * start, sine };
    Ok((vec![(primitive, (0.0, turned))], turned >= TAU * (1.0 - 1e-12)))
}

fn at_least_two(shape: &'static str, points: &[Vector2<f64>]) -> Result<(), CurveError> {
    let expected = "two or more";
    if points.len() < 2 { Err(CurveError::PointCount { shape, got: points.len(), expected }) } else { Ok(()) }
}

fn apart(points: &[Vector2<f64>]) -> Result<(), CurveError> {
    all_finite("a point", points)?;
    match points.windows(2).position(|pair| (pair[1] - pair[0]).norm() == 0.0) {
        Some(first) => Err(CurveError::RepeatedPoint(first, first + 1)),
        None => Ok(()),
    }
}

fn all_finite(what: &'static str, points: &[Vector2<f64>]) -> Result<(), CurveError> {
    points.iter().flat_map(|point| [point.x, point.y]).try_for_each(|coordinate| {
        let coordinate = finite(what, coordinate)?;
        if coordinate.abs() <= LARGEST { Ok(()) } else { Err(CurveError::Size { what, value: coordinate }) }
    })
}

pub(super) fn finite(what: &'static str, value: f64) -> Result<f64, CurveError> {
    if value.is_finite() { Ok(value) } else { Err(CurveError::NotFinite { what }) }
}

fn positive(what: &'static str, value: f64) -> Result<f64, CurveError> {
    if finite(what, value)? > 0.0 { sized(what, value) } else { Err(CurveError::NotPositive { what, value }) }
}

/// A length whose square is a number, and from which a millimetre is not lost in rounding.
fn sized(what: &'static str, value: f64) -> Result<f64, CurveError> {
    let is_length = (1.0 / LARGEST..=LARGEST).contains(&value);
    if is_length { Ok(value) } else { Err(CurveError::Size { what, value }) }
}

fn unit(angle: f64) -> Vector2<f64> {
    let (sine, cosine) = libm::sincos(angle);
    Vector2::new(cosine, sine)
}

fn left_of(direction: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-direction.y, direction.x)
}
