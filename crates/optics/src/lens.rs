//! A pinhole with distortion: rays in the camera frame to pixels and back.

use crate::PlumbBob;
use nalgebra::{Matrix2, Point2};

/// A place in an image; the centre of the first pixel is (0, 0).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pixel {
    /// Along columns, to the right.
    pub u: f64,
    /// Along rows, downwards.
    pub v: f64,
}

/// The intrinsic parameters: what sensor_msgs/CameraInfo holds as width, height, K and D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Focal length along columns, pixels.
    pub fx: f64,
    /// Focal length along rows, pixels.
    pub fy: f64,
    /// Principal point, column.
    pub cx: f64,
    /// Principal point, row.
    pub cy: f64,
    /// Distortion.
    pub distortion: PlumbBob,
}

/// Why numbers are not a lens.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LensError {
    /// A number is NaN or infinite.
    #[error("{0} is not finite")]
    NotFinite(&'static str),
    /// A focal length or size is zero or negative.
    #[error("{0} must be greater than zero")]
    NotPositive(&'static str),
    /// The distortion cannot be undone everywhere in the image.
    #[error("the distortion folds the image over at pixel ({u}, {v}): it cannot be undone there")]
    Folds {
        /// Column of the corner that fails.
        u: f64,
        /// Row.
        v: f64,
    },
}

impl Lens {
    /// The test bed's camera of 4.5.3 without distortion: 768 x 576 pixels of 3.229 mm and 3.177 mm on the floor, 3 m
    /// below.
    #[must_use]
    pub fn nominal() -> Self {
        Self {
            width: 768,
            height: 576,
            fx: 3.0 / 3.229e-3,
            fy: 3.0 / 3.177e-3,
            cx: 383.5,
            cy: 287.5,
            distortion: PlumbBob::default(),
        }
    }

    /// Checks that every pixel of the image has a ray.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(&self) -> Result<(), LensError> {
        let d = self.distortion;
        let numbers = [
            ("fx", self.fx),
            ("fy", self.fy),
            ("cx", self.cx),
            ("cy", self.cy),
            ("k1", d.k1),
            ("k2", d.k2),
            ("p1", d.p1),
            ("p2", d.p2),
            ("k3", d.k3),
        ];
        for (name, value) in numbers {
            if !value.is_finite() {
                return Err(LensError::NotFinite(name));
            }
        }
        let sizes = [("fx", self.fx), ("fy", self.fy), ("width", self.width.into()), ("height", self.height.into())];
        for (name, value) in sizes {
            if value <= 0.0 {
                return Err(LensError::NotPositive(name));
            }
        }
        let (right, bottom) = (f64::from(self.width) - 0.5, f64::from(self.height) - 0.5);
        for (u, v) in [(-0.5, -0.5), (right, -0.5), (-0.5, bottom), (right, bottom)] {
            if self.ray(Pixel { u, v }).is_none() {
                return Err(LensError::Folds { u, v });
            }
        }
        Ok(())
    }

    /// The pixel on which the ray (x/z, y/z) of the camera frame falls, inside the image or not.
    /// None beyond the lens's field of view.
    #[must_use]
    pub fn pixel(&self, ray: Point2<f64>) -> Option<Pixel> {
        if !self.distortion.is_valid_at(ray) {
            return None;
        }
        let seen = self.distortion.distort(ray);
        Some(Pixel { u: self.fx * seen.x + self.cx, v: self.fy * seen.y + self.cy })
    }

    /// The ray (x/z, y/z) of the camera frame that falls on a pixel.
    #[must_use]
    pub fn ray(&self, pixel: Pixel) -> Option<Point2<f64>> {
        self.distortion.undistort(Point2::new((pixel.u - self.cx) / self.fx, (pixel.v - self.cy) / self.fy))
    }

    /// The derivative of the pixel by the ray, pixels.
    #[must_use]
    pub fn jacobian(&self, ray: Point2<f64>) -> Matrix2<f64> {
        Matrix2::new(self.fx, 0.0, 0.0, self.fy) * self.distortion.jacobian(ray)
    }

    /// Whether a pixel lies in the image, at least `margin` pixels from its edges.
    #[must_use]
    pub fn contains(&self, pixel: Pixel, margin: f64) -> bool {
        let inside = |value: f64, size: u32| value >= margin - 0.5 && value <= f64::from(size) - 0.5 - margin;
        inside(pixel.u, self.width) && inside(pixel.v, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validate_names_what_is_wrong() {
        let check = |change: fn(&mut Lens), expected: Result<(), LensError>| {
            let mut lens = Lens::nominal();
            change(&mut lens);
            assert_eq!(lens.validate(), expected);
        };
        check(|_| (), Ok(()));
        check(|lens| lens.fx = f64::NAN, Err(LensError::NotFinite("fx")));
        check(|lens| lens.distortion.k3 = f64::INFINITY, Err(LensError::NotFinite("k3")));
        check(|lens| lens.fy = 0.0, Err(LensError::NotPositive("fy")));
        check(|lens| lens.height = 0, Err(LensError::NotPositive("height")));
        check(|lens| lens.distortion.k1 = -1.0, Err(LensError::Folds { u: -0.5, v: -0.5 }));
    }
}
