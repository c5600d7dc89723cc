//! Certified nearest points of 10,000 points: polylines, on which the peers are exact, and splines through the same corners.
use crate::files::random;
use crate::output::Output;
use std::error::Error;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Warm};

const QUERIES: usize = 10_000;

/// A spiral, so that no straight piece says much about another.
fn corners(pieces: u32) -> Vec<Vector2<f64>> {
    let corner = |index: u32| {
        let share = f64::from(index) / f64::from(pieces);
        let (sine, cosine) = libm::sincos(4.0 * core::f64::consts::TAU * share);
        (20.0 + 80.0 * share + libm::sin(300.0 * share)) * Vector2::new(cosine, sine)
    };
    (0..=pieces).map(corner).collect()
}

pub(crate) fn measure(output: &mut Output) -> Result<(), Box<dyn Error>> {
    let mut state = 2;
    let mut spot = || 220.0 * Vector2::new(random(&mut state) - 0.5, random(&mut state) - 0.5);
    let queries: Vec<Vector2<f64>> = (0..QUERIES).map(|_| spot()).collect();
    // A robot's way: 10 cm between one question and the next.
    let step = |index: usize| {
        let (sine, cosine) = libm::sincos(0.002 * index as f64);
        (60.0 + 35.0 * libm::sin(0.0011 * index as f64)) * Vector2::new(cosine, sine)
    };
    let way: Vec<Vector2<f64>> = (0..QUERIES).map(step).collect();
    output.rows("queries.txt", queries.iter().map(|point| vec![point.x, point.y]))?;
    for pieces in [100, 2000] {
        let corners = corners(pieces);
        output.rows(&format!("corners_{pieces}.txt"), corners.iter().map(|corner| vec![corner.x, corner.y]))?;
        for (kind, shape) in
            [("polyline", CurveShape::Polyline(corners.clone())), ("spline", CurveShape::Spline(corners))]
        {
            let build = || Curve::new(&shape, false, false);
            let curve = output.time(&format!("curve: {kind} of {pieces}, built"), 5, 1, build)?;
            let name = format!("nearest: {kind} of {pieces}, anywhere");
            let all = |points: &[Vector2<f64>]| points.iter().map(|point| curve.nearest(*point)).collect::<Vec<_>>();
            let feet = output.time(&name, 15, QUERIES, || all(&queries));
            output.rows(
                &format!("{kind}_{pieces}.txt"),
                feet.iter().map(|foot| vec![foot.point.x, foot.point.y, foot.distance]),
            )?;
            let cold = output.time(&format!("nearest: {kind} of {pieces}, along a way"), 15, QUERIES, || all(&way));
            let warm = output.time(&format!("nearest: {kind} of {pieces}, warm"), 15, QUERIES, || {
                let mut warm = Warm::default();
                way.iter().map(|point| curve.nearest_again(*point, &mut warm)).collect::<Vec<_>>()
            });
            assert_eq!(cold, warm, "a warm start changes nothing");
        }
    }
    Ok(())
}
