//! Which yellow disc belongs to which blue one.

use super::assignment::assign;
use crate::vision::Colour;
use nalgebra::Point2;
use trench_optics::{Camera, Pad, Pixel, Pose2};

/// A disc's centre on the pads' plane of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapDisc {
    /// Yellow or blue.
    pub colour: Colour,
    /// m
    pub position: Point2<f64>,
}

impl MapDisc {
    /// The disc whose centre is seen at a pixel, `height` (m) above the floor; None where the camera sees no such place.
    ///
    /// A disc's centre of area is not exactly the image of its centre, but with the test bed's lens and a camera tilted by
    /// less than 1.6 degrees they agree to 0.05 mm: too little to correct.
    #[must_use]
    pub fn seen(camera: &Camera, height: f64, colour: Colour, centre: Pixel) -> Option<Self> {
        camera.unproject(centre, height).map(|position| Self { colour, position })
    }
}

/// Two discs that make a pad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The robot under it.
    pub pose: Pose2,
    /// How well it fits: the pairing maximises the sum over pairs.
    pub gain: f64,
}

/// What a pair is worth that agrees with nothing but the pad's spacing. A pair that a robot is expected to make is worth
/// up to three times as much: two wrong pairs do not outweigh a right one.
const ALONE: f64 = 12.5;

