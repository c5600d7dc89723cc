//! The Small Size League's pattern: codes and poses in painted frames, and a team that is known from the first frame on.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

use overhead_localizer::description;
use overhead_localizer::vision::coded::{CodeReader, CodedPad, DOTS, GREEN, MIDDLE};
use overhead_localizer::vision::{Colour, ColourLimits, Detector, Expectation, Frame};
use trench_config::ConfigError;
use trench_config::params::{Source as Given, resolve};
use trench_core::{Action, Event, Files, Level, NodeContext, NodeCore, Outbox, RosTime, Source, Steady, Times};
use trench_msgs::Encode;
use trench_msgs::msg::{RobotState, TeamState};
use trench_msgs::sensor_msgs::Image;
use trench_msgs::std_msgs::Header;
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pixel, Pose2};
use trench_sim::Random;

const LENS: &str = include_str!("../../../config/cameras/overhead.yaml");
const MOUNT: &str = include_str!("../../../config/cameras/overhead_mount.yaml");
const SIZE: [usize; 2] = [768, 576];
const BODY: f64 = 0.085;
/// Of a pixel, along each side.
const PARTS: u32 = 4;

struct Shipped;

impl Files for Shipped {
    fn read(&self, _: &str, path: &str) -> Result<String, ConfigError> {
        Ok(if path == "lens" { LENS } else { MOUNT }.to_owned())
    }
}

fn camera() -> Camera {
    Camera::new(CameraInfo::parse("", LENS).unwrap().lens, Mount::parse("", MOUNT).unwrap()).unwrap()
}

/// What is at a place of a robot's frame (m): None beside it.
fn paint(id: usize, middle: [f64; 3], [x, y]: [f64; 2]) -> Option<[f64; 3]> {
    let from = |place: [f64; 2]| libm::hypot(x - place[0], y - place[1]);
    if from([0.0, 0.0]) > BODY {
        return None;
    }
    if from([0.0, 0.0]) < 0.5 * MIDDLE {
        return Some(middle);
    }
    let dot = DOTS.iter().position(|dot| from(*dot) < 0.02);
    Some(dot.map_or([38.0, 38.0, 40.0], |dot| if GREEN[id][dot] { [70.0, 200.0, 80.0] } else { [235.0, 80.0, 160.0] }))
}

const YELLOW: [f64; 3] = [235.0, 205.0, 45.0];
const BLUE: [f64; 3] = [35.0, 80.0, 200.0];

/// rgb8 of pads on a grey floor, in light of this colour, with noise of 4/255.
fn picture(robots: &[(usize, [f64; 3], Pose2)], light: [f64; 3], seed: u64) -> Vec<u8> {
    let (camera, mut random) = (camera(), Random::new(seed, 7));
    let mut pixels = vec![[150.0, 150.0, 145.0]; SIZE[0] * SIZE[1]];
    for (id, middle, pose) in robots {
        let centre = nalgebra::Point3::new(pose.x, pose.y, Pad::NOMINAL.height);
        let Pixel { u, v } = camera.project(centre).unwrap();
        let (sine, cosine) = libm::sincos(pose.theta);
        for row in (v as usize - 34)..(v as usize + 34) {
            for column in (u as usize - 34)..(u as usize + 34) {
                let pixel = &mut pixels[row * SIZE[0] + column];
                let floor = *pixel;
                *pixel = [0.0; 3];
                for part in 0..PARTS * PARTS {
                    let within = |index: u32| (f64::from(index) + 0.5) / f64::from(PARTS) - 0.5;
                    let [u, v] = [column as f64 + within(part % PARTS), row as f64 + within(part / PARTS)];
                    let place = camera.unproject(Pixel { u, v }, Pad::NOMINAL.height).unwrap();
                    let (dx, dy) = (place.x - pose.x, place.y - pose.y);
                    let seen = paint(*id, *middle, [cosine * dx + sine * dy, cosine * dy - sine * dx]).unwrap_or(floor);
                    for channel in 0..3 {
                        pixel[channel] += seen[channel] / f64::from(PARTS * PARTS);
                    }
                }
            }
        }
    }
    let mut value = |channel: usize, value: f64| {
        // Three numbers between -1 and 1 have a standard deviation of 1.
        let noise: f64 = (0..3).map(|_| random.between(-1.0, 1.0)).sum();
        (light[channel] * value + 4.0 * noise).round().clamp(0.0, 255.0) as u8
    };
    pixels.iter().flat_map(|pixel| [0, 1, 2].map(|channel| value(channel, pixel[channel]))).collect()
}

