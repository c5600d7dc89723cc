//! Obstacles: flat grey polygons or discs on the floor.

use super::appearance::{Appearance, Light};
use super::renderer::blend;
use super::shape::{EdgeScale, PixelBox};
use nalgebra::Point3;
use trench_optics::{Camera, RayTable};

/// A polygon or a disc on the floor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Obstacle {
    /// Corners in order, m; one is the centre of a disc.
    pub corners: Vec<[f64; 2]>,
    /// Of the disc, or by which the polygon is grown, m.
    pub radius: f64,
}

/// Draws an obstacle.
pub(super) fn draw(
    camera: &Camera,
    rays: &RayTable,
    appearance: &Appearance,
    light: Light,
    obstacle: &Obstacle,
    image: &mut [u8],
) {
    let Some([x, y]) = obstacle.corners.first() else { return };
    // The scale at one corner serves the whole edge: it changes by less than the lens's distortion over the image.
    let Some(scale) = EdgeScale::at(camera, Point3::new(*x, *y, 0.0)) else { return };
    let area = PixelBox::around(camera, &obstacle.corners, obstacle.radius, 0.0);
    let corners: Vec<[f32; 2]> = obstacle.corners.iter().map(|corner| corner.map(|value| value as f32)).collect();
    let width = camera.lens().width as usize;
    for v in area.rows[0]..area.rows[1] {
        for u in area.columns[0]..area.columns[1] {
            let Some(slope) = rays.row(v).get(u) else { continue };
            let point = [0, 1].map(|axis| rays.position()[axis] + rays.drop_to(0.0) * slope[axis]);
            let (outside, normal) = outside_polygon(&corners, point);
            let alpha = scale.coverage(outside - obstacle.radius as f32, normal);
            if alpha > 0.0
                && let Some(pixel) = image.get_mut(3 * (v * width + u)..3 * (v * width + u) + 3)
            {
                blend(pixel, light.on(appearance.obstacle.map(f32::from), u, v), alpha);
            }
        }
    }
}

/// The distance from a point to a polygon's outline, negative inside, and the direction it is measured in.
fn outside_polygon(corners: &[[f32; 2]], point: [f32; 2]) -> (f32, [f32; 2]) {
    let mut nearest = (f32::MAX, [1.0, 0.0]);
    let mut inside = false;
    for (index, a) in corners.iter().enumerate() {
        let b = corners[(index + 1) % corners.len()];
        let (along, to_point) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
        let length2 = (along[0] * along[0] + along[1] * along[1]).max(1e-12);
        let fraction = ((to_point[0] * along[0] + to_point[1] * along[1]) / length2).clamp(0.0, 1.0);
        let offset = [to_point[0] - fraction * along[0], to_point[1] - fraction * along[1]];
        let distance2 = offset[0] * offset[0] + offset[1] * offset[1];
        if distance2 < nearest.0 {
            nearest = (distance2, offset);
        }
        // Even-odd rule: count the edges that a ray towards +x crosses.
        if (a[1] > point[1]) != (b[1] > point[1]) && to_point[0] < along[0] * to_point[1] / along[1] {
            inside = !inside;
        }
    }
    (if inside { -nearest.0.sqrt() } else { nearest.0.sqrt() }, nearest.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_signed() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let check = |corners: &[[f32; 2]], point, expected: f32| {
            let (outside, _) = outside_polygon(corners, point);
            assert!((outside - expected).abs() < 1e-6, "{point:?}: {outside}");
        };
        check(&square, [1.0, 0.5], -0.5);
        check(&square, [3.0, 1.0], 1.0);
        check(&square, [5.0, 6.0], 5.0);
        check(&[[1.0, 1.0]], [4.0, 5.0], 5.0);
    }
}
