//! Memory of the localizer's core, from images to encoded messages: what it holds after 300 frames, and the most it took
//! meanwhile, without the frame itself. Linux alone tells it. `memory` prints a table; each of its rows is a process of its own,
//! which finds nothing that others left behind.

mod bed;

use bed::{poses, scaled};
use overhead_localizer::description;
use std::error::Error;
use trench_config::ConfigError;
use trench_config::params::{Source as Given, resolve};
use trench_core::{Event, Files, NodeContext, Outbox, RosTime, Source, Steady, Times};
use trench_msgs::Encode;
use trench_msgs::sensor_msgs::Image;
use trench_msgs::std_msgs::Header;
use trench_optics::{Camera, CameraInfo, Mount, Pad};
use trench_sim::camera::{Appearance, Renderer, Scene};

const LENS: &str = include_str!("../../../config/cameras/overhead.yaml");
const FRAMES: u64 = 300;

/// The two files of a camera.
struct Texts {
    lens: String,
    mount: String,
}

impl Files for Texts {
    fn read(&self, _: &str, path: &str) -> Result<String, ConfigError> {
        Ok(if path == "lens" { &self.lens } else { &self.mount }.clone())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [path, scale, robots, encoding] = arguments.as_slice() {
        return measure(path, scale.parse()?, robots.parse()?, encoding);
    }
    println!("| frame, robots | encoding | held, KiB | at most, KiB |\n|---|---|---|---|");
    let path = std::env::temp_dir().join(format!("trench-memory-{}", std::process::id()));
    for scale in [1.0, 2.5] {
        for robots in [6, 20] {
            for encoding in ["rgb8", "yuv422_yuy2"] {
                std::fs::write(&path, image(scale, robots, encoding)?)?;
                let mut row = std::process::Command::new(std::env::current_exe()?);
                row.arg(&path).args([scale.to_string(), robots.to_string(), encoding.to_owned()]).status()?;
            }
        }
    }
    Ok(std::fs::remove_file(path)?)
}

/// A frame as a message.
fn image(scale: f64, robots: u32, encoding: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let lens = scaled(CameraInfo::parse("lens", LENS)?.lens, scale);
    let renderer = Renderer::new(Camera::new(lens, Mount::nominal())?, Pad::NOMINAL, Appearance::default());
    let mut data = vec![0; renderer.frame_len()];
    renderer.render(Scene { robots: &poses(1, robots), obstacles: &[] }, 1, &mut data)?;
    let bytes = if encoding == "rgb8" { 3 } else { 2 };
    if bytes == 2 {
        data = yuv(&data);
    }
    let header = Header { stamp: stamp(0).into(), frame_id: "overhead".to_owned() };
    let (width, height, step) = (lens.width, lens.height, bytes * lens.width);
    Ok(Image { header, height, width, encoding: encoding.to_owned(), is_bigendian: 0, step, data }.to_cdr())
}

fn measure(path: &str, scale: f64, robots: u32, encoding: &str) -> Result<(), Box<dyn Error>> {
    let mut cdr = std::fs::read(path)?;
    let info = CameraInfo::parse("lens", LENS)?;
    let lens = scaled(info.lens, scale);
    let texts = Texts { lens: CameraInfo { lens, ..info }.to_yaml(), mount: Mount::nominal().to_yaml() };
    let names: Vec<String> = (1..=robots).map(|robot| format!("robot{robot}")).collect();
    let text = format!(
        "overhead_localizer:\n  ros__parameters:\n    robots: [{}]\n    camera_info_file: lens\n    mount_file: mount\n    \
         names: order\n    frozen_frames: 0\n",
        names.join(", ")
    );
    // Everything else is there by now: what comes is the core's.
    let before = resident()?.held;
    std::fs::write("/proc/self/clear_refs", "5")?;
    let description = description();
    let sources = [Given::File { name: "parameters", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)())
        .map_err(|mut errors| errors.swap_remove(0))?;
    let mut core = (description.build)(&NodeContext::default(), &parameters, &texts)?;
    for number in 1..=FRAMES {
        // The stamp alone differs: seconds and nanoseconds follow the encapsulation header.
        let stamp: trench_msgs::builtin_interfaces::Time = stamp(number).into();
        cdr[4..8].copy_from_slice(&stamp.sec.to_le_bytes());
        cdr[8..12].copy_from_slice(&stamp.nanosec.to_le_bytes());
        let at = Times { ros: self::stamp(number), steady: Steady(40_000_000 * number) };
        let source = Source { gid: [1; 16], sequence: number };
        let mut outbox = Outbox::default();
        core.handle(at, Event::Message { port: 0, source, cdr: &cdr, arrived: None }, &mut outbox);
    }
    let Resident { held, most } = resident()?;
    let [held, most] = [held, most].map(|kib| kib.saturating_sub(before));
    println!("| {} x {}, {robots} | {encoding} | {held} | {most} |", lens.width, lens.height);
    Ok(())
}

fn stamp(number: u64) -> RosTime {
    RosTime(1_000_000_000 + 40_000_000 * number as i64)
}

/// rgb8 as a USB camera would have sent it.
fn yuv(rgb: &[u8]) -> Vec<u8> {
    let luma =
        |pixel: &[u8]| 16.0 + 0.257 * f64::from(pixel[0]) + 0.504 * f64::from(pixel[1]) + 0.098 * f64::from(pixel[2]);
    let pair = |two: &[u8]| {
        let [red, green, blue] = [0, 1, 2].map(|channel| 0.5 * (f64::from(two[channel]) + f64::from(two[channel + 3])));
        let (u, v) =
            (128.0 - 0.148 * red - 0.291 * green + 0.439 * blue, 128.0 + 0.439 * red - 0.368 * green - 0.071 * blue);
        [luma(&two[..3]), u, luma(&two[3..]), v].map(|value| value as u8)
    };
    rgb.chunks_exact(6).flat_map(pair).collect()
}

/// Memory of this process, KiB.
struct Resident {
    held: u64,
    most: u64,
}

fn resident() -> Result<Resident, Box<dyn Error>> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let value = |key: &str| -> Result<u64, Box<dyn Error>> {
        let line = status.lines().find_map(|line| line.strip_prefix(key)).ok_or("no such line")?;
        Ok(line.trim().trim_end_matches(" kB").parse()?)
    };
    Ok(Resident { held: value("VmRSS:")?, most: value("VmHWM:")? })
}