/// Twelve places, a robot in each, turned anyhow.
fn team(seed: u64) -> Vec<(usize, [f64; 3], Pose2)> {
    let mut random = Random::new(seed, 3);
    let mut place = |index: usize| {
        let (x, y) = (0.35 + 0.58 * (index % 4) as f64, 0.35 + 0.55 * (index / 4) as f64);
        let theta = random.between(-3.1, 3.1);
        Pose2 { x: x + random.between(-0.1, 0.1), y: y + random.between(-0.1, 0.1), theta }
    };
    (0..12).map(|index| (index, YELLOW, place(index))).collect()
}

fn read(pixels: &[u8], colour: Colour) -> Vec<CodedPad> {
    let (camera, mut room, mut discs) = (camera(), Vec::new(), Vec::new());
    let expectation = Expectation::new(&camera, &Pad { disc_diameter: MIDDLE, ..Pad::NOMINAL }).unwrap();
    let mut detector = Detector::new(&ColourLimits::default(), expectation).of_single_discs();
    let frame = Frame::new(SIZE, "rgb8", SIZE, 3 * SIZE[0], pixels, &mut room).unwrap();
    detector.detect(frame, &mut discs);
    let reader = CodeReader::new(camera, Pad::NOMINAL.height);
    let own = discs.iter().filter(|disc| disc.colour == colour);
    own.filter_map(|disc| reader.read(frame, detector.light(), disc.centre)).collect()
}

fn angle(from: f64, to: f64) -> f64 {
    libm::remainder(to - from, std::f64::consts::TAU)
}

#[test]
fn codes_and_poses_are_read_in_any_light() {
    let (mut square, mut square_angle, mut count) = (0.0, 0.0, 0_usize);
    for seed in 0..30 {
        // White, a third of it, lamp light.
        let light = [[1.0; 3], [0.35; 3], [1.0, 0.7, 0.4]][seed as usize % 3];
        // Twelve of the sixteen numbers, others in each frame.
        let robots: Vec<_> =
            team(seed).into_iter().map(|(id, middle, pose)| ((id + seed as usize) % 16, middle, pose)).collect();
        let found = read(&picture(&robots, light, seed), Colour::Yellow);
        assert_eq!(found.len(), robots.len(), "seed {seed}: {found:?}");
        for (id, _, pose) in robots {
            let pad = found.iter().find(|pad| pad.id as usize == id).unwrap_or_else(|| panic!("seed {seed}: no {id}"));
            let off = libm::hypot(pad.pose.x - pose.x, pad.pose.y - pose.y);
            let turned = angle(pose.theta, pad.pose.theta);
            assert!(off < 1e-3 && turned.abs() < 0.015, "seed {seed}, {id}: off by {off} m, {turned} rad");
            (square, square_angle, count) = (square + off * off, square_angle + turned * turned, count + 1);
        }
    }
    let rms = |sum: f64| libm::sqrt(sum / count as f64);
    println!("RMS over {count} coded pads: {:.4} mm, {:.5} rad", 1e3 * rms(square), rms(square_angle));
    assert!(rms(square) < 0.5e-3 && rms(square_angle) < 0.004);
}

#[test]
fn blue_teams_are_read_and_other_things_are_no_code() {
    let mut robots = team(5);
    for (index, robot) in robots.iter_mut().enumerate() {
        robot.1 = if index < 6 { BLUE } else { YELLOW };
    }
    let mut pixels = picture(&robots, [1.0; 3], 5);
    let mut ids: Vec<u32> = read(&pixels, Colour::Blue).iter().map(|pad| pad.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, [0, 1, 2, 3, 4, 5]);
    // A hand over one dot: no code rather than a wrong one.
    let (_, _, pose) = robots[2];
    let (sine, cosine) = libm::sincos(pose.theta);
    let [x, y] = DOTS[1];
    let dot =
        nalgebra::Point3::new(pose.x + cosine * x - sine * y, pose.y + sine * x + cosine * y, Pad::NOMINAL.height);
    let Pixel { u, v } = camera().project(dot).unwrap();
    for row in v as usize - 9..v as usize + 9 {
        pixels[3 * (row * SIZE[0] + u as usize - 9)..3 * (row * SIZE[0] + u as usize + 9)].fill(90);
    }
    let mut ids: Vec<u32> = read(&pixels, Colour::Blue).iter().map(|pad| pad.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, [0, 1, 3, 4, 5]);
    // Our own pads, two discs beside each other, carry no code.
    let bare = trench_sim::camera::Renderer::new(camera(), Pad::NOMINAL, trench_sim::camera::Appearance::default());
    let mut pixels = vec![0; bare.frame_len()];
    let sweeps: Vec<_> = robots.iter().map(|(.., pose)| vec![*pose]).collect();
    bare.render(trench_sim::camera::Scene { robots: &sweeps, obstacles: &[] }, 1, &mut pixels).unwrap();
    assert_eq!((read(&pixels, Colour::Yellow), read(&pixels, Colour::Blue)), (Vec::new(), Vec::new()));
}

