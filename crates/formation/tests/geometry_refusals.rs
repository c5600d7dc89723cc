//! What is no segment and what is one: short waves, sizes, extensions that meet (2.1, Definition 2.1.2).
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may fail by a panic in a function of its own")]
use core::f64::consts::{PI, TAU};
use nalgebra::Vector2;
use trench_expression::Expression;
use trench_formation::curve::{Curve, CurveShape};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn wave(length: f64, wavelength: f64, amplitude: f64) -> CurveShape {
    CurveShape::Sinusoid { origin: at(0.0, 0.0), direction: 0.3, length, amplitude, wavelength, phase: 0.2 }
}

fn graph(text: &str, from: f64, to: f64) -> CurveShape {
    CurveShape::Graph { function: Expression::parse(text).unwrap(), from, to }
}

/// The wave of that many periods, along which the lengths of all are the same.
fn is_as_long_as_its_periods(shape: CurveShape, one: CurveShape, periods: f64) {
    let length =
        |shape: &CurveShape| Curve::new(shape, false, false).unwrap_or_else(|error| panic!("{error}")).length();
    let (found, expected) = (length(&shape), periods * length(&one));
    assert!((found - expected).abs() < 1e-9 * expected, "{found}, not {expected}");
}

/// Definition 2.1.2 knows no shortest wave; the rounding of a parameter that is large against the wave is no cusp, and no meeting.
#[test]
fn short_waves_are_segments() {
    is_as_long_as_its_periods(wave(20.0, 0.2, 1.0), wave(0.2, 0.2, 1.0), 100.0);
    is_as_long_as_its_periods(wave(1000.0, 1.0, 1.0), wave(1.0, 1.0, 1.0), 1000.0);
    let period = TAU / 300.0;
    is_as_long_as_its_periods(
        graph("sin(300*x)", -400.0 * period, 400.0 * period),
        graph("sin(300*x)", 0.0, period),
        800.0,
    );
    assert!(Curve::new(&graph("sin(300*x)", -9.0, 9.0), true, true).is_ok());
    assert!(Curve::new(&graph("sin(x + 1000000)", -9.0, 9.0), false, false).is_ok());
    // A spline through as many waves is no graph, and judged by its pieces.
    let knots = (0..4000).map(|index| 0.005 * f64::from(index)).map(|x| at(x, libm::sin(TAU * x / 0.2)));
    assert!(Curve::new(&CurveShape::Spline(knots.collect()), false, false).is_ok());
}

fn refused(shape: &CurveShape, (open_start, open_end): (bool, bool), expected: &str) {
    match Curve::new(shape, open_start, open_end).map_err(|error| error.to_string()) {
        Err(text) => assert!(text.contains(expected) && text.len() < 250, "{text}"),
        Ok(curve) => panic!("{curve:?} is no segment: {expected}"),
    }
}

const CLOSED: (bool, bool) = (false, false);

#[test]
fn sizes_are_named() {
    refused(&wave(1.0, 1.0, 1e200), CLOSED, "the amplitude is 1e200, but must be from 1e-12 to 1e12");
    refused(&CurveShape::Line(at(0.0, 0.0), at(1e308, 0.0)), CLOSED, "a point is 1e308");
    refused(&CurveShape::Spline(vec![at(0.0, 0.0), at(1e200, 1.0), at(0.0, 1e200)]), CLOSED, "a point is 1e200");
    let arc = |radius: f64| CurveShape::Arc { centre: at(0.0, 0.0), radius, start_angle: 0.0, sweep: 1.0 };
    refused(&arc(1e200), CLOSED, "the radius is 1e200");
    refused(&arc(1e-200), CLOSED, "the radius is 1e-200");
    refused(&graph("1e200*x", 0.0, 1.0), CLOSED, "the slope of the curve is 1e200");
    refused(&graph("1e13*x", 0.0, 1.0), CLOSED, "the length of the curve is 1e13");
}

/// An answer comes soon, whatever is asked.
#[test]
fn too_many_waves_are_refused() {
    refused(&wave(1000.0, 0.01, 1.0), CLOSED, "takes more than 100000 pieces");
    refused(&graph("sin(3000*x)", -9.0, 9.0), CLOSED, "take fewer and longer waves");
}

/// What goes on for ever may meet nothing.
#[test]
fn extensions_that_meet_the_curve_are_refused() {
    let hook = CurveShape::Polyline(vec![at(0.0, 0.0), at(20.0, 0.0), at(20.0, 10.0), at(5.0, 10.0), at(5.0, 5.0)]);
    let meets =
        "beyond its open end the queue goes straight on for ever, and after 5 m meets the curve (at 5 m of its length)";
    refused(&hook, (false, true), meets);
    refused(&hook, (false, true), "set open_end to false");
    assert!(Curve::new(&hook, true, false).is_ok());
    let reversed = CurveShape::Polyline(vec![at(5.0, 5.0), at(5.0, 10.0), at(20.0, 10.0), at(20.0, 0.0), at(0.0, 0.0)]);
    refused(
        &reversed,
        (true, false),
        "beyond its open start the queue goes straight on for ever, and after 5 m meets the curve (at 45 m",
    );
    // Its last point on the first piece's line, facing the first point.
    let facing = CurveShape::Polyline(vec![at(0.0, 0.0), at(0.0, 5.0), at(9.0, 5.0), at(9.0, 0.0), at(5.0, 0.0)]);
    refused(&facing, (false, true), "after 5 m meets the curve");
    // A spiral, curved all along.
    let spiral: Vec<Vector2<f64>> =
        (0..60).map(|index| 0.2 * f64::from(index)).map(|turn| turn * at(libm::cos(turn), libm::sin(turn))).collect();
    assert!(Curve::new(&CurveShape::Spline(spiral.clone()), false, true).is_ok());
    refused(&CurveShape::Spline(spiral), (true, false), "beyond its open start");
}

#[test]
fn extensions_that_meet_each_other_are_refused() {
    let arc = |sweep: f64| CurveShape::Arc { centre: at(0.0, 0.0), radius: 2.0, start_angle: 0.4, sweep };
    for sweep in [5.5_f64, -5.5, 4.0, 3.2] {
        // The two tangents of an arc cross as far from one end as from the other.
        let far = 2.0 * libm::tan(0.5 * (TAU - sweep.abs()));
        refused(&arc(sweep), (true, true), "the two ways cross");
        refused(&arc(sweep), (true, true), &format!("{far:.12}")[..7]);
    }
    for sweep in [5.5, -5.5, 4.0] {
        assert!(Curve::new(&arc(sweep), true, false).is_ok() && Curve::new(&arc(sweep), false, true).is_ok());
    }
    // Parallel, but for rounding, or apart.
    for sweep in [PI, -PI, 3.1, 0.1] {
        assert!(Curve::new(&arc(sweep), true, true).is_ok(), "{sweep}");
    }
    let horseshoe = CurveShape::Polyline(vec![at(0.0, 0.0), at(3.0, 0.1), at(3.0, 2.0), at(0.0, 2.0)]);
    assert!(Curve::new(&horseshoe, true, true).is_ok());
}
