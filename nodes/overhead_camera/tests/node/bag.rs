//! Bags: spacing, ages, encodings, compressed images.

use crate::common::{build, lines, run, stamp};
use image::{ImageFormat, Rgb, RgbImage};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use trench_bag::{BagWriter, Stamp, WriteOptions};
use trench_core::{Qos, RosTime};
use trench_msgs::sensor_msgs::{CompressedImage, Image};
use trench_msgs::std_msgs::{Float64, Header};
use trench_msgs::{Encode, Message};

/// When the recording began, ns.
const BEGIN: u64 = 1_700_000_000_000_000_000;

/// Writes a bag with `messages`: their topic, log time (s after the beginning) and bytes.
fn record<M: Message>(folder: &Path, messages: &[(f64, M)]) -> PathBuf {
    let path = folder.join("bag");
    let options = WriteOptions { disk_reserve: 0, ..WriteOptions::default() };
    let mut writer = BagWriter::create(&path, options).unwrap();
    let other = writer.add_topic("/value", Float64::TYPE.into(), Qos::RELIABLE).unwrap();
    let images = writer.add_topic("/overhead/image_raw", M::TYPE.into(), Qos::SENSOR).unwrap();
    for (index, (time, message)) in messages.iter().enumerate() {
        let log_time = BEGIN + (time * 1e9) as u64;
        let stamp = Stamp { log_time, publish_time: log_time, sequence: index as u32 };
        writer.write(other, stamp, &Float64 { data: *time }.to_cdr()).unwrap();
        writer.write(images, stamp, &message.to_cdr()).unwrap();
    }
    writer.finish().unwrap();
    path
}

/// A header stamped `age` (s) before `time` (s after the beginning).
fn header(time: f64, age: f64) -> Header {
    Header { stamp: RosTime(BEGIN as i64).plus_seconds(time - age).into(), frame_id: "elsewhere".to_owned() }
}

fn image(time: f64, age: f64, encoding: &str, step: u32) -> (f64, Image) {
    let (width, height) = (32, 24);
    let data = vec![(100.0 * time) as u8; (step * height) as usize];
    let encoding = encoding.to_owned();
    (time, Image { header: header(time, age), height, width, encoding, is_bigendian: 0, step, data })
}

#[test]
fn images_come_at_the_recorded_spacing_as_old_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = [
        image(0.0, 0.035, "rgb8", 96),
        image(0.04, 0.035, "bgr8", 96),
        image(0.25, 0.03, "yuv422_yuy2", 64),
        // Stamps of another clock, later or much earlier.
        image(0.30, -5.0, "rgb8", 96),
        image(0.40, 500.0, "rgb8", 96),
    ];
    let bag = record(folder.path(), &recorded);
    let run = run(build(&lines("bag", &bag, "")).unwrap().as_mut(), 10.0);
    assert_eq!(run.images.len(), recorded.len());
    let ages = [0.035, 0.035, 0.03, 0.0, 0.0];
    for (((time, image), (log_time, original)), age) in run.images.iter().zip(&recorded).zip(ages) {
        assert!((time - 1.0 - log_time).abs() < 1e-6, "{time} s");
        assert!((time - stamp(image) - age).abs() < 1e-6, "{time} s: exposed at {} s", stamp(image));
        assert_eq!((&image.encoding, image.step, &image.data), (&original.encoding, original.step, &original.data));
        assert_eq!(image.header.frame_id, "overhead_camera");
    }
    assert_eq!(run.exit, Some(0));
}

#[test]
fn a_bag_is_repeated_without_a_gap() {
    let folder = tempfile::tempdir().unwrap();
    let bag = record(folder.path(), &[0.0, 0.04, 0.08].map(|time| image(time, 0.03, "rgb8", 96)));
    let run = run(build(&lines("bag", &bag, "repeat: true")).unwrap().as_mut(), 2.0);
    assert_eq!(run.images.len(), 26);
    for pair in run.images.windows(2) {
        assert!((pair[1].0 - pair[0].0 - 0.04).abs() < 1e-6, "{} s, {} s", pair[0].0, pair[1].0);
    }
}

#[test]
fn compressed_images_are_decoded() {
    let folder = tempfile::tempdir().unwrap();
    let packed = |time: f64, colour, format| {
        let mut data = Cursor::new(Vec::new());
        RgbImage::from_pixel(32, 24, Rgb(colour)).write_to(&mut data, format).unwrap();
        (time, CompressedImage { header: header(time, 0.02), format: "whatever".to_owned(), data: data.into_inner() })
    };
    let mut broken = packed(0.08, [0; 3], ImageFormat::Png);
    broken.1.data.truncate(50);
    let messages = [packed(0.0, [200, 180, 40], ImageFormat::Png), packed(0.04, [90; 3], ImageFormat::Jpeg), broken];
    let bag = record(folder.path(), &messages);
    let run = run(build(&lines("bag", &bag, "")).unwrap().as_mut(), 10.0);
    let pixels: Vec<&[u8]> = run.images.iter().map(|(_, image)| &image.data[..3]).collect();
    assert_eq!(pixels, [[200, 180, 40], [90; 3]]);
    assert_eq!(run.images[1].1.encoding, "rgb8");
    assert!(run.log()[0].starts_with("a message of the bag: "), "{:?}", run.log());
}

#[test]
fn bad_bags_and_images() {
    let folder = tempfile::tempdir().unwrap();
    let bad = image(0.04, 0.0, "mono8", 96);
    let short = (0.08, Image { data: vec![0; 10], ..image(0.08, 0.0, "rgb8", 96).1 });
    let bag = record(folder.path(), &[image(0.0, 0.0, "rgb8", 96), bad, short, image(0.12, 0.0, "rgb8", 96)]);
    let run = run(build(&lines("bag", &bag, "")).unwrap().as_mut(), 10.0);
    assert_eq!(run.images.len(), 2);
    let log = run.log();
    assert!(log[0].contains("the encoding is \"mono8\", it must be rgb8, bgr8 or yuv422_yuy2"), "{log:?}");
    assert!(log[1].contains("a frame of 24 rows of 96 bytes for 32 pixels has 10 bytes"), "{log:?}");

    let check = |path: &Path, more: &str, expected: &str| {
        let error = build(&lines("bag", path, more)).err().unwrap();
        assert!(error.contains(expected), "{error}");
    };
    check(&bag, "topic: /camera", "has no images on /camera; it has images on: /overhead/image_raw");
    check(&bag, "topic: /value", "has no images on /value");
    check(Path::new("/no/such/bag"), "", "path = \"/no/such/bag\": ");
    let empty = tempfile::tempdir().unwrap();
    check(&record::<Image>(empty.path(), &[]), "", "has no ");
}
