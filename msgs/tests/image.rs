//! Images are read and written in place.

use trench_msgs::builtin_interfaces::Time;
use trench_msgs::sensor_msgs::{Image, ImageView};
use trench_msgs::std_msgs::{Header, HeaderView};
use trench_msgs::{Encode, Message};

const WIDTH: u32 = 768;
const HEIGHT: u32 = 576;

fn frame(encoding: &str) -> ImageView<'_> {
    ImageView {
        header: HeaderView { stamp: Time { sec: 12, nanosec: 34 }, frame_id: "overhead_camera" },
        height: HEIGHT,
        width: WIDTH,
        encoding,
        is_bigendian: 0,
        step: 3 * WIDTH,
        data: &[],
    }
}

fn pixels() -> Vec<u8> {
    (0..3 * WIDTH * HEIGHT).map(|index| (index % 251) as u8).collect()
}

/// The owned image of a frame and its pixels.
fn owned(frame: &ImageView, data: Vec<u8>) -> Image {
    Image {
        header: Header { stamp: frame.header.stamp, frame_id: frame.header.frame_id.to_owned() },
        height: frame.height,
        width: frame.width,
        encoding: frame.encoding.to_owned(),
        is_bigendian: frame.is_bigendian,
        step: frame.step,
        data,
    }
}

#[test]
fn pixels_and_strings_are_read_where_they_are() {
    let cdr = owned(&frame("rgb8"), pixels()).to_cdr();
    let view = ImageView::decode(&cdr).expect("a valid image");
    assert_eq!(view, ImageView { data: &pixels(), ..frame("rgb8") });
    let memory = cdr.as_ptr_range();
    // The pixels are the last field: they end where the message ends.
    assert_eq!(view.data.as_ptr_range().end, memory.end);
    assert!(memory.contains(&view.data.as_ptr()));
    assert!(memory.contains(&view.encoding.as_ptr()));
    assert!(memory.contains(&view.header.frame_id.as_ptr()));
}

#[test]
fn a_view_is_encoded_as_the_message_it_shows() {
    let pixels = pixels();
    let view = ImageView { data: &pixels, ..frame("bgr8") };
    assert_eq!(view.type_info(), Image::TYPE);
    assert_eq!(view.to_cdr(), owned(&view, pixels.clone()).to_cdr());
}

#[test]
fn pixels_are_rendered_into_memory_that_already_holds_the_rest() {
    // Encodings of every length move the pixels to every alignment.
    for encoding in ["", "8", "16", "rgb", "rgb8", "bayer_rggb8"] {
        let frame = frame(encoding);
        let data = pixels();
        let mut loan = vec![0xaa; frame.encoded_len_with(data.len()) + 7];
        let range = frame.encode_around(data.len(), &mut loan).expect("it fits");
        assert_eq!(range.len(), data.len());
        assert_eq!(range.end, frame.encoded_len_with(data.len()));
        assert!(loan[range.start..].iter().all(|byte| *byte == 0xaa), "only what is in front of the pixels is written");
        loan[range.clone()].copy_from_slice(&data);
        assert_eq!(loan[..range.end], owned(&frame, data).to_cdr());
    }
}

#[test]
fn a_loan_that_is_too_short_is_left_alone() {
    let frame = frame("rgb8");
    let length = frame.encoded_len_with(1000);
    let mut loan = vec![0xaa; length - 1];
    assert_eq!(frame.encode_around(1000, &mut loan), None);
    assert_eq!(frame.encode_around(usize::MAX, &mut loan), None);
    assert!(loan.iter().all(|byte| *byte == 0xaa));
}
