//! 10,000 polygons of 12 points, 1 m to 4 m across, on a square kilometre, combined to the fixpoint with a clearance of 1 m.
use crate::files::random;
use crate::output::Output;
use std::error::Error;
use trench_formation::Vector2;
use trench_formation::hull::{HullError, Obstacle, Shape, combine};

fn polygons() -> Vec<Vec<Vector2<f64>>> {
    let mut state = 1;
    let polygon = |_| {
        let centre = 1000.0 * Vector2::new(random(&mut state), random(&mut state));
        let corner = |index: i32| {
            let (sine, cosine) = libm::sincos(core::f64::consts::TAU * f64::from(index) / 12.0);
            centre + (0.5 + 1.5 * random(&mut state)) * Vector2::new(cosine, sine)
        };
        (0..12).map(corner).collect()
    };
    (0..10_000).map(polygon).collect()
}

fn obstacles(polygons: &[Vec<Vector2<f64>>]) -> Result<Vec<Obstacle>, HullError> {
    let obstacle = |(id, corners): (u32, &Vec<Vector2<f64>>)| Ok(Obstacle { id, shape: Shape::new(corners, 0.0)? });
    (0..).zip(polygons).map(obstacle).collect()
}

pub(crate) fn measure(output: &mut Output) -> Result<(), Box<dyn Error>> {
    let polygons = polygons();
    let made = output.time("hulls: polygons to shapes", 15, 1, || obstacles(&polygons))?;
    let combined = output.time("hulls: combined to the fixpoint", 15, 1, || combine(&made, 1.0))?;
    let flat = |points: &[Vector2<f64>]| points.iter().flat_map(|point| [point.x, point.y]).collect::<Vec<f64>>();
    output.rows("polygons.txt", polygons.iter().map(|polygon| flat(polygon)))?;
    output.rows("hulls.txt", combined.iter().map(|hull| flat(hull.shape.outline().points)))?;
    output.rows("members.txt", combined.iter().map(|hull| hull.members.iter().map(|id| f64::from(*id)).collect()))
}
