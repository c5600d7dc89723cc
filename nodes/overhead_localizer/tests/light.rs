//! Pads in bad light: from 30 to 300 % of nominal in one picture, lamps and daylight, blur, JPEG, things of their colours.
//!
//! `TRENCH_SEEDS` sets how many frames each light gets, in fifties, in fifteens behind JPEG (20 in scripts/acceptance).
#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use overhead_localizer::track::{MapDisc, Robot, Settings, Status, Tracker, wrap};
use overhead_localizer::vision::{ColourLimits, Detector, Expectation, Frame, decode};
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::Random;
use trench_sim::camera::{Appearance, Background, Renderer, Scene};

fn frames(transport: Transport) -> u64 {
    let each = if transport == Transport::Raw { 50 } else { 15 };
    each * std::env::var("TRENCH_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(1)
}

fn camera() -> Camera {
    let lens = CameraInfo::parse("overhead.yaml", include_str!("../../../config/cameras/overhead.yaml")).unwrap().lens;
    Camera::new(lens, Mount { roll: 0.008, pitch: -0.006, yaw: 0.01, ..Mount::nominal() }).unwrap()
}

/// What is found of robots in frames of one light.
#[derive(Debug, Default)]
struct Score {
    robots: f64,
    found: f64,
    /// Pads where no robot is, and frames.
    false_pads: u64,
    frames: u64,
    position2: f64,
    heading2: f64,
}

impl Score {
    fn recall(&self) -> f64 {
        self.found / self.robots
    }

    /// m, rad
    fn rms(&self) -> [f64; 2] {
        [self.position2, self.heading2].map(|sum| (sum / self.found.max(1.0)).sqrt())
    }
}

/// What is done to a frame before it is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Transport {
    Raw,
    /// At this quality, colours at half the resolution, as cameras send it.
    Jpeg(u8),
}

/// Luma of every pixel, colours of every second one in every second row: the mean over four, as cameras make it. The encoder
/// takes one of the four.
fn halved(image: &[u8]) -> Vec<u8> {
    let mut packed = vec![0; image.len()];
    for (top, left) in (0..576).step_by(2).flat_map(|top| (0..768).step_by(2).map(move |left| (top, left))) {
        let places = [0, 1, 768, 769].map(|next| 3 * (768 * top + left + next));
        let value = |place: usize| f32::from(image[place]);
        let luma = |red: f32, green: f32, blue: f32| 0.299 * red + 0.587 * green + 0.114 * blue;
        let mean = [0, 1, 2].map(|channel| 0.25 * places.iter().map(|place| value(place + channel)).sum::<f32>());
        let grey = luma(mean[0], mean[1], mean[2]);
        let colours = [128.0 + (mean[2] - grey) / 1.772, 128.0 + (mean[0] - grey) / 1.402].map(|c| (c + 0.5) as u8);
        for place in places {
            packed[place] = (luma(value(place), value(place + 1), value(place + 2)) + 0.5) as u8;
            packed[place + 1..place + 3].copy_from_slice(&colours);
        }
    }
    packed
}

/// Six robots that drive at 0.2 m/s through the exposure, elsewhere in every frame.
fn robots(random: &mut Random) -> Vec<Vec<Pose2>> {
    let mut poses: Vec<Pose2> = Vec::new();
    while poses.len() < 6 {
        let pose =
            Pose2 { x: random.between(0.16, 2.32), y: random.between(0.16, 1.67), theta: random.between(-3.1, 3.1) };
        if poses.iter().all(|other| (other.x - pose.x).hypot(other.y - pose.y) > 0.17) {
            poses.push(pose);
        }
    }
    let instant = |pose: &Pose2, k: i32| {
        let along = 0.2 * 0.0025 * (f64::from(k) - 1.5);
        Pose2 { x: pose.x + along * pose.theta.cos(), y: pose.y + along * pose.theta.sin(), ..*pose }
    };
    poses.iter().map(|pose| (0..4).map(|k| instant(pose, k)).collect()).collect()
}

