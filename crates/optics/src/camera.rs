//! A lens on a mount: points of the map to pixels, and pixels to the plane at a known height.

use crate::{Lens, LensError, Mount, MountError, Pixel};
use nalgebra::{Matrix2, Matrix3, Point2, Point3, Vector3};

/// An overhead camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    lens: Lens,
    mount: Mount,
    map_from_camera: Matrix3<f64>,
}

/// Why a lens and a mount are not a camera.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// The lens is wrong.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// The mount is wrong.
    #[error(transparent)]
    Mount(#[from] MountError),
}

impl Camera {
    /// Puts a lens on a mount.
    ///
    /// # Errors
    /// When either is not valid.
    pub fn new(lens: Lens, mount: Mount) -> Result<Self, CameraError> {
        lens.validate()?;
        mount.validate()?;
        Ok(Self { lens, mount, map_from_camera: mount.map_from_camera() })
    }

    /// The test bed's camera without distortion or tilt.
    #[must_use]
    pub fn nominal() -> Self {
        let mount = Mount::nominal();
        Self { lens: Lens::nominal(), mount, map_from_camera: mount.map_from_camera() }
    }

    /// The intrinsic parameters.
    #[must_use]
    pub fn lens(&self) -> &Lens {
        &self.lens
    }

    /// Where the camera hangs.
    #[must_use]
    pub fn mount(&self) -> &Mount {
        &self.mount
    }

    /// The pixel at which a point of the map is seen, inside the image or not; None behind the camera or beyond the
    /// lens's field of view.
    #[must_use]
    pub fn project(&self, point: Point3<f64>) -> Option<Pixel> {
        let in_camera = self.map_from_camera.tr_mul(&(point - self.mount.position()));
        (in_camera.z > 0.0)
            .then(|| Point2::new(in_camera.x / in_camera.z, in_camera.y / in_camera.z))
            .and_then(|ray| self.lens.pixel(ray))
    }

    /// The point of the horizontal plane at `height` (m) that is seen at a pixel; None where the lens sees nothing there
    /// or the line of sight does not meet the plane.
    #[must_use]
    pub fn unproject(&self, pixel: Pixel, height: f64) -> Option<Point2<f64>> {
        let slope = self.slope(pixel)?;
        let drop = self.mount.height - height;
        (drop > 0.0).then(|| Point2::new(self.mount.x + drop * slope[0], self.mount.y + drop * slope[1]))
    }

    /// How far the line of sight of a pixel moves in map x and y for every metre that it descends.
    pub(crate) fn slope(&self, pixel: Pixel) -> Option<[f64; 2]> {
        let ray = self.lens.ray(pixel)?;
        let direction = self.map_from_camera * Vector3::new(ray.x, ray.y, 1.0);
        (direction.z < 0.0).then(|| [direction.x / -direction.z, direction.y / -direction.z])
    }

    /// The derivative of the pixel by (x, y) of a point of the map, pixels per metre.
    #[must_use]
    pub fn pixels_per_metre(&self, point: Point3<f64>) -> Option<Matrix2<f64>> {
        let in_camera = self.map_from_camera.tr_mul(&(point - self.mount.position()));
        if in_camera.z <= 0.0 {
            return None;
        }
        let ray = Point2::new(in_camera.x / in_camera.z, in_camera.y / in_camera.z);
        // Rows of the transposed rotation give the camera coordinates' derivatives by map x and y.
        let rotation = &self.map_from_camera;
        let ray_by_map = |column: usize| {
            let (dx, dy, dz) = (rotation[(column, 0)], rotation[(column, 1)], rotation[(column, 2)]);
            [(dx - ray.x * dz) / in_camera.z, (dy - ray.y * dz) / in_camera.z]
        };
        let (by_x, by_y) = (ray_by_map(0), ray_by_map(1));
        Some(self.lens.jacobian(ray) * Matrix2::new(by_x[0], by_y[0], by_x[1], by_y[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PlumbBob;
    use proptest::prelude::*;

    fn tilted() -> Camera {
        let distortion = PlumbBob { k1: -0.18, k2: 0.05, p1: 8e-4, p2: -6e-4, k3: -0.01 };
        let mount = Mount { roll: 0.03, pitch: -0.02, yaw: 0.05, ..Mount::nominal() };
        Camera::new(Lens { distortion, ..Lens::nominal() }, mount).unwrap()
    }

    #[test]
    fn nominal_view_is_that_of_the_thesis() {
        let camera = Camera::nominal();
        let check = |u: f64, v: f64, x: f64, y: f64| {
            let point = camera.unproject(Pixel { u, v }, 0.0).unwrap();
            assert!((point - Point2::new(x, y)).norm() < 1e-12, "pixel ({u}, {v}) shows {point}");
        };
        check(-0.5, 575.5, 0.0, 0.0);
        check(767.5, 575.5, 768.0 * 3.229e-3, 0.0);
        check(-0.5, -0.5, 0.0, 576.0 * 3.177e-3);
    }

    #[test]
    fn height_moves_points_outwards() {
        let floor = Camera::nominal().project(Point3::new(2.0, 0.915, 0.0)).unwrap();
        let pad = Camera::nominal().project(Point3::new(2.0, 0.915, 0.10)).unwrap();
        // (2.0 - 1.24) m x 0.1 / 2.9 at 3.229 mm a pixel.
        assert!((pad.u - floor.u - 8.116).abs() < 1e-2, "{}", pad.u - floor.u);
    }

    #[test]
    fn nothing_is_seen_above_the_camera() {
        let camera = tilted();
        assert_eq!(camera.project(Point3::new(1.0, 1.0, 3.5)), None);
        assert_eq!(camera.unproject(Pixel { u: 300.0, v: 300.0 }, 3.0), None);
        assert_eq!(camera.pixels_per_metre(Point3::new(1.0, 1.0, 3.5)), None);
    }

    proptest! {
        #[test]
        fn unproject_inverts_project(x in 0.0..2.48_f64, y in 0.0..1.83_f64, z in 0.0..0.3_f64) {
            let camera = tilted();
            let pixel = camera.project(Point3::new(x, y, z)).unwrap();
            let back = camera.unproject(pixel, z).unwrap();
            prop_assert!((back - Point2::new(x, y)).norm() < 1e-10);
        }

        #[test]
        fn pixels_per_metre_is_the_derivative(x in 0.0..2.48_f64, y in 0.0..1.83_f64) {
            let (camera, h) = (tilted(), 1e-5);
            let pixel = |x, y| camera.project(Point3::new(x, y, 0.1)).unwrap();
            let scale = camera.pixels_per_metre(Point3::new(x, y, 0.1)).unwrap();
            let (right, left) = (pixel(x + h, y), pixel(x - h, y));
            let (up, down) = (pixel(x, y + h), pixel(x, y - h));
            prop_assert!((scale.m11 - (right.u - left.u) / (2.0 * h)).abs() < 1e-3);
            prop_assert!((scale.m21 - (right.v - left.v) / (2.0 * h)).abs() < 1e-3);
            prop_assert!((scale.m12 - (up.u - down.u) / (2.0 * h)).abs() < 1e-3);
            prop_assert!((scale.m22 - (up.v - down.v) / (2.0 * h)).abs() < 1e-3);
        }
    }
}
