//! `trench calibrate live`: the page in headless Chromium before a camera that sends frames, with a localizer that takes over
//! what was learned.

#![expect(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that cannot go on fails")]

#[path = "support/own_memory.rs"]
mod own_memory;
#[path = "support/running.rs"]
mod running;
#[expect(dead_code, reason = "the page of trench view uses the rest")]
mod view_support;

use image::RgbImage;
use nalgebra::Point3;
use own_memory::OwnMemory;
use running::Running;
use rustix::process::getpriority_process;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer, Scene};
use view_support::{Browser, Viewer};

const ROBOTS: usize = 4;

fn config(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("config/cameras").join(name)
}

/// The test bed's camera.
fn camera() -> Camera {
    let read = |name| std::fs::read_to_string(config(name)).unwrap();
    let lens = CameraInfo::parse("lens", &read("overhead.yaml")).unwrap().lens;
    Camera::new(lens, Mount::parse("mount", &read("overhead_mount.yaml")).unwrap()).unwrap()
}

fn poses() -> [Pose2; ROBOTS] {
    [(0.5, 0.5, 0.3), (1.2, 0.5, 2.0), (1.9, 1.3, -1.0), (0.8, 1.4, -2.5)].map(|(x, y, theta)| Pose2 { x, y, theta })
}

/// A node of the workspace.
fn start(node: &str, parameters: &[String], variables: &[(&str, &str)]) -> Running {
    let program = Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name(node);
    let mut command = Command::new(program);
    command.arg("--ros-args").args(parameters.iter().flat_map(|one| ["-p", one])).envs(variables.iter().copied());
    Running::start(command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()))
}

/// Frames of four robots in warm light, with noise, for a camera that reads a folder.
fn frames(folder: &Path) {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    std::fs::create_dir(folder).unwrap();
    for index in 0..3_u64 {
        let mut pixels = vec![0; renderer.frame_len()];
        let robots = poses().map(|pose| vec![pose]);
        renderer.render(Scene { robots: &robots, obstacles: &[] }, index, &mut pixels).unwrap();
        for pixel in pixels.chunks_exact_mut(3) {
            pixel[2] = (f64::from(pixel[2]) * 0.75) as u8;
        }
        RgbImage::from_raw(768, 576, pixels).unwrap().save(folder.join(format!("{index}.png"))).unwrap();
    }
}

/// A script that points at this pixel of the picture, and clicks.
fn click(u: f64, v: f64) -> String {
    format!(
        "{{ const c = document.getElementById('picture'), b = c.getBoundingClientRect(); \
         const s = Math.min((b.width - 24) / 768, (b.height - 24) / 576); \
         const at = {{ clientX: b.left + (b.width - 768 * s) / 2 + ({u} + 0.5) * s, \
         clientY: b.top + (b.height - 576 * s) / 2 + ({v} + 0.5) * s, bubbles: true }}; \
         c.dispatchEvent(new PointerEvent('pointermove', at)); c.dispatchEvent(new MouseEvent('click', at)); }}"
    )
}

fn press(id: &str) -> String {
    format!("document.getElementById('{id}').click()")
}

/// Waits until the note on the page says this.
fn told(browser: &mut Browser, text: &str) {
    browser.until(&format!("document.body.dataset.note.includes({text:?})"));
}

