//! The linearised robot r'' = u, (3.4).
use crate::Vector2;

/// State of a double integrator in frame `map`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// r, metres.
    pub position: Vector2<f64>,
    /// dr/dt, m/s.
    pub velocity: Vector2<f64>,
}

impl PointState {
    /// At rest at `position`.
    pub fn at_rest(position: Vector2<f64>) -> Self {
        Self { position, velocity: Vector2::zeros() }
    }

    /// Carried on by its velocity for `duration` (s): what others expect of it.
    #[must_use]
    #[inline]
    pub fn coasted(self, duration: f64) -> Self {
        Self { position: self.position + duration * self.velocity, ..self }
    }

    /// Exact solution after `duration` (s) of constant `acceleration`.
    #[must_use]
    pub fn advanced(self, acceleration: Vector2<f64>, duration: f64) -> Self {
        Self {
            position: self.position + duration * self.velocity + 0.5 * duration * duration * acceleration,
            velocity: self.velocity + duration * acceleration,
        }
    }

    /// Semi-implicit Euler: new velocity first, position with it. Keeps the energy of stiff zoning walls bounded, which
    /// the runs with obstacles of chapter 7 need.
    #[must_use]
    #[inline]
    pub fn advanced_semi_implicit(self, acceleration: Vector2<f64>, duration: f64) -> Self {
        let velocity = self.velocity + duration * acceleration;
        Self { position: self.position + duration * velocity, velocity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fall() {
        let down = Vector2::new(0.0, -10.0);
        let start = PointState { position: Vector2::new(0.0, 5.0), velocity: Vector2::new(1.0, 0.0) };
        let end = start.advanced(down, 1.0);
        assert_eq!((end.position, end.velocity), (Vector2::new(1.0, 0.0), Vector2::new(1.0, -10.0)));
        assert_eq!(start.advanced_semi_implicit(down, 1.0).position, Vector2::new(1.0, -5.0));
    }
}
