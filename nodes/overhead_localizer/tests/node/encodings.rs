//! Frames that are not rgb8 or bgr8.

use super::{START, build, camera, image, send, timing};
use image::{DynamicImage, ImageFormat, RgbImage};
use std::io::Cursor;
use trench_core::{Action, NodeCore};
use trench_msgs::Encode;
use trench_msgs::msg::{RobotState, TeamState};
use trench_msgs::sensor_msgs::{CompressedImage, Image};
use trench_optics::Pad;
use trench_sim::camera::{Appearance, Renderer};

/// rgb8 as a USB camera would have sent it: the colour of two neighbours averaged.
fn yuyv(frame: &Image) -> Image {
    let mut data = Vec::new();
    for pair in frame.data.chunks_exact(6) {
        let of = |pixel: &[u8]| {
            let [red, green, blue] = [0, 1, 2].map(|channel| f64::from(pixel[channel]));
            let luma = 0.299 * red + 0.587 * green + 0.114 * blue;
            [luma * 219.0 / 255.0 + 16.0, (blue - luma) * 0.4958 + 128.0, (red - luma) * 0.6266 + 128.0]
        };
        let [one, two] = [of(&pair[..3]), of(&pair[3..])];
        let bytes = [one[0], 0.5 * (one[1] + two[1]), two[0], 0.5 * (one[2] + two[2])];
        data.extend(bytes.map(|value| value.round().clamp(0.0, 255.0) as u8));
    }
    Image { encoding: "yuv422_yuy2".to_owned(), step: 2 * frame.width, data, ..frame.clone() }
}

fn found(core: &mut dyn NodeCore, sequence: u64, cdr: &[u8], millimetres: f64) {
    let state: TeamState = send(core, sequence, cdr).last(0).unwrap();
    for (robot, pose) in state.robots.iter().zip(START) {
        assert_eq!(robot.status, RobotState::STATUS_TRACKED);
        let error = 1000.0 * (robot.x - pose.x).hypot(robot.y - pose.y);
        assert!(error < millimetres, "{}: off by {error} mm", robot.name);
    }
}

#[test]
fn yuv422_is_as_exact_as_half_the_colours_allow() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let mut core = build("").unwrap();
    for sequence in 1..4 {
        found(core.as_mut(), sequence, &yuyv(&image(&renderer, &START, timing(sequence).0)).to_cdr(), 0.3);
    }
}

#[test]
fn png_and_jpeg_serve_as_well_grey_and_broken_ones_are_refused() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let mut core = build("    input: compressed\n").unwrap();
    assert_eq!(core.interface().subscriptions[0].topic, "/overhead/image_raw/compressed");
    let raw = |sequence| image(&renderer, &START, timing(sequence).0);
    let picture = |frame: Image| DynamicImage::from(RgbImage::from_raw(768, 576, frame.data).unwrap());
    let packed = |sequence, picture: &DynamicImage, format| {
        let mut data = Cursor::new(Vec::new());
        picture.write_to(&mut data, format).unwrap();
        CompressedImage { header: raw(sequence).header, format: "rgb8; whatever".to_owned(), data: data.into_inner() }
    };
    found(core.as_mut(), 1, &packed(1, &picture(raw(1)), ImageFormat::Png).to_cdr(), 0.3);
    found(core.as_mut(), 2, &packed(2, &picture(raw(2)), ImageFormat::Jpeg).to_cdr(), 0.5);

    let mut check = |message: CompressedImage, expected: &str| {
        let outbox = send(core.as_mut(), 3, &message.to_cdr());
        let logged = |action: &Action| matches!(action, Action::Log { text, .. } if text.contains(expected));
        assert!(outbox.actions.iter().any(logged), "{expected}: {:?}", outbox.actions);
        assert_eq!(outbox.published::<TeamState>(0), []);
    };
    let good = packed(3, &picture(raw(3)), ImageFormat::Png);
    let cut = good.data[..1000].to_vec();
    check(CompressedImage { data: cut, ..good.clone() }, "frame dropped: ");
    check(CompressedImage { data: b"not an image".to_vec(), ..good }, "frame dropped: ");
    check(packed(3, &picture(raw(3)).grayscale(), ImageFormat::Png), "the image is grey");
    check(packed(3, &DynamicImage::new_rgb8(64, 48), ImageFormat::Png), "the frame has [64, 48] pixels");
}
