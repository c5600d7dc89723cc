//! Curves y = f(x) from expressions.
use super::build::{Span, finite};
use super::{error::CurveError, primitive::Primitive};
use trench_expression::{Expression, Rough, Roughness};

/// The graph of `function` over [from, to], and that it is not closed.
pub(super) fn primitive(function: &Expression, from: f64, to: f64) -> Result<(Vec<Span>, bool), CurveError> {
    let domain = (finite("the first x", from)?, finite("the last x", to)?);
    if from >= to {
        return Err(CurveError::Range { from, to });
    }
    match function.rough_points(from, to, 1).first() {
        Some(rough) => Err(refusal(function, rough)),
        None => Ok((vec![(Primitive::Graph { function: function.clone(), domain }, domain)], false)),
    }
}

fn refusal(function: &Expression, rough: &Rough) -> CurveError {
    let (problem, remedy) = match rough.roughness {
        Roughness::Value => ("is not finite", "choose a range where it is, or another function"),
        Roughness::Slope => ("jumps or is infinitely steep", "choose a range without this place, or another function"),
        Roughness::Curvature => {
            ("is not twice differentiable", "end the segment there and begin another, or round the corner off")
        }
    };
    let expression = function.source().to_owned();
    CurveError::NotSmooth { expression, problem, x: rough.x(), cause: rough.cause, column: rough.column, remedy }
}
