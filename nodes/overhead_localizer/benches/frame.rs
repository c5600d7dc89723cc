//! What a frame of six robots costs: rendering it, finding its discs, and the whole node from image to messages.

use criterion::{Criterion, criterion_group, criterion_main};
use overhead_localizer::description;
use overhead_localizer::vision::{ColourLimits, Detector, Expectation, Frame};
use std::error::Error;
use trench_config::ConfigError;
use trench_config::params::{Source as Given, resolve};
use trench_core::{Event, Files, Level, NodeContext, NodeCore, RequestId, RosTime, Sink, Source, Steady, Times};
use trench_msgs::Encode;
use trench_msgs::sensor_msgs::Image;
use trench_msgs::std_msgs::Header;
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer, Scene};

const LENS: &str = include_str!("../../../config/cameras/overhead.yaml");
const MOUNT: &str = include_str!("../../../config/cameras/overhead_mount.yaml");
const PARAMETERS: &str = "overhead_localizer:
  ros__parameters:
    robots: [robot1, robot2, robot3, robot4, robot5, robot6]
    camera_info_file: lens
    mount_file: mount
";
const FRAMES: i64 = 60;

struct Shipped;

impl Files for Shipped {
    fn read(&self, _: &str, path: &str) -> Result<String, ConfigError> {
        Ok(if path == "lens" { LENS } else { MOUNT }.to_owned())
    }
}

/// Encodes what is published, as a transport does, and keeps nothing.
struct Encoder(Vec<u8>);

impl Sink for Encoder {
    fn publish_with(&mut self, _: usize, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) {
        self.0.resize(max_len.max(self.0.len()), 0);
        fill(&mut self.0);
    }
    fn respond(&mut self, _: usize, _: RequestId, _: &dyn Encode) {}
    fn call(&mut self, _: usize, _: &dyn Encode) {}
    fn write_bytes(&mut self, _: usize, _: &[u8]) {}
    fn log(&mut self, _: Level, _: &str) {}
    fn checkpoint(&mut self, _: &[u8]) {}
    fn exit(&mut self, _: u8) {}
}

/// Six robots on parallel circles at 0.2 m/s, four instants of the exposure each.
fn robots(frame: i64) -> Vec<Vec<Pose2>> {
    let pose = |robot: u32, instant: u32| {
        let turned = f64::from(robot) + (frame as f64 * 0.04 + f64::from(instant) * 0.0025) / 0.6;
        let (x, y) = (0.5 + 0.7 * f64::from(robot % 3), 0.5 + 0.75 * f64::from(robot / 3));
        let theta = turned + std::f64::consts::FRAC_PI_2;
        Pose2 { x: x + 0.12 * turned.cos(), y: y + 0.12 * turned.sin(), theta }
    };
    (0..6).map(|robot| (0..4).map(|instant| pose(robot, instant)).collect()).collect()
}

fn core() -> Result<Box<dyn NodeCore>, Box<dyn Error>> {
    let description = description();
    let sources = [Given::File { name: "parameters", text: PARAMETERS }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)())
        .map_err(|mut errors| errors.swap_remove(0))?;
    Ok((description.build)(&NodeContext::default(), &parameters, &Shipped)?)
}

fn run(criterion: &mut Criterion) -> Result<(), Box<dyn Error>> {
    let camera = Camera::new(CameraInfo::parse("lens", LENS)?.lens, Mount::parse("mount", MOUNT)?)?;
    let renderer = Renderer::new(camera.clone(), Pad::NOMINAL, Appearance::default());
    let mut images = Vec::new();
    for frame in 0..FRAMES {
        let mut data = vec![0; renderer.frame_len()];
        renderer.render(Scene { robots: &robots(frame), obstacles: &[] }, frame as u64, &mut data)?;
        let header = Header { stamp: RosTime(40_000_000 * frame).into(), frame_id: "overhead".to_owned() };
        let encoding = "rgb8".to_owned();
        images.push(Image { header, height: 576, width: 768, encoding, is_bigendian: 0, step: 2304, data });
    }

    let mut target = vec![0; renderer.frame_len()];
    let scene = robots(0);
    let mut number = 0;
    criterion.bench_function("render, 6 robots, 4 instants, noise", |bencher| {
        bencher.iter(|| {
            number += 1;
            renderer.render(Scene { robots: &scene, obstacles: &[] }, number, &mut target)
        });
    });

    let expectation = Expectation::new(&camera, &Pad::NOMINAL).ok_or("the camera sees no pad")?;
    let mut detector = Detector::new(&ColourLimits::default(), expectation);
    let mut room = Vec::new();
    let mut discs = Vec::new();
    let mut turn = images.iter().cycle();
    criterion.bench_function("detect discs, 6 robots", |bencher| {
        bencher.iter(|| {
            let image = turn.next().map_or(&[][..], |image| &image.data);
            if let Ok(frame) = Frame::new([768, 576], "rgb8", [768, 576], 2304, image, &mut room) {
                detector.detect(frame, &mut discs);
            }
            discs.len()
        });
    });

    let encoded: Vec<Vec<u8>> = images.iter().map(Encode::to_cdr).collect();
    let mut core = core()?;
    let mut sink = Encoder(Vec::new());
    let mut sequence = 0;
    criterion.bench_function("node, image to messages, 6 robots", |bencher| {
        bencher.iter(|| {
            // The film begins anew with a clock set back, which the node takes as such.
            let index = sequence as usize % encoded.len();
            sequence += 1;
            let source = Source { gid: [1; 16], sequence };
            let at = Times { ros: RosTime(40_000_000 * index as i64), steady: Steady(40_000_000 * sequence) };
            core.handle(at, Event::Message { port: 0, source, cdr: &encoded[index], arrived: None }, &mut sink);
        });
    });
    Ok(())
}

fn benches(criterion: &mut Criterion) {
    if let Err(error) = run(criterion) {
        eprintln!("{error}");
    }
}

criterion_group!(all, benches);
criterion_main!(all);
