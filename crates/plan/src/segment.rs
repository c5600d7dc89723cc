//! `trench_msgs/Segment` to the theory's curve and back.

use trench_expression::{Expression, ExpressionError};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveError, CurveShape};
use trench_msgs::msg::{Point2, Segment};

/// Why a segment message is no curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SegmentError {
    /// A kind this version does not know.
    #[error("segment kind {0} is unknown")]
    Kind(u8),
    /// Too few points or values for the kind.
    #[error("a segment of kind {kind} needs {expected}")]
    Incomplete {
        /// One of `Segment::KIND_*`.
        kind: u8,
        /// What it needs.
        expected: &'static str,
    },
    /// The curve itself is impossible.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The expression is none.
    #[error("the expression {0}")]
    Expression(#[from] ExpressionError),
}

/// The curve of a segment message.
///
/// # Errors
/// When the message describes none.
pub fn curve_from_message(segment: &Segment) -> Result<Curve, SegmentError> {
    Ok(Curve::new(&shape_from_message(segment)?, segment.open_start, segment.open_end)?)
}

/// The description of a segment message's curve.
///
/// # Errors
/// When points or values are missing, or the kind is unknown.
pub fn shape_from_message(segment: &Segment) -> Result<CurveShape, SegmentError> {
    let points: Vec<Vector2<f64>> = segment.points.iter().map(|point| Vector2::new(point.x, point.y)).collect();
    let incomplete = |expected| SegmentError::Incomplete { kind: segment.kind, expected };
    match (segment.kind, points.as_slice(), segment.values.as_slice()) {
        (Segment::KIND_LINE, &[from, to], _) => Ok(CurveShape::Line(from, to)),
        (Segment::KIND_LINE, ..) => Err(incomplete("two points")),
        (Segment::KIND_POLYLINE, ..) => Ok(CurveShape::Polyline(points)),
        (Segment::KIND_SPLINE, ..) => Ok(CurveShape::Spline(points)),
        (Segment::KIND_BEZIER, ..) => Ok(CurveShape::Bezier(points)),
        (Segment::KIND_ARC, &[centre], &[radius, start_angle, sweep]) => {
            Ok(CurveShape::Arc { centre, radius, start_angle, sweep })
        }
        (Segment::KIND_ARC, ..) => Err(incomplete("a centre, a radius, a start angle and a sweep")),
        (Segment::KIND_ELLIPSE, &[centre], &[a, b, rotation]) => {
            Ok(CurveShape::Ellipse { centre, semi_axes: [a, b], rotation })
        }
        (Segment::KIND_ELLIPSE, ..) => Err(incomplete("a centre, two semi-axes and a rotation")),
        (Segment::KIND_SINUSOID, &[origin], &[direction, length, amplitude, wavelength, phase]) => {
            Ok(CurveShape::Sinusoid { origin, direction, length, amplitude, wavelength, phase })
        }
        (Segment::KIND_SINUSOID, ..) => {
            Err(incomplete("an origin, a direction, a length, an amplitude, a wavelength and a phase"))
        }
        (Segment::KIND_GRAPH, _, &[from, to]) => {
            Ok(CurveShape::Graph { function: Expression::parse(&segment.expression)?, from, to })
        }
        (Segment::KIND_GRAPH, ..) => Err(incomplete("an expression, the first x and the last x")),
        (kind, ..) => Err(SegmentError::Kind(kind)),
    }
}

/// The message of a curve's description.
pub fn message_from_shape(shape: &CurveShape, open_start: bool, open_end: bool) -> Segment {
    let (kind, points, values) = match shape {
        CurveShape::Line(from, to) => (Segment::KIND_LINE, vec![*from, *to], vec![]),
        CurveShape::Polyline(corners) => (Segment::KIND_POLYLINE, corners.clone(), vec![]),
        CurveShape::Spline(knots) => (Segment::KIND_SPLINE, knots.clone(), vec![]),
        CurveShape::Bezier(control) => (Segment::KIND_BEZIER, control.clone(), vec![]),
        &CurveShape::Arc { centre, radius, start_angle, sweep } => {
            (Segment::KIND_ARC, vec![centre], vec![radius, start_angle, sweep])
        }
        &CurveShape::Ellipse { centre, semi_axes: [a, b], rotation } => {
            (Segment::KIND_ELLIPSE, vec![centre], vec![a, b, rotation])
        }
        &CurveShape::Sinusoid { origin, direction, length, amplitude, wavelength, phase } => {
            (Segment::KIND_SINUSOID, vec![origin], vec![direction, length, amplitude, wavelength, phase])
        }
        &CurveShape::Graph { from, to, .. } => (Segment::KIND_GRAPH, vec![], vec![from, to]),
    };
    let points = points.iter().map(|point| Point2 { x: point.x, y: point.y }).collect();
    let expression = match shape {
        CurveShape::Graph { function, .. } => function.source().to_owned(),
        _ => String::new(),
    };
    Segment { kind, points, values, expression, open_start, open_end }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_goes_there_and_back() {
        let point = Vector2::new;
        let shapes = [
            CurveShape::Line(point(0.0, 0.0), point(1.0, 0.0)),
            CurveShape::Polyline(vec![point(0.0, 0.0), point(1.0, 0.0), point(1.0, 1.0)]),
            CurveShape::Spline(vec![point(0.0, 0.0), point(1.0, 0.5), point(2.0, 0.0)]),
            CurveShape::Bezier(vec![point(0.0, 0.0), point(1.0, 0.0), point(1.0, 1.0), point(2.0, 1.0)]),
            CurveShape::Arc { centre: point(0.0, 0.0), radius: 1.0, start_angle: 0.5, sweep: -1.0 },
            CurveShape::Ellipse { centre: point(0.0, 0.0), semi_axes: [2.0, 1.0], rotation: 0.3 },
            CurveShape::Sinusoid {
                origin: point(0.0, 1.0),
                direction: 0.1,
                length: 3.0,
                amplitude: 0.2,
                wavelength: 1.0,
                phase: 0.4,
            },
            CurveShape::Graph { function: Expression::parse("0.3*sin(2*x)").unwrap(), from: -1.0, to: 2.0 },
        ];
        for shape in shapes {
            let message = message_from_shape(&shape, false, false);
            assert_eq!(shape_from_message(&message).unwrap(), shape);
            assert!(curve_from_message(&message).is_ok());
        }
    }

    #[test]
    fn what_is_missing_is_named() {
        let check = |segment: Segment, expected: &str| {
            assert_eq!(shape_from_message(&segment).unwrap_err().to_string(), expected);
        };
        check(Segment::default(), "a segment of kind 0 needs two points");
        check(
            Segment { kind: Segment::KIND_ARC, ..Segment::default() },
            "a segment of kind 2 needs a centre, a radius, a start angle and a sweep",
        );
        let graph = |expression: &str| Segment {
            kind: Segment::KIND_GRAPH,
            values: vec![0.0, 1.0],
            expression: expression.to_owned(),
            ..Segment::default()
        };
        check(graph("2 x"), "the expression does not parse at column 3: found `x`, expected an operator or the end");
        check(
            Segment { values: vec![], ..graph("x") },
            "a segment of kind 7 needs an expression, the first x and the last x",
        );
        check(Segment { kind: 99, ..Segment::default() }, "segment kind 99 is unknown");
    }
}
