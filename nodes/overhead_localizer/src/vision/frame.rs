//! A camera frame in place: bytes that belong to the transport, checked once.

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
    #[error("the encoding is {0:?}, it must be rgb8 or bgr8")]
    Encoding(String),
    /// Another size than the camera's lens file says.
    #[error("the frame has {actual:?} pixels, the lens file says {expected:?}")]
    Size {
        /// Width and height by the lens file.
        expected: [usize; 2],
        /// Width and height of the frame.
        actual: [usize; 2],
    },
    /// A row is shorter than its pixels.
    #[error("the step is {step} bytes, a row of {width} pixels needs {}", 3 * width)]
    Step {
        /// Bytes a row by the message.
        step: usize,
        /// Pixels a row.
        width: usize,
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

impl<'a> Frame<'a> {
    /// Checks what an image message says of itself against the camera's `[width, height]`.
    ///
    /// # Errors
    /// When the encoding, size, step or number of bytes is wrong.
    pub fn new(
        camera_size: [usize; 2],
        encoding: &str,
        [width, height]: [usize; 2],
        step: usize,
        bytes: &'a [u8],
    ) -> Result<Self, FrameError> {
        let order = match encoding {
            "rgb8" => ChannelOrder::Rgb,
            "bgr8" => ChannelOrder::Bgr,
            other => return Err(FrameError::Encoding(other.to_owned())),
        };
        if [width, height] != camera_size {
            return Err(FrameError::Size { expected: camera_size, actual: [width, height] });
        }
        if step < width.saturating_mul(3) {
            return Err(FrameError::Step { step, width });
        }
        // The last row may lack its padding.
        let expected = step.saturating_mul(height.saturating_sub(1)).saturating_add(width.saturating_mul(3));
        if bytes.len() < expected {
            return Err(FrameError::Length { expected, actual: bytes.len() });
        }
        Ok(Self { width, height, step, order, bytes })
    }

    /// The pixels of row `v`, three bytes each; empty below the image.
    pub(super) fn row(&self, v: usize) -> &'a [u8] {
        self.bytes.get(v * self.step..v * self.step + 3 * self.width).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_say_what_is_wrong() {
        let check = |encoding: &str, size: [usize; 2], step: usize, bytes: usize, expected: Option<&str>| {
            let bytes = vec![0; bytes];
            let result = Frame::new([8, 4], encoding, size, step, &bytes);
            assert_eq!(result.err().map(|error| error.to_string()).as_deref(), expected);
        };
        check("rgb8", [8, 4], 24, 96, None);
        check("bgr8", [8, 4], 32, 120, None);
        check("mono8", [8, 4], 8, 32, Some("the encoding is \"mono8\", it must be rgb8 or bgr8"));
        check("rgb8", [8, 5], 24, 120, Some("the frame has [8, 5] pixels, the lens file says [8, 4]"));
        check("rgb8", [8, 4], 23, 96, Some("the step is 23 bytes, a row of 8 pixels needs 24"));
        check("rgb8", [8, 4], 24, 95, Some("the frame has 95 bytes, 96 are needed"));
        check("rgb8", [8, 4], usize::MAX, 95, Some("the frame has 95 bytes, 18446744073709551615 are needed"));
        check("rgb8", [8, 4], 24, 0, Some("the frame has 0 bytes, 96 are needed"));
    }
}