fn score(appearance: Appearance, transport: Transport, paint: impl Fn(&mut [u8], &mut Random)) -> Score {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, appearance);
    let mut detector = Detector::new(&ColourLimits::default(), Expectation::new(&camera(), &Pad::NOMINAL).unwrap());
    let mut random = Random::new(appearance.seed, 61);
    let mut score = Score::default();
    let (mut image, mut discs) = (vec![0; renderer.frame_len()], Vec::new());
    for frame in 0..frames(transport) {
        let sweeps = robots(&mut random);
        renderer.render(Scene { robots: &sweeps, obstacles: &[] }, frame, &mut image).unwrap();
        paint(&mut image, &mut random);
        let bytes = match transport {
            Transport::Raw => image.clone(),
            Transport::Jpeg(quality) => {
                let mut packed = Vec::new();
                let mut encoder = Encoder::new(&mut packed, quality);
                encoder.set_sampling_factor(SamplingFactor::F_2_2);
                encoder.encode(&halved(&image), 768, 576, ColorType::Ycbcr).unwrap();
                decode(&packed).unwrap().into_raw()
            }
        };
        let mut room = Vec::new();
        detector.detect(Frame::new([768, 576], "rgb8", [768, 576], 2304, &bytes, &mut room).unwrap(), &mut discs);
        let camera = renderer.camera();
        let seen: Vec<MapDisc> = discs
            .iter()
            .filter_map(|disc| MapDisc::seen(camera, Pad::NOMINAL.height, disc.colour, disc.centre))
            .collect();
        let truth: Vec<Pose2> = sweeps
            .iter()
            .map(|sweep| Pose2 { x: 0.5 * (sweep[0].x + sweep[3].x), y: 0.5 * (sweep[0].y + sweep[3].y), ..sweep[0] })
            .collect();
        let named = truth.iter().enumerate().map(|(k, pose)| Robot { name: format!("robot{k}"), start: Some(*pose) });
        let mut tracker = Tracker::new(Settings::new(named.collect()), 0);
        let pads = tracker.step(0.0, &seen);
        let mut found = 0;
        for (track, pose) in tracker.tracks().iter().zip(&truth) {
            score.robots += 1.0;
            if track.status == Status::Tracked {
                let at = track.filter.as_ref().unwrap().state().pose;
                found += 1;
                score.found += 1.0;
                score.position2 += (at.x - pose.x).powi(2) + (at.y - pose.y).powi(2);
                score.heading2 += wrap(at.theta - pose.theta).powi(2);
            }
        }
        score.false_pads += pads.saturating_sub(found) as u64;
        score.frames += 1;
    }
    let [position, heading] = score.rms();
    println!(
        "light to {:.1}, darkest {:.2} of it, {:.0} K, {transport:?}: recall {:.4}, {} false pads in {} frames, {:.3} mm, {:.5} rad",
        appearance.brightness,
        1.0 - appearance.gradient,
        appearance.temperature,
        score.recall(),
        score.false_pads,
        score.frames,
        1e3 * position,
        heading
    );
    score
}

const TEMPERATURES: [f64; 3] = [2700.0, 5000.0, 6500.0];
/// The brightest light, of nominal, and how much less of it there is where it is darkest.
const BAD: [(f64, f64); 4] = [(3.0, 0.9), (0.3, 0.0), (1.0, 0.7), (3.0, 0.3)];

#[test]
fn good_light_gives_half_a_millimetre() {
    for (seed, temperature) in (0..).zip(TEMPERATURES) {
        let score = score(Appearance { temperature, seed, ..Appearance::default() }, Transport::Raw, |_, _| ());
        let [position, heading] = score.rms();
        assert!(score.recall() >= 0.999 && score.false_pads == 0 && position < 5e-4 && heading < 0.004, "{score:?}");
    }
}

#[test]
fn bad_light_gives_a_millimetre() {
    for (seed, temperature) in (10..).zip(TEMPERATURES) {
        for (brightness, gradient) in BAD {
            let appearance = Appearance { brightness, gradient, temperature, seed, ..Appearance::default() };
            let score = score(appearance, Transport::Raw, |_, _| ());
            let [position, heading] = score.rms();
            assert!(
                score.recall() >= 0.999 && score.false_pads == 0 && position < 1e-3 && heading < 0.01,
                "{appearance:?}: {score:?}"
            );
        }
    }
}

