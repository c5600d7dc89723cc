//! What robots and obstacles are drawn with: boxes of pixels, and how much of a pixel an edge covers.

use nalgebra::{Matrix2, Point3};
use trench_optics::{Camera, Pixel};

/// A rectangle of pixels, ends excluded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelBox {
    pub(super) columns: [usize; 2],
    pub(super) rows: [usize; 2],
}

impl PixelBox {
    /// The pixels around vertical cylinders from the floor to `height`, each around (x, y) with this `radius`, m.
    /// Where the lens sees no part of a cylinder, it is left out.
    pub(super) fn around(camera: &Camera, centres: &[[f64; 2]], radius: f64, height: f64) -> Self {
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for [x, y] in centres {
            for z in [0.0, height] {
                let centre = Point3::new(*x, *y, z);
                let (Some(Pixel { u, v }), Some(scale)) = (camera.project(centre), camera.pixels_per_metre(centre))
                else {
                    continue;
                };
                // A circle's image reaches as far along an axis as the length of that row of the derivative; 3 pixels
                // more for anti-aliasing and the curvature of the lens.
                let reach = |row: usize| radius * 1.02 * scale.row(row).norm() + 3.0;
                low = [low[0].min(u - reach(0)), low[1].min(v - reach(1))];
                high = [high[0].max(u + reach(0)), high[1].max(v + reach(1))];
            }
        }
        // Conversion saturates: what lies outside the image gives an empty range.
        let range = |low: f64, high: f64, size: u32| [low as usize, (high.max(-1.0) + 1.0).min(size.into()) as usize];
        Self {
            columns: range(low[0], high[0], camera.lens().width),
            rows: range(low[1], high[1], camera.lens().height),
        }
    }
}

/// Turns distances from an edge, m, into the covered fraction of a pixel, near one place of the map.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeScale {
    /// The derivative of the map point by the pixel, m.
    metres: Matrix2<f32>,
}

impl EdgeScale {
    /// The scale around a point; None where the lens does not see it.
    pub(super) fn at(camera: &Camera, point: Point3<f64>) -> Option<Self> {
        let metres = camera.pixels_per_metre(point)?.try_inverse()?;
        Some(Self { metres: metres.map(|value| value as f32) })
    }

    /// The covered fraction of a pixel whose centre lies `outside` m beyond an edge (negative: within the shape), the
    /// shortest way out of the shape being along `normal` (of any length): the exact area that a straight edge cuts off.
    pub(super) fn coverage(&self, outside: f32, normal: [f32; 2]) -> f32 {
        let length = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt().max(1e-9);
        // How much the distance grows over one pixel along columns and along rows, m.
        let across = (self.metres.m11 * normal[0] + self.metres.m21 * normal[1]).abs() / length;
        let down = (self.metres.m12 * normal[0] + self.metres.m22 * normal[1]).abs() / length;
        let (wide, narrow) = (across.max(down), across.min(down));
        // The area is a box of width `wide` smoothed by one of width `narrow`: linear in the middle, parabolas at both ends.
        let covered = |outside: f32| match outside {
            far if far >= 0.5 * (wide + narrow) => 0.0,
            near if near <= 0.5 * (wide - narrow) => 0.5 - near / wide,
            end => {
                let rest = 0.5 * (wide + narrow) - end;
                rest * rest / (2.0 * wide * narrow)
            }
        };
        if outside >= 0.0 { covered(outside) } else { 1.0 - covered(-outside) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_is_the_area_cut_off() {
        let scale = EdgeScale { metres: Matrix2::new(0.003, 0.0, 0.0, -0.003) };
        for (normal, outside) in [([1.0, 0.0], 0.001), ([1.0, 1.0], 0.0015), ([-3.0, 1.0], -0.0013), ([1.0, 2.0], 0.0)]
        {
            let length = f32::hypot(normal[0], normal[1]);
            let inside = |u: f32, v: f32| outside + (0.003 * u * normal[0] - 0.003 * v * normal[1]) / length < 0.0;
            let place = |k: u16| (f32::from(k) + 0.5) / 200.0 - 0.5;
            let count = (0..40_000_u16).filter(|k| inside(place(k % 200), place(k / 200))).count();
            let (expected, actual) = (count as f32 / 40_000.0, scale.coverage(outside, normal));
            assert!((actual - expected).abs() < 0.005, "{normal:?} {outside}: {actual}, counted {expected}");
        }
    }
}
