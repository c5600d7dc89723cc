//! Image folders: order, rate, stamps, bad files.

use crate::common::{build, lines, run, stamp};
use image::{ImageFormat, Rgb, RgbImage};
use std::fs;
use std::path::Path;
use trench_msgs::sensor_msgs::CameraInfo;

/// An image of one colour.
fn save(folder: &Path, name: &str, [width, height]: [u32; 2], colour: [u8; 3]) {
    RgbImage::from_pixel(width, height, Rgb(colour)).save(folder.join(name)).unwrap();
}

#[test]
fn images_come_in_the_order_of_their_numbers_at_the_rate_given() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), "frame10.png", [32, 24], [10, 0, 0]);
    save(folder.path(), "frame9.JPG", [32, 24], [90, 90, 90]);
    save(folder.path(), "frame1.png", [32, 24], [1, 0, 0]);
    fs::write(folder.path().join("notes.txt"), "no image").unwrap();
    let mut core = build(&lines("folder", folder.path(), "rate: 20.0\nexposure_delay: 0.01")).unwrap();
    let run = run(core.as_mut(), 10.0);
    let first: Vec<u8> = run.images.iter().map(|(_, image)| image.data[0]).collect();
    assert_eq!(first, [1, 90, 10]);
    for (index, (time, image)) in run.images.iter().enumerate() {
        let due = 1.0 + 0.05 * index as f64;
        assert!((time - due).abs() < 1e-6, "published at {time} s");
        assert!((stamp(image) - due + 0.01).abs() < 1e-6, "exposed at {} s", stamp(image));
        assert_eq!((image.width, image.height, image.step, image.data.len()), (32, 24, 96, 32 * 24 * 3));
        assert_eq!((image.encoding.as_str(), image.header.frame_id.as_str()), ("rgb8", "overhead_camera"));
    }
    assert_eq!(run.exit, Some(0));
    assert_eq!(run.log(), ["3 frames sent, 0 dropped: the end"]);
    assert_eq!(core.interface().publications.len(), 2, "no lens file, no camera_info");
}

#[test]
fn a_folder_is_repeated_until_the_node_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), "a.png", [32, 24], [1, 0, 0]);
    save(folder.path(), "b.png", [32, 24], [2, 0, 0]);
    let mut core = build(&lines("folder", folder.path(), "rate: 10.0\nrepeat: true\nstart_delay: 0.0")).unwrap();
    let run = run(core.as_mut(), 2.05);
    let first: Vec<u8> = run.images.iter().map(|(_, image)| image.data[0]).collect();
    assert_eq!(first, [1, 2].repeat(11)[..21]);
    assert_eq!(run.exit, None);
    let rate = run.diagnostics().status[0].values.iter().find(|value| value.key == "frames per second").cloned();
    assert_eq!(rate.unwrap().value, "10.0");
}

#[test]
fn the_lens_file_goes_out_with_each_frame_and_frames_must_have_its_size() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), "1.png", [768, 576], [1, 0, 0]);
    save(folder.path(), "2.png", [640, 480], [2, 0, 0]);
    save(folder.path(), "3.png", [768, 576], [3, 0, 0]);
    let mut core = build(&lines("folder", folder.path(), "camera_info_file: overhead.yaml")).unwrap();
    let run = run(core.as_mut(), 10.0);
    assert_eq!(run.images.len(), 2);
    let infos: Vec<CameraInfo> = run.outbox.published(2);
    for (info, (_, image)) in infos.iter().zip(&run.images) {
        assert_eq!(info.header, image.header);
        assert_eq!((info.width, info.height, info.k[0]), (768, 576, 929.080_210_591_514_4));
    }
    assert_eq!(run.log()[0], "a frame has [640, 480] pixels, the lens file says [768, 576]");
}

#[test]
fn unusable_images_are_told_and_left_out() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), "1.png", [32, 24], [1, 0, 0]);
    fs::write(folder.path().join("2.png"), [0; 100]).unwrap();
    let mut cut = fs::read(folder.path().join("1.png")).unwrap();
    cut.truncate(cut.len() / 2);
    fs::write(folder.path().join("3.png"), cut).unwrap();
    image::GrayImage::new(32, 24).save_with_format(folder.path().join("4.png"), ImageFormat::Png).unwrap();
    save(folder.path(), "5.png", [64, 48], [5, 0, 0]);
    fs::create_dir(folder.path().join("6.png")).unwrap();
    save(folder.path(), "7.png", [32, 24], [7, 0, 0]);
    let mut core = build(&lines("folder", folder.path(), "")).unwrap();
    let run = run(core.as_mut(), 10.0);
    let first: Vec<u8> = run.images.iter().map(|(_, image)| image.data[0]).collect();
    assert_eq!(first, [1, 7]);
    let log = run.log();
    let check = |line: usize, expected: &str| assert!(log[line].contains(expected), "{log:?}");
    check(0, "2.png: ");
    check(1, "3.png: ");
    check(2, "4.png: the image is grey");
    check(3, "a frame has 9216 bytes, the first had 2304");
    check(4, "6.png: ");
    check(5, "2 frames sent, 5 dropped");
}

#[test]
fn what_cannot_be_a_camera_stops_the_node_before_it_works() {
    let folder = tempfile::tempdir().unwrap();
    let check = |source: &str, path: &str, more: &str, expected: &str| {
        let error = build(&lines(source, Path::new(path), more)).err().unwrap();
        assert!(error.contains(expected), "{error}");
    };
    let empty = folder.path().to_str().unwrap();
    check("folder", empty, "", "holds no .png, .jpg or .jpeg files");
    check("folder", "/no/such/folder", "", "cannot be read");
    check("folder", "\"\"", "", "path = ");
    check("film", empty, "", "source = \"film\": is not a source");
    check("folder", empty, "rate: 0.0", "rate = 0");
    check("folder", empty, "camera_info_file: none.yaml", "camera_info_file = none.yaml");
    check("v4l2", "/dev/video9", "format: h264", "format = \"h264\": is not a format");
    fs::write(folder.path().join("1.png"), "text").unwrap();
    check("folder", empty, "", "1.png");
}