/// In lamp light of 2700 K a yellow disc's chroma is no more than JPEG's noise: it is found by its partner and its brightness.
#[test]
fn jpeg_at_quality_70_gives_a_millimetre_in_any_light() {
    for (seed, temperature) in (10..).zip(TEMPERATURES) {
        for (brightness, gradient) in BAD {
            let appearance = Appearance { brightness, gradient, temperature, seed, ..Appearance::default() };
            let score = score(appearance, Transport::Jpeg(70), |_, _| ());
            let [position, heading] = score.rms();
            assert!(
                score.recall() >= 0.999 && score.false_pads == 0 && position < 1e-3 && heading < 0.01,
                "{appearance:?}: {score:?}"
            );
        }
    }
}

/// A yellow cable and a blue shoe, elsewhere in every frame, behind no robot's pad.
fn things(image: &mut [u8], random: &mut Random) {
    let (u, v) = (random.between(60.0, 700.0), random.between(60.0, 520.0));
    let angle = random.between(0.0, 3.1);
    let (sin, cos) = angle.sin_cos();
    let (shoe_u, shoe_v) = (random.between(60.0, 700.0), random.between(60.0, 520.0));
    for row in 0..576_u32 {
        for column in 0..768_u32 {
            let (du, dv) = (f64::from(column) - u, f64::from(row) - v);
            let (along, across) = (du * cos + dv * sin, dv * cos - du * sin);
            let on_cable = (across - 20.0 * (along / 60.0).sin()).abs() < 4.0 && along.abs() < 150.0;
            let (du, dv) = (f64::from(column) - shoe_u, f64::from(row) - shoe_v);
            let (along, across) = (du * cos + dv * sin, dv * cos - du * sin);
            let on_shoe = (along / 45.0).powi(2) + (across / 17.0).powi(2) < 1.0;
            let place = 3 * (768 * row + column) as usize;
            // Robots stand on cables, and before shoes: what is dark is theirs.
            let is_floor = image[place..place + 3].iter().all(|value| *value > 95);
            if is_floor && (on_cable || on_shoe) {
                image[place..place + 3].copy_from_slice(if on_cable { &[230, 200, 40] } else { &[30, 70, 190] });
            }
        }
    }
}

#[test]
fn cables_and_shoes_are_no_robots() {
    for background in [Background::Plain([150, 150, 145]), Background::Wood] {
        for transport in [Transport::Raw, Transport::Jpeg(70)] {
            let appearance = Appearance { background, seed: 40, gradient: 0.1, ..Appearance::default() };
            let score = score(appearance, transport, things);
            assert!(score.recall() >= 0.999 && score.false_pads == 0, "{transport:?}: {score:?}");
        }
    }
}

/// Six dark cables across the picture.
fn cables(image: &mut [u8], random: &mut Random) {
    for _ in 0..6 {
        let (u, v) = (random.between(100.0, 660.0), random.between(80.0, 490.0));
        let (sin, cos) = random.between(0.0, 3.1).sin_cos();
        for row in 0..576_u32 {
            for column in 0..768_u32 {
                let across = (f64::from(row) - v) * cos - (f64::from(column) - u) * sin;
                if across.abs() < 2.5 {
                    let place = 3 * (768 * row + column) as usize;
                    image[place..place + 3].copy_from_slice(&[40, 40, 42]);
                }
            }
        }
    }
}

#[test]
fn pads_below_cables_are_found() {
    let score = score(Appearance { seed: 50, ..Appearance::default() }, Transport::Raw, cables);
    let [position, heading] = score.rms();
    // Where three cables cross on a pad, too little of it is left: in few frames that may be one.
    let missed = score.robots - score.found;
    assert!(missed <= (0.001 * score.robots).max(1.0), "{score:?}");
    assert!(score.false_pads == 0 && position < 1e-3 && heading < 0.01, "{score:?}");
}
