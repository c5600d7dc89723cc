//! A camera frame, checked once: in place where its bytes are rgb8 or bgr8, otherwise converted.

use super::yuyv;
use std::ops::Range;
use trench_optics::Pixel;

/// The order of a pixel's three bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChannelOrder {
    /// sensor_msgs/Image `rgb8`
    Rgb,
    /// sensor_msgs/Image `bgr8`
    Bgr,
}

/// A frame of the expected size.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) step: usize,
    pub(super) order: ChannelOrder,
    pub(super) bytes: &'a [u8],
}

/// Why bytes are not a frame of this camera.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// Not one of the encodings that can be read.
    #[error("the encoding is {0:?}, it must be rgb8, bgr8 or yuv422_yuy2: {remedy}", remedy = remedy(.0))]
    Encoding(String),
    /// Two pixels share their colour, and one has no partner.
    #[error("the frame has rows of {0} pixels, yuv422_yuy2 needs an even number")]
    Odd(usize),
    /// Another size than the camera's lens file says.
    #[error("the frame has {actual:?} pixels, the lens file says {expected:?}")]
    Size {
        /// Width and height by the lens file.
        expected: [usize; 2],
        /// Width and height of the frame.
        actual: [usize; 2],
    },
    /// A row is shorter than its pixels.
    #[error("the step is {step} bytes, a row of {width} pixels needs {needed}")]
    Step {
        /// Bytes a row by the message.
        step: usize,
        /// Pixels a row.
        width: usize,
        /// Bytes that they take.
        needed: usize,
    },
    /// Fewer bytes than rows times step.
    #[error("the frame has {actual} bytes, {expected} are needed")]
    Length {
        /// Rows times step.
        expected: usize,
        /// What is there.
        actual: usize,
    },
}

/// What to do about frames of this encoding.
fn remedy(encoding: &str) -> &'static str {
    if encoding.starts_with("mono") {
        "pads are told by their colours; set the camera to one of these (grey pictures serve `trench calibrate lens`)"
    } else if encoding.starts_with("bayer") {
        "let image_proc make colours of it, or set the camera to one of these"
    } else {
        "set the camera to one of these"
    }
}

impl<'a> Frame<'a> {
    /// Checks what an image message says of itself against the camera's `[width, height]`. A frame that the detector cannot
    /// read in place is converted into `room`.
    ///
    /// # Errors
    /// When the encoding, size, step or number of bytes is wrong.
    pub fn new(
        camera_size: [usize; 2],
        encoding: &str,
        [width, height]: [usize; 2],
        step: usize,
        bytes: &'a [u8],
        room: &'a mut Vec<u8>,
    ) -> Result<Self, FrameError> {
        let (order, pixel_bytes) = match encoding {
            "rgb8" => (Some(ChannelOrder::Rgb), 3),
            "bgr8" => (Some(ChannelOrder::Bgr), 3),
            "yuv422_yuy2" => (None, 2),
            other => return Err(FrameError::Encoding(other.to_owned())),
        };
        if [width, height] != camera_size {
            return Err(FrameError::Size { expected: camera_size, actual: [width, height] });
        }
        let needed = width.saturating_mul(pixel_bytes);
        if step < needed {
            return Err(FrameError::Step { step, width, needed });
        }
        // The last row may lack its padding.
        let expected = step.saturating_mul(height.saturating_sub(1)).saturating_add(needed);
        if bytes.len() < expected {
            return Err(FrameError::Length { expected, actual: bytes.len() });
        }
        match order {
            Some(order) => Ok(Self { width, height, step, order, bytes }),
            None if !width.is_multiple_of(2) => Err(FrameError::Odd(width)),
            None => {
                yuyv::to_rgb(bytes, step.max(1), width, room);
                Ok(Self { width, height, step: 3 * width, order: ChannelOrder::Rgb, bytes: room })
            }
        }
    }

    /// Puts its pixels into `rgb`: red, green, blue, without gaps.
    pub fn to_rgb(&self, rgb: &mut Vec<u8>) {
        rgb.clear();
        for v in 0..self.height {
            rgb.extend_from_slice(self.row(v));
        }
        if self.order == ChannelOrder::Bgr {
            rgb.chunks_exact_mut(3).for_each(<[u8]>::reverse);
        }
    }

