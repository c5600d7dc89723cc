//! Formations made larger or smaller about the origin of their frame.

use crate::ChainPlaces;
use crate::plan::{Motion, Place, Plan, QueuePlan};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveError, CurveShape};

impl Plan {
    /// The formation with all its lengths times `factor` (positive): segments, vertices, places, and the speed of the
    /// virtual points, so that they take as long as before. Tolerances stay.
    ///
    /// # Errors
    /// Where a segment of that size is no curve.
    pub fn scaled(&self, factor: f64) -> Result<Self, CurveError> {
        let motion = Motion { speed: factor * self.motion.speed, ..self.motion };
        let queues = self.queues.iter().map(|queue| queue.scaled(factor)).collect::<Result<_, _>>()?;
        Ok(Self { motion, queues, ..self.clone() })
    }
}

impl QueuePlan {
    fn scaled(&self, factor: f64) -> Result<Self, CurveError> {
        let (from, to) = self.curve.domain();
        let shape = scaled_shape(&self.shape, factor)?;
        let curve = Curve::new(&shape, from.is_infinite(), to.is_infinite())?;
        let place = |place: &Place| Place { start: factor * place.start, end: factor * place.end };
        Ok(Self {
            vertices: self.vertices.iter().map(|vertex| factor * vertex).collect(),
            chain: self.chain.map(|chain| ChainPlaces { spacing: factor * chain.spacing, ..chain }),
            places: self.places.iter().map(place).collect(),
            shape,
            curve,
            ..self.clone()
        })
    }
}

fn scaled_shape(shape: &CurveShape, factor: f64) -> Result<CurveShape, CurveError> {
    let all = |points: &[Vector2<f64>]| points.iter().map(|point| factor * point).collect();
    Ok(match shape {
        CurveShape::Line(from, to) => CurveShape::Line(factor * from, factor * to),
        CurveShape::Polyline(points) => CurveShape::Polyline(all(points)),
        CurveShape::Spline(points) => CurveShape::Spline(all(points)),
        CurveShape::Bezier(points) => CurveShape::Bezier(all(points)),
        &CurveShape::Arc { centre, radius, start_angle, sweep } => {
            CurveShape::Arc { centre: factor * centre, radius: factor * radius, start_angle, sweep }
        }
        &CurveShape::Ellipse { centre, semi_axes: [a, b], rotation } => {
            CurveShape::Ellipse { centre: factor * centre, semi_axes: [factor * a, factor * b], rotation }
        }
        &CurveShape::Sinusoid { origin, direction, length, amplitude, wavelength, phase } => CurveShape::Sinusoid {
            origin: factor * origin,
            direction,
            length: factor * length,
            amplitude: factor * amplitude,
            wavelength: factor * wavelength,
            phase,
        },
        CurveShape::Graph { function, from, to } => {
            CurveShape::Graph { function: function.scaled(factor)?, from: factor * from, to: factor * to }
        }
    })
}
