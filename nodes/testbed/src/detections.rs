//! What a detector would find in a frame, without an image: the discs' projections with noise.

use nalgebra::Point3;
use trench_msgs::msg::Disc;
use trench_optics::{Camera, Pad, Pose2};
use trench_sim::Random;

/// The discs of all robots that the camera sees, ordered by colour and column so that nothing tells whose they are.
pub(crate) fn discs(camera: &Camera, pad: &Pad, poses: &[Pose2], noise: f64, random: &mut Random) -> Vec<Disc> {
    let mut discs = Vec::with_capacity(2 * poses.len());
    for pose in poses {
        for (colour, centre) in [Disc::COLOUR_YELLOW, Disc::COLOUR_BLUE].into_iter().zip(pad.discs(*pose)) {
            // Drawn for every disc: one that leaves the picture does not shift the noise of the others.
            let (du, dv) = (noise * random.normal(), noise * random.normal());
            let point = Point3::new(centre.x, centre.y, pad.height);
            let seen = camera.project(point).filter(|pixel| camera.lens().contains(*pixel, 0.0));
            if let (Some(pixel), Some(scale)) = (seen, camera.pixels_per_metre(point)) {
                let radius = 0.5 * pad.disc_diameter;
                let area = std::f64::consts::PI * radius * radius * scale.determinant().abs();
                discs.push(Disc { colour, u: pixel.u + du, v: pixel.v + dv, area, confidence: 1.0 });
            }
        }
    }
    discs.sort_by(|a, b| a.colour.cmp(&b.colour).then(a.u.total_cmp(&b.u)));
    discs
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn discs_lead_back_to_the_pose() {
        let camera = Camera::nominal();
        let pose = Pose2 { x: 0.7, y: 1.2, theta: 2.0 };
        let hidden = Pose2 { x: 5.0, y: 1.2, theta: 2.0 };
        let discs = discs(&camera, &Pad::NOMINAL, &[pose, hidden], 0.0, &mut Random::new(1, 0));
        let points: Vec<Point2<f64>> = discs
            .iter()
            .filter_map(|disc| camera.unproject(trench_optics::Pixel { u: disc.u, v: disc.v }, Pad::NOMINAL.height))
            .collect();
        let [yellow, blue] = points[..] else { unreachable!("{discs:?}") };
        let back = Pad::pose(yellow, blue);
        assert!((back.x - 0.7).abs() + (back.y - 1.2).abs() + (back.theta - 2.0).abs() < 1e-6, "{back:?}");
        // 65 mm at 3.2 mm a pixel, a little nearer to the camera than the floor.
        assert!((330.0..380.0).contains(&discs[0].area), "{}", discs[0].area);
    }
}
