//! Renders frames into a folder, finds their discs, and writes what it took as JSON: one half of
//! `benches/opencv_peer.py`, which measures its peer on the same frames.
//!
//! `detect_frames FOLDER [SCALE [ROBOTS]]` writes `frames.rgb` (rgb8, one after the other; 768 x 576, or 1920 x 1080 with the
//! scale 2.5) and `truth.csv` (frame, colour, u, v) there and prints `{"frames": .., "found": .., "expected": .., "rms_px": .., "median_us": .., "p99_us": ..}`.

mod bed;

use bed::{poses, scaled};
use overhead_localizer::vision::{Colour, ColourLimits, Detector, Expectation, Frame};
use std::error::Error;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pixel, Pose2};
use trench_sim::camera::{Appearance, Background, Renderer, Scene};

const PASSES: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: detect_frames FOLDER [SCALE [ROBOTS]]")?;
    let scale: f64 = std::env::args().nth(2).map_or(Ok(1.0), |text| text.parse())?;
    let robots_seen: u32 = std::env::args().nth(3).map_or(Ok(6), |text| text.parse())?;
    // Large frames take six times the room.
    let frame_count: u32 = if scale > 1.5 { 20 } else { 100 };
    let lens = CameraInfo::parse("overhead.yaml", include_str!("../../../config/cameras/overhead.yaml"))?.lens;
    let lens = scaled(lens, scale);
    let [width, height] = [lens.width as usize, lens.height as usize];
    let camera = Camera::new(lens, Mount::nominal())?;
    let background = Background::Noisy([140, 140, 135], 0.3);
    let renderer = Renderer::new(camera.clone(), Pad::NOMINAL, Appearance { background, ..Appearance::default() });

    let mut frames = vec![0_u8; frame_count as usize * renderer.frame_len()];
    let mut truth = String::from("frame,colour,u,v\n");
    let mut expected = Vec::new();
    for (index, image) in (0..frame_count).zip(frames.chunks_exact_mut(renderer.frame_len())) {
        let robots = poses(index, robots_seen);
        renderer.render(Scene { robots: &robots, obstacles: &[] }, index.into(), image)?;
        let discs = discs(&camera, &robots);
        for (colour, pixel) in &discs {
            writeln!(truth, "{index},{colour:?},{},{}", pixel.u, pixel.v)?;
        }
        expected.push(discs);
    }
    File::create(Path::new(&folder).join("frames.rgb"))?.write_all(&frames)?;
    File::create(Path::new(&folder).join("truth.csv"))?.write_all(truth.as_bytes())?;

    let expectation = Expectation::new(&camera, &Pad::NOMINAL).ok_or("the camera sees no pad")?;
    let mut detector = Detector::new(&ColourLimits::default(), expectation);
    let mut room = Vec::new();
    let (mut found, mut microseconds) = (Vec::new(), Vec::new());
    let (mut matched, mut surplus, mut sum2) = (0_usize, 0_usize, 0.0_f64);
    for pass in 0..PASSES {
        for (image, expected) in frames.chunks_exact(renderer.frame_len()).zip(&expected) {
            let start = Instant::now();
            let frame = Frame::new([width, height], "rgb8", [width, height], 3 * width, image, &mut room)?;
            detector.detect(frame, &mut found);
            microseconds.push(start.elapsed().as_secs_f64() * 1e6);
            if pass > 0 {
                continue;
            }
            surplus += found.len().saturating_sub(expected.len());
            for (colour, pixel) in expected {
                let distance = |other: &Pixel| (other.u - pixel.u).hypot(other.v - pixel.v);
                let same = found.iter().filter(|disc| disc.colour == *colour).map(|disc| distance(&disc.centre));
                let error = same.fold(f64::MAX, f64::min);
                if error < 2.0 {
                    matched += 1;
                    sum2 += error * error;
                }
            }
        }
    }
    microseconds.sort_by(f64::total_cmp);
    let quantile = |fraction: f64| microseconds[(fraction * (microseconds.len() - 1) as f64) as usize];
    println!(
        "{{\"frames\": {frame_count}, \"found\": {matched}, \"expected\": {}, \"surplus\": {surplus}, \"rms_px\": {:.4}, \
         \"median_us\": {:.1}, \"p99_us\": {:.1}}}",
        2 * robots_seen * frame_count,
        (sum2 / matched as f64).sqrt(),
        quantile(0.5),
        quantile(0.99)
    );
    Ok(())
}

fn discs(camera: &Camera, robots: &[Vec<Pose2>]) -> Vec<(Colour, Pixel)> {
    let mut discs = Vec::new();
    for pose in robots.iter().flatten() {
        for (colour, centre) in [Colour::Yellow, Colour::Blue].into_iter().zip(Pad::NOMINAL.discs(*pose)) {
            let point = nalgebra::Point3::new(centre.x, centre.y, Pad::NOMINAL.height);
            discs.extend(camera.project(point).map(|pixel| (colour, pixel)));
        }
    }
    discs
}
