//! `trench calibrate` as people call it: files in, files out, exit codes.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[path = "support/own_memory.rs"]
mod own_memory;

use image::{GrayImage, RgbImage};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use own_memory::OwnMemory;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use trench_optics::{Camera, CameraInfo, Lens, Mount, Pad, PlumbBob, Pose2};
use trench_sim::camera::{Appearance, HeldBoard, Renderer, Scene, render_board};

fn lens() -> Lens {
    Lens { distortion: PlumbBob { k1: -0.1, k2: 0.01, p1: 4e-4, p2: -3e-4, k3: 0.0 }, ..Lens::nominal() }
}

/// Runs `trench calibrate` in a folder; its exit code and what it said.
fn calibrate(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_trench"))
        .arg("calibrate")
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(said).unwrap())
}

#[test]
fn a_board_is_printed_and_a_lens_found_from_its_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let (code, said) = calibrate(path, &["print", "--square", "0.06", "--out", "board.svg"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(std::fs::read_to_string(path.join("board.svg")).unwrap().contains("660mm"));
    let mut arguments = vec!["lens".to_owned()];
    for index in 0..10_u32 {
        let phase = f64::from(index);
        let tilt = Vector3::new(0.5 * (1.3 * phase).sin(), 0.5 * (1.7 * phase).cos(), 0.2 * phase.sin());
        let turn = UnitQuaternion::from_scaled_axis(tilt);
        let place = Vector3::new(0.15 * (2.1 * phase).sin(), 0.1 * (2.9 * phase).cos(), 1.1 + 0.15 * phase.cos());
        let middle = turn * Vector3::new(0.21, 0.15, 0.0);
        let camera_from_board = Isometry3::from_parts(Translation3::from(place - middle), turn);
        let board = HeldBoard { columns: 9, rows: 6, square: 0.06, camera_from_board };
        let name = format!("{index}.png");
        let pixels = render_board(&lens(), &board, 3.0, u64::from(index));
        GrayImage::from_raw(768, 576, pixels).unwrap().save(path.join(&name)).unwrap();
        arguments.push(name);
    }
    GrayImage::from_pixel(768, 576, image::Luma([90])).save(path.join("empty.png")).unwrap();
    arguments.extend(["empty.png", "--square", "0.06", "--camera", "lab"].map(str::to_owned));
    let (code, said) = calibrate(path, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("left out empty.png: 0 corners are seen") && said.contains("residual 0."), "{said}");
    let found = CameraInfo::parse("lens.yaml", &std::fs::read_to_string(path.join("lens.yaml")).unwrap()).unwrap();
    assert!(found.name == "lab" && (found.lens.fx - lens().fx).abs() < 5.0, "{found:?}");
    assert!(path.join("lens.svg").exists() && path.join("lens.txt").exists());
    let (code, said) = calibrate(path, &["lens", "empty.png"]);
    assert!(code == Some(2) && said.contains("0 pictures show the board"), "{said}");
}

#[test]
fn a_mount_is_found_and_a_bad_point_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("lens.yaml"), CameraInfo { name: "lab".to_owned(), lens: lens() }.to_yaml()).unwrap();
    let truth = Mount { x: 1.3, y: 0.88, height: 2.9, roll: 0.01, pitch: -0.02, yaw: 0.03 };
    let camera = Camera::new(lens(), truth).unwrap();
    let points = |off: f64| {
        let point = |index: u8| {
            let (x, y) = (0.3 + 0.9 * f64::from(index % 3), 0.3 + 0.6 * f64::from(index / 3));
            let pixel = camera.project(Point3::new(x, y, 0.0)).unwrap();
            let x = if index == 4 { x + off } else { x };
            format!("- {{name: mark {index}, pixel: [{:.1}, {:.1}], map: [{x}, {y}]}}\n", pixel.u, pixel.v)
        };
        format!("points:\n{}", (0..9).map(point).collect::<String>())
    };
    std::fs::write(path.join("good.yaml"), points(0.0)).unwrap();
    let (code, said) = calibrate(path, &["field", "good.yaml"]);
    assert!(code == Some(0) && said.contains("all points agree"), "{said}");
    let mount = Mount::parse("mount.yaml", &std::fs::read_to_string(path.join("mount.yaml")).unwrap()).unwrap();
    assert!((mount.height - truth.height).abs() < 0.01 && (mount.yaw - truth.yaw).abs() < 1e-3, "{mount:?}");
    std::fs::write(path.join("bad.yaml"), points(0.03)).unwrap();
    let (code, said) = calibrate(path, &["field", "bad.yaml", "--out", "bad_mount.yaml"]);
    assert!(code == Some(1) && said.contains("mark 4 does not agree with the others"), "{said}");
    std::fs::write(path.join("few.yaml"), "points:\n- {pixel: [1, 1], map: [0, 0]}\n").unwrap();
    let (code, said) = calibrate(path, &["field", "few.yaml", "--out", "few_mount.yaml"]);
    assert!(code == Some(2) && said.contains("1 points are given") && !path.join("few_mount.yaml").exists(), "{said}");
}

