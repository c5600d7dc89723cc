//! The pixel pipeline on rendered frames.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

use nalgebra::Point3;
use overhead_localizer::vision::{Colour, ColourLimits, Detector, Disc, Expectation, Frame};
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pixel, Pose2};
use trench_sim::camera::{Appearance, Background, Renderer, Scene};

fn camera() -> Camera {
    let lens = CameraInfo::parse("overhead.yaml", include_str!("../../../config/cameras/overhead.yaml")).unwrap().lens;
    Camera::new(lens, Mount { roll: 0.008, pitch: -0.006, yaw: 0.01, ..Mount::nominal() }).unwrap()
}

fn detector(camera: &Camera) -> Detector {
    Detector::new(&ColourLimits::default(), Expectation::new(camera, &Pad::NOMINAL).unwrap())
}

/// `index` takes six robots over field and headings, apart from each other.
fn poses(index: u32) -> Vec<Vec<Pose2>> {
    (0..6)
        .map(|robot| {
            let step = f64::from(index) + 0.37 * f64::from(robot);
            let (column, row) = (f64::from(robot % 3), f64::from(robot / 3));
            let x = 0.16 + 0.72 * column + 0.6 * (0.618_034 * step).fract();
            let y = 0.16 + 0.76 * row + 0.6 * (0.414_214 * step).fract();
            vec![Pose2 { x, y, theta: 2.399_963 * step }]
        })
        .collect()
}

/// Where the discs of all robots must be seen, yellow then blue of each.
fn expected(camera: &Camera, robots: &[Vec<Pose2>]) -> Vec<(Colour, Pixel)> {
    let see = |point: nalgebra::Point2<f64>| camera.project(Point3::new(point.x, point.y, 0.10)).unwrap();
    robots
        .iter()
        .flat_map(|sweep| {
            let [yellow, blue] = Pad::NOMINAL.discs(sweep[0]);
            [(Colour::Yellow, see(yellow)), (Colour::Blue, see(blue))]
        })
        .collect()
}

fn detect(renderer: &Renderer, robots: &[Vec<Pose2>], frame: u64) -> Vec<Disc> {
    let mut image = vec![0; renderer.frame_len()];
    renderer.render(Scene { robots, obstacles: &[] }, frame, &mut image).unwrap();
    let mut discs = Vec::new();
    let mut room = Vec::new();
    let frame = Frame::new([768, 576], "rgb8", [768, 576], 2304, &image, &mut room).unwrap();
    detector(renderer.camera()).detect(frame, &mut discs);
    discs
}

#[test]
fn every_disc_is_found_and_nothing_else_on_any_floor() {
    let floors = [Background::Plain([150, 150, 145]), Background::Noisy([120, 125, 130], 0.5), Background::Wood];
    for (floor, background) in (0..).zip(floors) {
        let appearance = Appearance { background, seed: floor, ..Appearance::default() };
        let renderer = Renderer::new(camera(), Pad::NOMINAL, appearance);
        let (mut sum2, mut count) = (0.0_f64, 0.0_f64);
        for index in 0..60 {
            let robots = poses(index);
            let discs = detect(&renderer, &robots, index.into());
            assert_eq!(discs.len(), 12, "floor {floor}, frame {index}: {discs:?}");
            for (colour, pixel) in expected(renderer.camera(), &robots) {
                let error = discs
                    .iter()
                    .filter(|disc| disc.colour == colour)
                    .map(|disc| (disc.centre.u - pixel.u).hypot(disc.centre.v - pixel.v))
                    .fold(f64::MAX, f64::min);
                assert!(error < 0.1, "floor {floor}, frame {index}: off by {error} px");
                (sum2, count) = (sum2 + error * error, count + 1.0);
            }
        }
        let rms = (sum2 / count).sqrt();
        println!("floor {floor}: rms {rms:.4} px");
        assert!(rms < 0.03, "floor {floor}: rms {rms} px");
    }
}
