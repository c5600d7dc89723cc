//! Curves y = f(x) from expressions.
use super::build::{Span, finite};
use super::{error::CurveError, primitive::Primitive};
use trench_expression::{Expression, Rough, Roughness};

/// Derivatives on the two sides of a place of no extent that differ by this, and this share of them, differ.
const JUMP: f64 = 1e-3;

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

/// Whether slope or second derivative are clearly different on the two sides of a place: elsewhere the place may be smooth, and only intervals
/// cannot tell, as at 0 for x^2*abs(x).
fn bends_at_once(function: &Expression, rough: &Rough) -> bool {
    let (before, behind) = (function.series_from_left::<3>(rough.low), function.series::<f64, 3>(rough.high));
    let jumps = |order: usize| {
        let (before, behind): (f64, f64) = (before.0[order], behind.0[order]);
        (before - behind).abs() > JUMP * (1.0 + before.abs().max(behind.abs()))
    };
    jumps(1) || jumps(2)
}

fn refusal(function: &Expression, rough: &Rough) -> CurveError {
    let (problem, remedy) = match rough.roughness {
        Roughness::Value => ("is not finite", "choose a range where it is, or another function"),
        Roughness::Slope => ("jumps or is infinitely steep", "choose a range without this place, or another function"),
        Roughness::Curvature if bends_at_once(function, rough) => {
            ("is not twice differentiable", "end the segment there and begin another, or round the corner off")
        }
        Roughness::Curvature => (
            "could not be shown to be twice differentiable",
            "end the segment there, or write it without what causes this, as sqrt(x^2 + 1e-6) for abs(x)",
        ),
    };
    let expression = function.source().to_owned();
    CurveError::NotSmooth {
        expression,
        problem,
        x: function.shown(rough),
        cause: rough.cause,
        column: rough.column,
        remedy,
    }
}
