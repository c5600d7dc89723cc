//! Radial and tangential lens distortion, the model that ROS calls `plumb_bob`.
//!
//! D. C. Brown, "Decentering distortion of lenses", Photogrammetric Engineering 32(3), 1966; the coefficients are those
//! of OpenCV and of sensor_msgs/CameraInfo: `D = [k1, k2, p1, p2, k3]`.

use nalgebra::{Matrix2, Point2, Vector2};

/// The coefficients of the model; all zero is a perfect lens.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlumbBob {
    /// Radial, of the second power of the radius.
    pub k1: f64,
    /// Radial, of the fourth power.
    pub k2: f64,
    /// Tangential, along y.
    pub p1: f64,
    /// Tangential, along x.
    pub p2: f64,
    /// Radial, of the sixth power.
    pub k3: f64,
}

/// Where undistortion stops, in normalised image coordinates (a pixel is about 1e-3).
const CONVERGED: f64 = 1e-12;
const MAX_ITERATIONS: usize = 25;

impl PlumbBob {
    /// Where the ray through the undistorted normalised point `ideal` (x/z, y/z in the camera frame) really falls.
    #[must_use]
    pub fn distort(&self, ideal: Point2<f64>) -> Point2<f64> {
        let (x, y) = (ideal.x, ideal.y);
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        Point2::new(
            x * radial + 2.0 * self.p1 * x * y + self.p2 * (r2 + 2.0 * x * x),
            y * radial + self.p1 * (r2 + 2.0 * y * y) + 2.0 * self.p2 * x * y,
        )
    }

    /// The derivative of [`PlumbBob::distort`] at `ideal`.
    #[must_use]
    pub fn jacobian(&self, ideal: Point2<f64>) -> Matrix2<f64> {
        let (x, y) = (ideal.x, ideal.y);
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        // Derivative of `radial` by r2; that of r2 is (2x, 2y).
        let slope = self.k1 + r2 * (2.0 * self.k2 + 3.0 * r2 * self.k3);
        let mixed = 2.0 * x * y * slope + 2.0 * self.p1 * x + 2.0 * self.p2 * y;
        Matrix2::new(
            radial + 2.0 * x * x * slope + 2.0 * self.p1 * y + 6.0 * self.p2 * x,
            mixed,
            mixed,
            radial + 2.0 * y * y * slope + 6.0 * self.p1 * y + 2.0 * self.p2 * x,
        )
    }

    /// The inverse of [`PlumbBob::distort`] by Newton's method, converged to 1e-12.
    ///
    /// None where the lens model folds over (strong barrel distortion far outside its field of view) or the input is
    /// not finite.
    #[must_use]
    pub fn undistort(&self, seen: Point2<f64>) -> Option<Point2<f64>> {
        let mut ideal = seen;
        for _ in 0..MAX_ITERATIONS {
            let residual: Vector2<f64> = self.distort(ideal) - seen;
            let jacobian = self.jacobian(ideal);
            let determinant = jacobian.determinant();
            if !self.is_valid_at(ideal) || !determinant.is_finite() {
                return None;
            }
            let step = Vector2::new(
                (jacobian.m22 * residual.x - jacobian.m12 * residual.y) / determinant,
                (jacobian.m11 * residual.y - jacobian.m21 * residual.x) / determinant,
            );
            ideal -= step;
            if step.x.abs().max(step.y.abs()) < CONVERGED {
                return self.is_valid_at(ideal).then_some(ideal);
            }
        }
        None
    }

    /// Whether the model is one-to-one around `ideal`: points beyond the fold would appear mirrored into the image.
    #[must_use]
    pub fn is_valid_at(&self, ideal: Point2<f64>) -> bool {
        let jacobian = self.jacobian(ideal);
        jacobian.determinant() > 0.0 && jacobian.m11 > 0.0 && jacobian.m22 > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn undistort_inverts_distort(
            k1 in -0.25..0.25_f64, k2 in -0.05..0.05_f64, p1 in -2e-3..2e-3_f64, p2 in -2e-3..2e-3_f64,
            x in -0.45..0.45_f64, y in -0.35..0.35_f64,
        ) {
            let lens = PlumbBob { k1, k2, p1, p2, k3: 0.01 };
            let ideal = Point2::new(x, y);
            let back = lens.undistort(lens.distort(ideal)).unwrap();
            prop_assert!((back - ideal).norm() < 1e-10, "{ideal} came back as {back}");
        }

        #[test]
        fn jacobian_is_the_derivative(x in -0.5..0.5_f64, y in -0.5..0.5_f64) {
            let lens = PlumbBob { k1: -0.2, k2: 0.07, p1: 1e-3, p2: -2e-3, k3: 0.02 };
            let h = 1e-6;
            let jacobian = lens.jacobian(Point2::new(x, y));
            let by_x = (lens.distort(Point2::new(x + h, y)) - lens.distort(Point2::new(x - h, y))) / (2.0 * h);
            let by_y = (lens.distort(Point2::new(x, y + h)) - lens.distort(Point2::new(x, y - h))) / (2.0 * h);
            prop_assert!((jacobian.column(0) - by_x).norm() < 1e-8);
            prop_assert!((jacobian.column(1) - by_y).norm() < 1e-8);
        }
    }

    #[test]
    fn refuses_what_the_lens_cannot_see() {
        let barrel = PlumbBob { k1: -0.4, ..PlumbBob::default() };
        // r (1 - 0.4 r^2) never exceeds 0.609: nothing is seen farther out.
        assert_eq!(barrel.undistort(Point2::new(0.7, 0.0)), None);
        assert_eq!(barrel.undistort(Point2::new(f64::NAN, 0.0)), None);
        assert!(!barrel.is_valid_at(Point2::new(1.2, 0.0)));
    }
}