fn node(more: &str) -> Result<Box<dyn NodeCore>, String> {
    let text = format!(
        "overhead_localizer:\n  ros__parameters:\n    robots: [a, b, c]\n    pad_ids: [4, 9, 2]\n    camera_info_file: lens\n    \
         mount_file: mount\n{more}"
    );
    let description = description();
    let sources = [Given::File { name: "localizer.yaml", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)()).unwrap();
    (description.build)(&NodeContext::default(), &parameters, &Shipped).map_err(|error| error.to_string())
}

#[test]
fn a_coded_team_is_known_from_the_first_frame_on_however_it_is_carried() {
    let mut core = node("    pad.pattern: ssl_yellow\n").unwrap();
    let mut said = Vec::new();
    let mut see = |sequence: u64, robots: &[(usize, [f64; 3], Pose2)]| -> TeamState {
        let stamp = RosTime(40_000_000 * sequence as i64);
        let data = picture(robots, [1.0; 3], sequence);
        let header = Header { stamp: stamp.into(), frame_id: String::new() };
        let (encoding, step) = ("rgb8".to_owned(), 3 * SIZE[0] as u32);
        let image = Image { header, height: 576, width: 768, encoding, is_bigendian: 0, step, data };
        let (mut outbox, source) = (Outbox::default(), Source { gid: [1; 16], sequence });
        let at = Times { ros: stamp, steady: Steady(40_000_000 * sequence) };
        core.handle(at, Event::Message { port: 0, source, cdr: &image.to_cdr(), arrived: None }, &mut outbox);
        let errors = outbox.actions.iter().filter_map(|action| match action {
            Action::Log { level: Level::Error, text } => Some((sequence, text.clone())),
            _ => None,
        });
        said.extend(errors);
        outbox.last(0).unwrap()
    };
    let check = |state: &TeamState, poses: [Pose2; 3]| {
        for (robot, pose) in state.robots.iter().zip(poses) {
            let off = libm::hypot(robot.x - pose.x, robot.y - pose.y);
            assert!(robot.status == RobotState::STATUS_TRACKED && off < 1e-3, "{}: off by {off} m", robot.name);
        }
    };
    let pose = |x: f64, y: f64, theta: f64| Pose2 { x, y, theta };
    let poses = [pose(0.5, 0.5, 1.0), pose(1.2, 0.5, -2.0), pose(1.9, 1.2, 0.2)];
    // Number 7 is another team's; two touch.
    let all =
        |[a, b, c]: [Pose2; 3]| [(4, YELLOW, a), (9, YELLOW, b), (2, YELLOW, c), (7, YELLOW, pose(1.37, 0.5, 0.0))];
    check(&see(1, &all(poses)), poses);
    check(&see(2, &all(poses)), poses);
    // Two are carried to each other's places between two frames.
    let exchanged = [poses[2], poses[1], poses[0]];
    check(&see(3, &all(exchanged)), exchanged);
    // One is taken away, and put down elsewhere later.
    let without = [(9, YELLOW, poses[1]), (2, YELLOW, poses[0])];
    for sequence in 4..30 {
        see(sequence, &without);
    }
    assert_eq!(see(30, &without).robots[0].status, RobotState::STATUS_LOST);
    let put = [pose(0.6, 1.4, -1.0), poses[1], poses[0]];
    check(&see(31, &all(put)), put);
    // Two pads with one code: neither is believed, and that is said once. The others are where they are.
    let twice = [(4, YELLOW, put[0]), (4, YELLOW, poses[2]), (9, YELLOW, put[1]), (2, YELLOW, put[2])];
    for sequence in 32..36 {
        let state = see(sequence, &twice);
        let off = libm::hypot(state.robots[0].x - put[0].x, state.robots[0].y - put[0].y);
        assert!(state.robots[0].status == RobotState::STATUS_PREDICTED && off < 1e-3, "off by {off} m");
        assert!(state.robots[1..].iter().all(|robot| robot.status == RobotState::STATUS_TRACKED));
    }
    check(&see(36, &all(put)), put);
    let of_codes: Vec<_> = said.iter().filter(|(_, text)| text.contains("two pads have the code 4")).collect();
    assert!(matches!(of_codes[..], [(32, _)]), "{said:?}");
}

#[test]
fn patterns_that_cannot_be_read_are_refused() {
    let check = |more: &str, expected: &str| {
        let error = node(more).err().unwrap_or_default();
        assert!(error.contains(expected), "{more}: {error}");
    };
    check("    pad.pattern: aruco\n", "is no pattern; write discs, ssl_yellow or ssl_blue");
    check("    pad.pattern: ssl_blue\n    input: detections\n", "codes are read in images");
}
