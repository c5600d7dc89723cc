//! Pictures of ROS's ordinary camera drivers, and ours for its viewers.

use crate::support::{Island, Running};
use serde_json::Value;

/// A picture of grey noise (a linear congruence).
fn noise(width: u32, height: u32) -> image::RgbImage {
    let mut state = 1_u32;
    image::RgbImage::from_fn(width, height, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        image::Rgb([120 + (state >> 29) as u8; 3])
    })
}

/// 768 x 576 pixels of rgb8, 30 times a second, from rclpy with Fast DDS: 1.3 MB a frame over the loopback's UDP; and as JPEG.
#[test]
fn interop_an_ordinary_camera_driver_loses_one_frame_of_a_hundred_at_most() {
    const FRAMES: u64 = 300;
    let island = Island::new(1);
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let camera = |name: &str| root.join("config/cameras").join(name).display().to_string();
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("overhead_localizer");
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("picture.jpeg");
    noise(768, 576).save(&picture).unwrap();
    let jpeg = format!("--topic /overhead/image_raw/compressed --jpeg {}", picture.display());
    // Best effort as cameras' profile of ROS has it, and reliable as image_transport's default is.
    for (qos, input, what) in [
        ("best_effort,volatile,5", "image", ""),
        ("reliable,volatile,10", "image", ""),
        ("best_effort,volatile,5", "compressed", jpeg.as_str()),
    ] {
        let mut localizer = island.command(&program);
        localizer
            .args(["--ros-args", "-p", "robots:=[robot1]", "-p", &format!("input:={input}")])
            .args(["-p", &format!("camera_info_file:={}", camera("overhead.yaml"))])
            .args(["-p", &format!("mount_file:={}", camera("overhead_mount.yaml"))]);
        let localizer = Running::start(&mut localizer);
        let diagnostics = island.follow("/diagnostics diagnostic_msgs/msg/DiagnosticArray --qos reliable,volatile,100");
        let sent = island.ask("peer_camera.py", &format!("--qos {qos} --frames {FRAMES} {what}"));
        let mut taken = 0;
        // The last ones are told of when no more come.
        diagnostics.until("no frames come any more", |message| {
            let camera = message["status"]
                .as_array()
                .unwrap()
                .iter()
                .find(|part| part["name"] == "/overhead_localizer: camera" && part["message"] == "no frames");
            let value = |part: &Value| {
                let values = part["values"].as_array().unwrap();
                let frames = values.iter().find(|value| value["key"] == "frames")?;
                frames["value"].as_str()?.parse::<u64>().ok()
            };
            taken = camera.and_then(value).unwrap_or(0);
            taken > 0
        });
        drop(localizer);
        println!("{qos} {input}: {taken} of {FRAMES} frames were taken ({sent})");
        assert!(100 * (FRAMES - taken) <= FRAMES, "{qos} {input}: {taken} of {FRAMES} frames were taken ({sent})");
    }
}

/// Frames that rclpy asks for go to it in pieces of our own making (docs/decisions/0012): Fast DDS puts them together again.
#[test]
fn interop_a_viewer_gets_the_camera_s_pictures_whole() {
    const COUNT: usize = 40;
    let island = Island::new(2);
    let folder = tempfile::tempdir().unwrap();
    let pictures = [noise(768, 576), image::RgbImage::from_pixel(768, 576, image::Rgb([9, 90, 200]))];
    for (index, picture) in pictures.iter().enumerate() {
        picture.save(folder.path().join(format!("frame{index}.png"))).unwrap();
    }
    let lens = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("config/cameras/overhead.yaml");
    let mut camera =
        island.command(std::path::Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("overhead_camera"));
    camera
        .args(["--ros-args", "-p", "source:=folder", "-p", "repeat:=true", "-p", "rate:=20.0"])
        .args(["-p", &format!("path:={}", folder.path().display())])
        .args(["-p", &format!("camera_info_file:={}", lens.display())])
        .args(["-p", "publish_over_network:=[\"/overhead/image_raw\"]"]);
    let camera = Running::start(&mut camera);
    let seen = island.ask("peer_viewer.py", &format!("/overhead/image_raw --count {COUNT}"));
    drop(camera);
    let expected = pictures.map(|picture| u64::from(crc32fast::hash(picture.as_raw())));
    let mut counts = [0; 2];
    for picture in seen["pictures"].as_array().unwrap() {
        assert_eq!((&picture["encoding"], &picture["sides"]), (&"rgb8".into(), &serde_json::json!([768, 576, 2304])));
        let which = expected.iter().position(|crc| picture["crc32"] == *crc);
        counts[which.unwrap_or_else(|| panic!("a picture that nobody sent: {picture}"))] += 1;
    }
    println!("{counts:?} pictures, {} a second of 20", seen["rate"]);
    assert!(counts.iter().all(|count| 3 * count > COUNT), "{counts:?}: as they take turns");
}
