//! One obstacle that somebody told of.

use trench_formation::Vector2;
use trench_formation::hull::{HullError, Shape};
use trench_msgs::msg;

/// Checking whether a polygon crosses itself takes the square of its corners: of more than these the hull is taken
/// unchecked.
const MOST_CHECKED: usize = 256;

/// An obstacle's apparent one, and how it moves.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    pub(crate) id: u32,
    pub(crate) shape: Shape,
    /// m/s
    pub(crate) velocity: Vector2<f64>,
}

impl Known {
    /// Reads an obstacle, with what is wrong with it. A polygon that is none (it crosses itself or has no area) still
    /// says where something is: its hull is taken.
    ///
    /// # Errors
    /// With the reason, where nobody knows where the obstacle is.
    pub(crate) fn read(id: u32, message: &msg::Obstacle) -> Result<(Self, Option<String>), String> {
        let points: Vec<Vector2<f64>> = message.polygon.iter().map(|point| Vector2::new(point.x, point.y)).collect();
        let velocity = Vector2::new(message.velocity.x, message.velocity.y);
        if !(velocity.x.is_finite() && velocity.y.is_finite()) {
            return Err("its velocity is not finite".to_owned());
        }
        let whole = |problem: Option<String>| {
            let shape = Shape::enclosing(&points, message.radius).map_err(|error| error.to_string())?;
            Ok((Self { id, shape, velocity }, problem))
        };
        if points.len() > MOST_CHECKED {
            return whole(None);
        }
        match Shape::new(&points, message.radius) {
            Ok(shape) => Ok((Self { id, shape, velocity }, None)),
            Err(error @ (HullError::NoArea | HullError::SelfCrossing(..))) => {
                whole(Some(format!("{error}; its convex hull is taken")))
            }
            Err(error) => Err(error.to_string()),
        }
    }

    /// Its own hull.
    pub(crate) fn to_message(&self) -> msg::Obstacle {
        let outline = self.shape.outline();
        let point = |point: &Vector2<f64>| msg::Point2 { x: point.x, y: point.y };
        msg::Obstacle {
            id: self.id,
            polygon: outline.points.iter().map(point).collect(),
            radius: outline.radius,
            velocity: point(&self.velocity),
        }
    }

    /// The same obstacle `seconds` later; where it is, if it would be at no place that numbers can say.
    pub(crate) fn moved(&self, seconds: f64) -> Self {
        let by = self.velocity * seconds;
        let shape = if by == Vector2::zeros() { None } else { self.shape.moved(by).ok() };
        Self { shape: shape.unwrap_or_else(|| self.shape.clone()), ..*self }
    }
}