#[test]
fn live_colours_are_learned_on_the_page_saved_and_taken_over() {
    let folder = tempfile::tempdir().unwrap();
    let (pictures, out) = (folder.path().join("pictures"), folder.path().join("colours.yaml"));
    frames(&pictures);
    // Limits that no disc keeps.
    let strict = "/**/overhead_localizer:\n  ros__parameters:\n    colour: {yellow: 1.9, blue: 1.9, minimum: 200.0}\n";
    std::fs::write(&out, strict).unwrap();
    let domain = (102 + std::process::id() % 20).to_string();
    let memory = OwnMemory(format!("colours{}_", std::process::id()));
    let state = folder.path().join("state");
    let variables =
        [("ROS_DOMAIN_ID", &*domain), ("TRENCH_SHM_PREFIX", &*memory.0), ("TRENCH_STATE_DIR", state.to_str().unwrap())];
    let (lens, mount) = (config("overhead.yaml").display().to_string(), config("overhead_mount.yaml"));
    let mount = mount.display().to_string();
    let arguments = ["--lens", &lens, "--mount", &mount, "--out", out.to_str().unwrap()];
    let page = Viewer::serve(&["calibrate", "live"], &arguments, &variables);
    let mut browser = Browser::open(&page.page(), (1500, 860));
    let own = getpriority_process(None).unwrap();
    assert_eq!(page.niceness(), own.max(4), "whoever drives robots goes first");
    told(&mut browser, "waiting for /overhead/image_raw");

    let camera_parameters = [
        "source:=folder".to_owned(),
        format!("path:={}", pictures.display()),
        "rate:=15.0".to_owned(),
        "repeat:=true".to_owned(),
    ];
    let _camera = start("overhead_camera", &camera_parameters, &variables);
    told(&mut browser, "click into the middle of a yellow disc");
    assert_eq!(browser.ask("document.body.dataset.yellow + document.body.dataset.blue"), "00");

    // A click on the floor, then taken back; a click on each colour.
    let disc = |index: usize| {
        let places = Pad::NOMINAL.discs(poses()[index]);
        places.map(|disc| camera().project(Point3::new(disc.x, disc.y, Pad::NOMINAL.height)).unwrap())
    };
    browser.ask(&press("hold"));
    browser.until("document.body.dataset.held === 'true'");
    let [yellow, blue] = disc(0);
    browser.ask(&click(300.0, 300.0));
    told(&mut browser, "now click into the middle of a blue disc");
    browser.ask("document.querySelector('[data-which=blue]').click()");
    browser.ask(&click(blue.u, blue.v));
    told(&mut browser, "yellow cannot be told from the rest");
    browser.ask(&press("undo"));
    browser.ask(&press("undo"));
    told(&mut browser, "nothing is learned");
    browser.ask(&click(blue.u, blue.v));
    told(&mut browser, "now click into the middle of a yellow disc");
    browser.ask("document.querySelector('[data-which=yellow]').click()");
    browser.ask(&click(yellow.u, yellow.v));
    told(&mut browser, "learned: 4 yellow and 4 blue discs are found");
    assert_eq!(browser.ask("document.body.dataset.lessons"), "2");
    browser.ask("document.getElementById('picture').dispatchEvent(new PointerEvent('pointerleave'))");

    // What is covered is drawn over it; without the overlay it is not.
    let covered = |picture: &RgbImage, least: usize| {
        let is_cover = |pixel: &&image::Rgb<u8>| {
            let [red, green, blue] = pixel.0.map(i32::from);
            // Magenta over yellow.
            red > 220 && green < 110 && (90..160).contains(&blue)
        };
        let count = picture.pixels().filter(is_cover).count();
        assert!(count >= least, "{count} pixels are covered");
        count
    };
    let with = covered(&browser.picture("calibrate-live"), 1500);
    browser.ask(&press("show-cover"));
    let without = covered(&browser.picture("calibrate-live-bare"), 0);
    assert!(without < with / 3, "{without} pixels without the overlay, {with} with it");
    browser.ask(&press("show-cover"));

    // It goes on, and learns from what it finds.
    browser.ask(&press("hold"));
    browser.until("document.body.dataset.held === 'false'");
    browser.ask(&press("gather"));
    browser.until("Number(document.body.dataset.lessons) >= 22");
    told(&mut browser, "learned: 4 yellow and 4 blue discs are found");
    // A limit by hand: nothing is that yellow.
    browser.ask(
        "{ const s = document.getElementById('yellow'); s.value = 1.5; s.dispatchEvent(new Event('input')); \
         s.dispatchEvent(new Event('change')); }",
    );
    browser.until("document.body.dataset.yellow === '0' && document.body.dataset.blue === '4'");
    browser.ask(&press("undo"));
    told(&mut browser, "learned: 4 yellow and 4 blue discs are found");

    browser.ask(&press("save"));
    told(&mut browser, "wrote ");
    let saved = std::fs::read_to_string(&out).unwrap();
    assert!(saved.contains("camera: \"overhead\"") && saved != strict, "{saved}");
    browser.ask(&press("apply"));
    told(&mut browser, "does not answer");
    let localizer_parameters =
        ["robots:=[robot1]".to_owned(), format!("camera_info_file:={lens}"), format!("mount_file:={mount}")];
    let _localizer = start("overhead_localizer", &localizer_parameters, &variables);
    browser.until(
        "document.body.dataset.note.includes('in force at /overhead_localizer') || \
         (document.body.dataset.note.includes('does not answer') && document.getElementById('apply').click())",
    );
    browser.ask("document.documentElement.dataset.theme === 'dark' && document.getElementById('theme').click()");
    browser.picture("calibrate-live-light");
    assert_eq!(browser.complaints, Vec::<String>::new());
}

#[test]
fn live_what_cannot_be_served_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = |name: &str, content: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        path.display().to_string()
    };
    let (lens, mount) = (config("overhead.yaml").display().to_string(), config("overhead_mount.yaml"));
    let mount = mount.display().to_string();
    let four = config("overhead_four_mount.yaml").display().to_string();
    let broken = text("broken.yaml", "/**/overhead_localizer:\n  ros__parameters: {colour.yellow: red}\n");
    let low = text("low.yaml", "mount:\n  position: [1.0, 1.0, 0.05]\n  orientation: [0.0, 0.0, 0.0]\n");
    let check = |arguments: &[&str], expected: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trench"));
        command.args(["calibrate", "live", "--port", "0"]).args(arguments).current_dir(folder.path());
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && said.contains(expected), "{arguments:?}: {said}");
    };
    check(&[], "mount.yaml: No such file");
    check(&["--mount", &mount], "lens.yaml");
    check(&["--lens", &lens, "--mount", &four], "name one with --camera");
    check(&["--lens", &lens, "--mount", &mount, "--camera", "west"], "name one with --camera");
    check(&["--lens", &lens, "--mount", &mount, "--disc", "65"], "--disc 65: a diameter between");
    check(&["--lens", &lens, "--mount", &low], "the camera sees no pad below it");
    check(&["--lens", &lens, "--mount", &mount, "--out", &broken], "colour.yellow");
}