    /// Whether a disc at `centre` with these half axes (pixels) is in the picture as a whole.
    pub(super) fn holds(&self, centre: Pixel, half: [f64; 2]) -> bool {
        let inside = |place: f64, half: f64, size: usize| place > half + 1.0 && place + half + 2.0 < size as f64;
        inside(centre.u, half[0], self.width) && inside(centre.v, half[1], self.height)
    }

    /// Lets the pixels of a box come nearer to the processor, without waiting for them.
    pub(super) fn call_for(&self, columns: Range<usize>, rows: Range<usize>) {
        /// Bytes that memory gives at once.
        const LINE: usize = 64;
        for v in rows {
            let row = self.row(v);
            let pixels = row.get(3 * columns.start..(3 * columns.end + LINE).min(row.len())).unwrap_or_default();
            pixels.iter().step_by(LINE).for_each(prefetch);
        }
    }

    /// The pixels of row `v`, three bytes each; empty below the image.
    pub(super) fn row(&self, v: usize) -> &'a [u8] {
        self.bytes.get(v * self.step..v * self.step + 3 * self.width).unwrap_or_default()
    }
}

/// Into the second cache: the first is smaller than what is called for.
#[cfg(target_arch = "x86_64")]
fn prefetch(byte: &u8) {
    safe_arch::prefetch_t1(byte);
}

/// Elsewhere pixels come when they are read.
#[cfg(not(target_arch = "x86_64"))]
fn prefetch(_: &u8) {}

#[cfg(test)]
mod tests {
    use super::*;

    const MONO: &str = "the encoding is \"mono8\", it must be rgb8, bgr8 or yuv422_yuy2: pads are told by their colours; \
                        set the camera to one of these (grey pictures serve `trench calibrate lens`)";
    const BAYER: &str = "the encoding is \"bayer_rggb8\", it must be rgb8, bgr8 or yuv422_yuy2: \
                         let image_proc make colours of it, or set the camera to one of these";
    const OTHER: &str =
        "the encoding is \"32FC1\", it must be rgb8, bgr8 or yuv422_yuy2: set the camera to one of these";

    #[test]
    fn pixels_leave_as_red_green_blue() {
        let bytes = [1, 2, 3, 4, 5, 6, 99, 7, 8, 9, 10, 11, 12, 99];
        let check = |encoding: &str, expected: [u8; 12]| {
            let (mut room, mut rgb) = (Vec::new(), vec![7]);
            Frame::new([2, 2], encoding, [2, 2], 7, &bytes, &mut room).unwrap().to_rgb(&mut rgb);
            assert_eq!(rgb, expected, "{encoding}");
        };
        check("rgb8", [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
        check("bgr8", [3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10]);
    }

    #[test]
    fn errors_say_what_is_wrong() {
        let check = |encoding: &str, size: [usize; 2], step: usize, bytes: usize, expected: Option<&str>| {
            let bytes = vec![0; bytes];
            let mut room = Vec::new();
            let result = Frame::new([8, 4], encoding, size, step, &bytes, &mut room);
            assert_eq!(result.err().map(|error| error.to_string()).as_deref(), expected);
        };
        check("rgb8", [8, 4], 24, 96, None);
        check("bgr8", [8, 4], 32, 120, None);
        check("mono8", [8, 4], 8, 32, Some(MONO));
        check("bayer_rggb8", [8, 4], 8, 32, Some(BAYER));
        check("32FC1", [8, 4], 32, 128, Some(OTHER));
        check("yuv422_yuy2", [8, 4], 16, 64, None);
        check("yuv422_yuy2", [8, 4], 15, 64, Some("the step is 15 bytes, a row of 8 pixels needs 16"));
        check("yuv422_yuy2", [8, 4], 16, 63, Some("the frame has 63 bytes, 64 are needed"));
        check("rgb8", [8, 5], 24, 120, Some("the frame has [8, 5] pixels, the lens file says [8, 4]"));
        check("rgb8", [8, 4], 23, 96, Some("the step is 23 bytes, a row of 8 pixels needs 24"));
        check("rgb8", [8, 4], 24, 95, Some("the frame has 95 bytes, 96 are needed"));
        check("rgb8", [8, 4], usize::MAX, 95, Some("the frame has 95 bytes, 18446744073709551615 are needed"));
        check("rgb8", [8, 4], 24, 0, Some("the frame has 0 bytes, 96 are needed"));
    }
}