#[test]
fn colours_are_learned_from_clicks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("lens.yaml"), CameraInfo { name: "lab".to_owned(), lens: lens() }.to_yaml()).unwrap();
    let camera = Camera::new(lens(), Mount::nominal()).unwrap();
    let renderer = Renderer::new(camera.clone(), Pad::NOMINAL, Appearance::default());
    let pose = Pose2 { x: 1.0, y: 0.8, theta: 0.5 };
    let mut pixels = vec![0; renderer.frame_len()];
    renderer.render(Scene { robots: &[vec![pose]], obstacles: &[] }, 1, &mut pixels).unwrap();
    RgbImage::from_raw(768, 576, pixels).unwrap().save(path.join("field.png")).unwrap();
    let [yellow, blue] = Pad::NOMINAL.discs(pose).map(|disc| {
        let pixel = camera.project(Point3::new(disc.x, disc.y, Pad::NOMINAL.height)).unwrap();
        format!("{:.0},{:.0}", pixel.u, pixel.v)
    });
    let (code, said) = calibrate(path, &["colours", "field.png", "--yellow", &yellow, "--blue", &blue]);
    assert_eq!(code, Some(0), "{said}");
    let text = std::fs::read_to_string(path.join("colours.yaml")).unwrap();
    assert!(text.contains("camera: \"lab\"") && text.contains("overhead_localizer"), "{text}");
    // In lamp light a blue disc hardly has more blue than red: the light's own colour is taken out.
    let mut lamp = image::open(path.join("field.png")).unwrap().into_rgb8();
    lamp.pixels_mut().for_each(|pixel| pixel.0 = [pixel.0[0], (f64::from(pixel.0[1]) * 0.7) as u8, pixel.0[2] / 3]);
    lamp.save(path.join("lamp.png")).unwrap();
    let in_lamp_light = ["colours", "lamp.png", "--yellow", &yellow, "--blue", &blue, "--out", "lamp.yaml"];
    let (code, said) = calibrate(path, &in_lamp_light);
    assert_eq!(code, Some(0), "{said}");
    let limit = |name: &str| {
        let text = std::fs::read_to_string(path.join(name)).unwrap();
        let number = text.split("yellow: ").nth(1).and_then(|rest| rest.split(',').next()).map(str::to_owned);
        number.unwrap().parse::<f64>().unwrap()
    };
    let (white, lamp) = (limit("colours.yaml"), limit("lamp.yaml"));
    assert!((white - lamp).abs() < 0.1, "yellow from {white} in white light, from {lamp} in lamp light");
    let (code, said) = calibrate(path, &["colours", "field.png", "--yellow", &blue, "--blue", &yellow]);
    assert!(code == Some(2) && said.contains("yellow cannot be told from the rest"), "{said}");
    let (code, said) = calibrate(path, &["colours", "field.png", "--yellow", "900,1", "--blue", &blue]);
    assert!(code == Some(2) && said.contains("(900, 1) is outside the picture"), "{said}");
}

/// The localizer of the test bed's camera, as a process, killed with this.
struct Localizer {
    process: Child,
    domain: String,
    /// Its shared memory; goes after it.
    memory: OwnMemory,
}

