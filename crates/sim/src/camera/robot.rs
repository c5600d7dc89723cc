//! One robot: a dark cylinder with the two discs on its top, blurred by its motion during the exposure.

use super::appearance::{Appearance, Light};
use super::renderer::blend;
use super::shape::{EdgeScale, PixelBox};
use nalgebra::Point3;
use trench_optics::{Camera, Pad, Pose2, RayTable};

/// A robot at one instant, in the single precision of the pixel loop.
struct Instant {
    centre: [f32; 2],
    discs: [[f32; 2]; 2],
    scale: EdgeScale,
}

/// Draws a robot that was at `poses` at equally spaced instants of the exposure.
pub(super) fn draw(
    camera: &Camera,
    rays: &RayTable,
    pad: &Pad,
    appearance: &Appearance,
    light: Light,
    poses: &[Pose2],
    image: &mut [u8],
) {
    let narrow = |point: nalgebra::Point2<f64>| [point.x as f32, point.y as f32];
    let instants: Vec<Instant> = poses
        .iter()
        .filter_map(|pose| {
            let scale = EdgeScale::at(camera, Point3::new(pose.x, pose.y, pad.height))?;
            Some(Instant { centre: [pose.x as f32, pose.y as f32], discs: pad.discs(*pose).map(narrow), scale })
        })
        .collect();
    if instants.is_empty() {
        return;
    }
    let centres: Vec<[f64; 2]> = poses.iter().map(|pose| [pose.x, pose.y]).collect();
    let area = PixelBox::around(camera, &centres, 0.5 * pad.body_diameter, pad.height);
    let colours = [appearance.body, appearance.yellow, appearance.blue].map(|colour| colour.map(f32::from));
    let share = 1.0 / instants.len() as f32;
    let width = camera.lens().width as usize;
    for v in area.rows[0]..area.rows[1] {
        for u in area.columns[0]..area.columns[1] {
            let Some(slope) = rays.row(v).get(u) else { continue };
            let (mut sum, mut opacity) = ([0.0_f32; 3], 0.0_f32);
            for instant in &instants {
                let (colour, alpha) = instant.seen(rays, pad, *slope, &colours);
                opacity += share * alpha;
                for channel in 0..3 {
                    sum[channel] += share * alpha * colour[channel];
                }
            }
            if opacity > 0.0
                && let Some(pixel) = image.get_mut(3 * (v * width + u)..3 * (v * width + u) + 3)
            {
                blend(pixel, light.on(sum.map(|channel| channel / opacity), u, v), opacity);
            }
        }
    }
}

impl Instant {
    /// The colour and opacity of this robot along a line of sight.
    fn seen(&self, rays: &RayTable, pad: &Pad, slope: [f32; 2], colours: &[[f32; 3]; 3]) -> ([f32; 3], f32) {
        let [from_camera_x, from_camera_y] = [rays.position()[0] - self.centre[0], rays.position()[1] - self.centre[1]];
        // Along the line of sight from the floor up to the pad, relative to the robot's axis.
        let at = |drop: f32| [from_camera_x + drop * slope[0], from_camera_y + drop * slope[1]];
        let (floor, top) = (at(rays.drop_to(0.0)), at(rays.drop_to(pad.height as f32)));
        let nearest = nearest_to_origin(floor, top);
        let body = self.inside_circle(nearest, 0.5 * pad.body_diameter as f32);
        let (mut colour, mut alpha) = (colours[0], body);
        for (disc, disc_colour) in self.discs.iter().zip(&colours[1..]) {
            let from_disc = [top[0] - (disc[0] - self.centre[0]), top[1] - (disc[1] - self.centre[1])];
            let cover = self.inside_circle(from_disc, 0.5 * pad.disc_diameter as f32);
            for channel in 0..3 {
                colour[channel] += cover * (disc_colour[channel] - colour[channel]);
            }
            alpha = alpha.max(cover);
        }
        (colour, alpha)
    }

    /// The covered fraction of a pixel that looks at `offset` from the centre of a circle.
    fn inside_circle(&self, offset: [f32; 2], radius: f32) -> f32 {
        let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
        // No pixel is larger than a tenth of the smallest circle: only near the edge is the exact scale needed.
        match distance - radius {
            outside if outside > 0.2 * radius => 0.0,
            outside if outside < -0.2 * radius => 1.0,
            outside => self.scale.coverage(outside, offset),
        }
    }
}

/// The point nearest to the origin on the line from `a` to `b`.
fn nearest_to_origin(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length2 = along[0] * along[0] + along[1] * along[1];
    let fraction = if length2 > 0.0 { (-(a[0] * along[0] + a[1] * along[1]) / length2).clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + fraction * along[0], a[1] + fraction * along[1]]
}
