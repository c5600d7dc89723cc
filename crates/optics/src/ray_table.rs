//! The line of sight of every pixel, computed once: the renderer's way from pixels to the map.

use crate::{Camera, Pixel};

/// For each pixel, how far its line of sight moves in map x and y for every metre that it descends.
///
/// Single precision: 1e-7 of a slope below 1 over 3 m is less than a micrometre.
#[derive(Debug, Clone, PartialEq)]
pub struct RayTable {
    width: usize,
    position: [f32; 2],
    height: f32,
    slopes: Vec<[f32; 2]>,
}

impl RayTable {
    /// Follows every pixel of the camera's image. Pixels that see nothing below the camera get a slope of NaN.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let (lens, mount) = (camera.lens(), camera.mount());
        let slope = |u: u32, v: u32| {
            camera.slope(Pixel { u: u.into(), v: v.into() }).map_or([f32::NAN; 2], |[x, y]| [x as f32, y as f32])
        };
        let slopes = (0..lens.height).flat_map(|v| (0..lens.width).map(move |u| slope(u, v))).collect();
        Self {
            width: lens.width as usize,
            position: [mount.x as f32, mount.y as f32],
            height: mount.height as f32,
            slopes,
        }
    }

    /// The optical centre's x and y in the map, m.
    #[must_use]
    pub fn position(&self) -> [f32; 2] {
        self.position
    }

    /// From the optical centre down to a plane at `height` (m), m.
    #[must_use]
    pub fn drop_to(&self, height: f32) -> f32 {
        self.height - height
    }

    /// The slopes of row `v`, one a column.
    #[must_use]
    pub fn row(&self, v: usize) -> &[[f32; 2]] {
        self.slopes.get(v * self.width..(v + 1) * self.width).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_camera() {
        let camera = Camera::nominal();
        let table = RayTable::new(&camera);
        for (u, v) in [(0, 0), (767, 575), (100, 400)] {
            let exact = camera.unproject(Pixel { u: f64::from(u), v: f64::from(v) }, 0.1).unwrap();
            let slope = table.row(v as usize)[u as usize];
            let x = table.position()[0] + table.drop_to(0.1) * slope[0];
            let y = table.position()[1] + table.drop_to(0.1) * slope[1];
            assert!((f64::from(x) - exact.x).abs() < 1e-6 && (f64::from(y) - exact.y).abs() < 1e-6);
        }
        assert!(table.row(576).is_empty());
    }
}
