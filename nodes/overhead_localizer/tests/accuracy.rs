//! The whole way from pixels to poses, against the truth behind rendered frames.
//!
//! `TRENCH_ENCOUNTERS` sets how many random encounters are rendered (1,000 in scripts/acceptance).

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

mod encounters;

use encounters::{Random, encounter};
use overhead_localizer::track::{MapDisc, Robot, Settings, Status, Tracker, wrap};
use overhead_localizer::vision::{ColourLimits, Detector, Expectation, Frame};
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer, Scene};

/// The test bed's lens, on a mount that is not quite level.
fn camera() -> Camera {
    let lens = CameraInfo::parse("overhead.yaml", include_str!("../../../config/cameras/overhead.yaml")).unwrap().lens;
    Camera::new(lens, Mount { roll: 0.008, pitch: -0.006, yaw: 0.01, ..Mount::nominal() }).unwrap()
}

struct Eye {
    renderer: Renderer,
    detector: Detector,
    image: Vec<u8>,
}

impl Eye {
    fn new() -> Self {
        let detector = Detector::new(&ColourLimits::default(), Expectation::new(&camera(), &Pad::NOMINAL).unwrap());
        // Noise of 4/255, a lighting gradient of 30 %.
        let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
        Self { image: vec![0; renderer.frame_len()], renderer, detector }
    }

    fn see(&mut self, robots: &[Vec<Pose2>], frame: u64) -> Vec<MapDisc> {
        self.renderer.render(Scene { robots, obstacles: &[] }, frame, &mut self.image).unwrap();
        let mut discs = Vec::new();
        self.detector.detect(
            Frame::new([768, 576], "rgb8", [768, 576], 2304, &self.image, &mut Vec::new()).unwrap(),
            &mut discs,
        );
        let camera = self.renderer.camera();
        discs.iter().filter_map(|disc| MapDisc::seen(camera, Pad::NOMINAL.height, disc.colour, disc.centre)).collect()
    }
}

fn team(starts: &[Pose2]) -> Tracker {
    let robot = |(index, pose): (usize, &Pose2)| Robot { name: format!("robot{}", index + 1), start: Some(*pose) };
    Tracker::new(Settings::new(starts.iter().enumerate().map(robot).collect()), 0)
}

#[test]
fn poses_are_exact_over_the_whole_field_and_all_headings() {
    let mut eye = Eye::new();
    let (mut position2, mut heading2, mut count) = (0.0_f64, 0.0_f64, 0.0_f64);
    for frame in 0..120_u32 {
        // Six robots a frame, on a grid shifted from frame to frame: up to where a disc would leave the view.
        let poses: Vec<Pose2> = (0..6_u32)
            .map(|robot| {
                let step = f64::from(frame) + 0.37 * f64::from(robot);
                let x = 0.13 + 0.81 * f64::from(robot % 3) + 0.6 * (0.618_034 * step).fract();
                let y = 0.13 + 0.92 * f64::from(robot / 3) + 0.65 * (0.414_214 * step).fract();
                Pose2 { x, y, theta: wrap(2.399_963 * step) }
            })
            .collect();
        let sweeps: Vec<Vec<Pose2>> = poses.iter().map(|pose| vec![*pose]).collect();
        let mut tracker = team(&poses);
        tracker.step(0.0, &eye.see(&sweeps, frame.into()));
        for (track, pose) in tracker.tracks().iter().zip(&poses) {
            assert_eq!(track.status, Status::Tracked, "frame {frame}: {pose:?}");
            let seen = track.filter.as_ref().unwrap().state().pose;
            position2 += (seen.x - pose.x).powi(2) + (seen.y - pose.y).powi(2);
            heading2 += wrap(seen.theta - pose.theta).powi(2);
            count += 1.0;
        }
    }
    let (position, heading) = ((position2 / count).sqrt(), (heading2 / count).sqrt());
    println!("RMS over {count} poses: {:.4} mm, {:.5} rad", 1e3 * position, heading);
    // The issue asks for 0.5 mm and 0.004 rad; this is what the pipeline reaches, with a margin.
    assert!(position < 8e-5, "RMS {position} m");
    assert!(heading < 1.5e-3, "RMS {heading} rad");
}