/// Pairs discs whose spacing is that of the pad within `tolerance` (m), so that spacings and `support` fit best as a
/// whole. `support` says between 0 and 1 how well a robot is expected at a pose: it tells pads of touching robots apart.
///
/// Of two pairs that could only stand in one another ([`Pad::body_diameter`]), the worse is dropped.
pub(super) fn pair(discs: &[MapDisc], pad: &Pad, tolerance: f64, support: impl Fn(Pose2) -> f64) -> Vec<Pair> {
    let of = |colour| discs.iter().filter(move |disc| disc.colour == colour).map(|disc| disc.position);
    let (yellow, blue): (Vec<_>, Vec<_>) = (of(Colour::Yellow).collect(), of(Colour::Blue).collect());
    let candidate = |front: usize, back: usize| -> Option<Pair> {
        let (front, back) = (yellow[front], blue[back]);
        let misfit = ((front - back).norm() - pad.disc_spacing).abs() / tolerance;
        let pose = Pad::pose(front, back);
        (misfit < 1.0).then(|| Pair { pose, gain: ALONE * (1.0 - 0.9 * misfit * misfit + 2.0 * support(pose)) })
    };
    let matched = assign(yellow.len(), blue.len(), |front, back| candidate(front, back).map(|pair| pair.gain));
    let mut pairs: Vec<Pair> =
        matched.iter().enumerate().filter_map(|(front, back)| candidate(front, (*back)?)).collect();

    pairs.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut kept: Vec<Pair> = Vec::with_capacity(pairs.len());
    for pair in pairs {
        // Bodies are not perfectly round, nor measured without error.
        let nearest = 0.9 * pad.body_diameter;
        let apart = |other: &Pair| libm::hypot(other.pose.x - pair.pose.x, other.pose.y - pair.pose.y) >= nearest;
        if kept.iter().all(apart) {
            kept.push(pair);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn discs(poses: &[Pose2]) -> Vec<MapDisc> {
        let two = |pose: &Pose2| {
            let [yellow, blue] = Pad::NOMINAL.discs(*pose);
            [(Colour::Yellow, yellow), (Colour::Blue, blue)].map(|(colour, position)| MapDisc { colour, position })
        };
        poses.iter().flat_map(two).collect()
    }

    #[test]
    fn pads_of_touching_robots_are_not_crossed() {
        // Two robots side by side, the second turned back to front and placed so that each yellow disc is also 77 mm from
        // the other's blue one: only what is expected tells which pads there are.
        let robots = [Pose2 { x: 1.0, y: 1.0, theta: FRAC_PI_2 }, Pose2 { x: 1.077, y: 1.0, theta: -FRAC_PI_2 }];
        let expected_at = |poses: &'static [(f64, f64)]| {
            move |pose: Pose2| {
                let near = poses.iter().any(|(x, y)| (pose.x - x).abs() + (pose.y - y).abs() < 0.01);
                if near { 1.0 } else { 0.0 }
            }
        };
        let small = Pad { body_diameter: 0.05, ..Pad::NOMINAL };
        let straight = pair(&discs(&robots), &small, 0.005, expected_at(&[(1.0, 1.0), (1.077, 1.0)]));
        assert!(straight.len() == 2 && straight.iter().all(|pair| (pair.pose.y - 1.0).abs() < 1e-6), "{straight:?}");
        let crossed = pair(&discs(&robots), &small, 0.005, expected_at(&[(1.0385, 1.0385), (1.0385, 0.9615)]));
        assert!(crossed.len() == 2 && crossed.iter().all(|pair| (pair.pose.x - 1.0385).abs() < 1e-6), "{crossed:?}");
    }

    #[test]
    fn two_wrong_pairs_do_not_displace_a_right_one() {
        // Three robots in a row, 77 mm from each one's blue disc to the next one's yellow disc. Of the outer ones only
        // the inner discs are seen.
        let row = [0.0, 0.154, 0.308].map(|x| Pose2 { x, y: 0.0, theta: 0.0 });
        let all = discs(&row);
        let seen = [all[0], all[2], all[3], all[5]];
        let pairs = pair(&seen, &Pad::NOMINAL, 0.005, |pose| if (pose.x - 0.154).abs() < 0.01 { 1.0 } else { 0.0 });
        assert_eq!(pairs.len(), 1, "{pairs:?}");
        assert!((pairs[0].pose.x - 0.154).abs() < 1e-9 && pairs[0].pose.theta.abs() < 1e-9, "{pairs:?}");
    }

    #[test]
    fn a_discs_centre_of_area_is_the_image_of_its_centre() {
        use nalgebra::Point3;
        use trench_optics::{CameraInfo, Mount};
        let lens = include_str!("../../../../config/cameras/overhead.yaml");
        let lens = CameraInfo::parse("overhead.yaml", lens).unwrap().lens;
        let camera = Camera::new(lens, Mount { roll: 0.02, pitch: 0.02, ..Mount::nominal() }).unwrap();
        for (x, y) in [(0.1, 0.1), (2.3, 0.1), (0.1, 1.7), (2.3, 1.7), (1.2, 0.9)] {
            // The centre of area of the image: places on the disc, weighted by how large they appear.
            let (mut sum, mut sum_u, mut sum_v) = (0.0, 0.0, 0.0);
            for cell in 0..10_000_i32 {
                let place = |index: i32| 0.5 * Pad::NOMINAL.disc_diameter * (f64::from(index) + 0.5 - 50.0) / 50.0;
                let (dx, dy) = (place(cell % 100), place(cell / 100));
                if dx.hypot(dy) < 0.5 * Pad::NOMINAL.disc_diameter {
                    let point = Point3::new(x + dx, y + dy, Pad::NOMINAL.height);
                    let size = camera.pixels_per_metre(point).unwrap().determinant().abs();
                    let pixel = camera.project(point).unwrap();
                    (sum, sum_u, sum_v) = (sum + size, sum_u + size * pixel.u, sum_v + size * pixel.v);
                }
            }
            let centre = Pixel { u: sum_u / sum, v: sum_v / sum };
            let seen = MapDisc::seen(&camera, Pad::NOMINAL.height, Colour::Blue, centre).unwrap();
            let error = (seen.position - Point2::new(x, y)).norm();
            assert!(error < 5e-5, "({x}, {y}): off by {error} m");
        }
    }

    #[test]
    fn discs_without_a_partner_make_no_pair() {
        let robot = discs(&[Pose2 { x: 1.0, y: 1.0, theta: 0.3 }]);
        assert_eq!(pair(&robot[..1], &Pad::NOMINAL, 0.005, |_| 1.0), []);
        assert_eq!(pair(&[], &Pad::NOMINAL, 0.005, |_| 1.0), []);
        let far = [robot[0], MapDisc { position: robot[1].position + nalgebra::Vector2::new(-0.05, 0.0), ..robot[1] }];
        assert_eq!(pair(&far, &Pad::NOMINAL, 0.005, |_| 1.0), []);
    }
}