impl Localizer {
    fn environment<'a>(domain: &'a str, memory: &'a OwnMemory) -> [(&'static str, &'a str); 2] {
        [("ROS_DOMAIN_ID", domain), ("TRENCH_SHM_PREFIX", &memory.0)]
    }

    fn start() -> Self {
        let domain = (71 + (std::process::id() % 7) * 4).to_string();
        let memory = OwnMemory(format!("cal{}", std::process::id()));
        let cameras = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/cameras");
        let file = |name: &str| cameras.join(name).display().to_string();
        let process = Command::new(Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("overhead_localizer"))
            .args(["--ros-args", "-p", "robots:=[robot1]", "-p"])
            .arg(format!("camera_info_file:={}", file("overhead.yaml")))
            .args(["-p", &format!("mount_file:={}", file("overhead_mount.yaml"))])
            .envs(Self::environment(&domain, &memory))
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        Self { process, domain, memory }
    }

    fn apply(&self, folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
        let output = Command::new(env!("CARGO_BIN_EXE_trench"))
            .args(["calibrate", "apply"])
            .args(arguments)
            .current_dir(folder)
            .envs(Self::environment(&self.domain, &self.memory))
            .output()
            .unwrap();
        let said = [output.stdout, output.stderr].concat();
        (output.status.code(), String::from_utf8(said).unwrap())
    }
}

impl Drop for Localizer {
    fn drop(&mut self) {
        let _ended = self.process.kill();
        let _status = self.process.wait();
    }
}

#[test]
fn live_a_running_localizer_takes_what_was_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("mount.yaml"), Mount { x: 1.3, yaw: 0.02, ..Mount::nominal() }.to_yaml()).unwrap();
    std::fs::write(path.join("lens.yaml"), "camera_name: overhead\n").unwrap();
    let colours = |camera: &str| {
        format!(
            "/**/overhead_localizer:\n  ros__parameters:\n    colour: {{camera: {camera}, yellow: 0.4, blue: 0.5, minimum: 30.0}}\n"
        )
    };
    std::fs::write(path.join("colours.yaml"), colours("overhead")).unwrap();
    std::fs::write(path.join("theirs.yaml"), colours("another")).unwrap();
    std::fs::write(path.join("nobodys.yaml"), "/else:\n  ros__parameters: {speed: 1.0}\n").unwrap();
    let mut localizer = Localizer::start();

    let (code, said) = localizer.apply(path, &["--mount", "mount.yaml", "--colours", "colours.yaml"]);
    assert!(code == Some(0) && said.contains("colours are in force"), "{code:?} {said}");
    // Another camera: neither alone, both together.
    let lens = CameraInfo { name: "another".to_owned(), lens: Lens::nominal() };
    std::fs::write(path.join("another.yaml"), lens.to_yaml()).unwrap();
    let (code, said) = localizer.apply(path, &["--lens", "another.yaml"]);
    assert!(code == Some(1) && said.contains("those of the camera overhead, not of another"), "{code:?} {said}");
    let (code, said) = localizer.apply(path, &["--lens", "another.yaml", "--colours", "theirs.yaml"]);
    assert!(code == Some(0) && said.contains("colours are in force"), "{code:?} {said}");
    let lens = CameraInfo { name: "overhead".to_owned(), ..lens };
    std::fs::write(path.join("overhead.yaml"), lens.to_yaml()).unwrap();
    let (code, said) = localizer.apply(path, &["--lens", "overhead.yaml", "--colours", "colours.yaml"]);
    assert!(code == Some(0), "{code:?} {said}");
    let (code, said) = localizer.apply(path, &["--colours", "theirs.yaml"]);
    assert!(code == Some(1) && said.contains("not the colours of the camera"), "{code:?} {said}");
    let (code, said) = localizer.apply(path, &["--lens", "lens.yaml"]);
    assert!(code == Some(1) && said.contains("refused"), "{code:?} {said}");
    let (code, said) = localizer.apply(path, &["--colours", "nobodys.yaml"]);
    assert!(code == Some(3) && said.contains("says nothing of this localizer"), "{code:?} {said}");
    let (code, said) = localizer.apply(path, &["--mount", "missing.yaml"]);
    assert!(code == Some(3) && said.contains("missing.yaml"), "{code:?} {said}");
    let (code, said) = localizer.apply(path, &[]);
    assert!(code == Some(2) && said.contains("--mount"), "{code:?} {said}");

    localizer.process.kill().unwrap();
    localizer.process.wait().unwrap();
    let (code, said) = localizer.apply(path, &["--mount", "mount.yaml"]);
    assert!(code == Some(2) && said.contains("nobody answers"), "{code:?} {said}");
}