#[test]
fn robots_that_pass_at_two_centimetres_keep_their_names_and_accuracy() {
    let mut eye = Eye::new();
    for (encounter, heading) in [0.0, 0.7, 1.9, 2.8].into_iter().enumerate() {
        // Side by side in opposite directions, 0.18 m from centre to centre, at 0.2 m/s each with 10 ms of exposure.
        let pose = |robot: f64, time: f64| {
            let along = 0.2 * time * (1.0 - 2.0 * robot);
            let aside = 0.18 * (robot - 0.5);
            Pose2 {
                x: 1.2 + along * f64::cos(heading) - aside * f64::sin(heading),
                y: 0.9 + along * f64::sin(heading) + aside * f64::cos(heading),
                theta: wrap(heading + robot * std::f64::consts::PI),
            }
        };
        let mut tracker = team(&[pose(0.0, -0.6), pose(1.0, -0.6)]);
        for frame in 0..30_u32 {
            let time = -0.6 + 0.04 * f64::from(frame);
            let sweep = |robot| (-2..=2).map(|k| pose(robot, time + 0.0025 * f64::from(k))).collect();
            let discs = eye.see(&[sweep(0.0), sweep(1.0)], u64::from(frame) + 100 * encounter as u64);
            tracker.step(if frame == 0 { 0.0 } else { 0.04 }, &discs);
            for (track, robot) in tracker.tracks().iter().zip([0.0, 1.0]) {
                assert_eq!(track.status, Status::Tracked, "encounter {encounter}, frame {frame}");
                let (seen, truth) = (track.filter.as_ref().unwrap().state(), pose(robot, time));
                assert!((seen.pose.x - truth.x).hypot(seen.pose.y - truth.y) < 3e-4, "{seen:?} {truth:?}");
                assert!(wrap(seen.pose.theta - truth.theta).abs() < 5e-3, "{seen:?} {truth:?}");
                assert!(frame < 15 || (seen.v - 0.2).abs() < 0.01, "speed {}", seen.v);
            }
        }
    }
}

/// Two centimetres between the bodies, whatever the headings and speeds.
#[test]
fn no_swap_in_random_encounters_from_rendered_frames() {
    let count = std::env::var("TRENCH_ENCOUNTERS").ok().map_or(60, |text| text.parse().unwrap());
    let mut eye = Eye::new();
    let (mut worst, mut elsewhere) = (0.0_f64, 0);
    for seed in 0..count {
        let paths = encounter(&mut Random(seed), 0.02);
        let mut tracker = team(&paths(-0.6));
        for frame in 0..30_u32 {
            let time = -0.6 + 0.04 * f64::from(frame);
            let [first, second] = [0, 1].map(|robot| -> Vec<Pose2> {
                (-2..=2).map(|instant| paths(time + 0.0025 * f64::from(instant))[robot]).collect()
            });
            tracker
                .step(if frame == 0 { 0.0 } else { 0.04 }, &eye.see(&[first, second], 100 * seed + u64::from(frame)));
            for (track, truth) in tracker.tracks().iter().zip(paths(time)) {
                assert_eq!(track.status, Status::Tracked, "encounter {seed}, frame {frame}");
                let seen = track.filter.as_ref().unwrap().state().pose;
                let off = (seen.x - truth.x).hypot(seen.y - truth.y);
                worst = worst.max(off);
                elsewhere += usize::from(off > 0.03);
            }
        }
    }
    println!("swaps in {count} rendered encounters: {elsewhere}; worst {:.3} mm off", 1e3 * worst);
    assert!(elsewhere == 0 && worst < 1e-3, "{elsewhere} frames with a robot elsewhere; {worst} m");
}
