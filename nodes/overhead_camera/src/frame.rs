//! A frame as its source has it, before it is a message.

use trench_core::RosTime;

/// How pixels are written down, by sensor_msgs/Image's names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Red, green, blue: three bytes a pixel.
    Rgb8,
    /// Blue, green, red: three bytes a pixel.
    Bgr8,
    /// Two pixels in four bytes: brightness, blue difference, brightness, red difference (YUYV).
    Yuv422Yuy2,
}

impl Encoding {
    /// The encoding that sensor_msgs/Image calls `name`, if frames may have it.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Rgb8, Self::Bgr8, Self::Yuv422Yuy2].into_iter().find(|encoding| encoding.name() == name)
    }

    /// sensor_msgs/Image's name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rgb8 => "rgb8",
            Self::Bgr8 => "bgr8",
            Self::Yuv422Yuy2 => "yuv422_yuy2",
        }
    }

    /// Bytes a pixel.
    #[must_use]
    pub fn pixel_bytes(self) -> usize {
        match self {
            Self::Rgb8 | Self::Bgr8 => 3,
            Self::Yuv422Yuy2 => 2,
        }
    }
}

/// One frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// The middle of its exposure.
    pub exposed: RosTime,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bytes from one row to the next.
    pub step: u32,
    /// How pixels are written down.
    pub encoding: Encoding,
    /// `height` rows of `step` bytes.
    pub pixels: &'a [u8],
}

/// Why a frame is none.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// Another size than the lens file says.
    #[error("a frame has {actual:?} pixels, the lens file says {expected:?}")]
    Size {
        /// Width and height by the lens file.
        expected: [u32; 2],
        /// Width and height of the frame.
        actual: [u32; 2],
    },
    /// The numbers contradict each other.
    #[error("a frame of {height} rows of {step} bytes for {width} pixels has {length} bytes")]
    Length {
        /// Rows.
        height: u32,
        /// Bytes a row.
        step: u32,
        /// Pixels a row.
        width: u32,
        /// Bytes there are.
        length: usize,
    },
    /// More than the room reserved for one.
    #[error("a frame has {length} bytes, the first had {most}")]
    Large {
        /// Bytes of this one.
        length: usize,
        /// Bytes reserved.
        most: usize,
    },
}

impl Frame<'_> {
    /// Checks that the frame is as large as it says, no larger than `most` bytes, and of the `expected` size if one is.
    ///
    /// # Errors
    /// When it is not.
    pub fn check(&self, expected: Option<[u32; 2]>, most: usize) -> Result<(), FrameError> {
        let Self { width, height, step, encoding, pixels, .. } = *self;
        if let Some(expected) = expected.filter(|expected| *expected != [width, height]) {
            return Err(FrameError::Size { expected, actual: [width, height] });
        }
        let row = (width as usize).saturating_mul(encoding.pixel_bytes());
        if (step as usize) < row || pixels.len() != (step as usize).saturating_mul(height as usize) {
            return Err(FrameError::Length { height, step, width, length: pixels.len() });
        }
        if pixels.len() > most {
            return Err(FrameError::Large { length: pixels.len(), most });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_encodings() {
        for name in ["rgb8", "bgr8", "yuv422_yuy2"] {
            assert_eq!(Encoding::from_name(name).map(Encoding::name), Some(name));
        }
        assert_eq!(Encoding::from_name("mono8"), None);
    }

    #[test]
    fn frames_that_contradict_themselves_are_refused() {
        let bytes = [0; 64];
        let check = |encoding, [width, height, step]: [u32; 3], length: usize, expected: Option<&str>| {
            let frame = Frame { exposed: RosTime(0), width, height, step, encoding, pixels: &bytes[..length] };
            let error = frame.check(Some([4, 3]), 48).err();
            assert_eq!(error.map(|error| error.to_string()).as_deref(), expected);
        };
        check(Encoding::Rgb8, [4, 3, 12], 36, None);
        check(Encoding::Bgr8, [4, 3, 16], 48, None);
        check(Encoding::Yuv422Yuy2, [4, 3, 8], 24, None);
        check(Encoding::Rgb8, [3, 4, 12], 48, Some("a frame has [3, 4] pixels, the lens file says [4, 3]"));
        check(Encoding::Rgb8, [4, 3, 12], 35, Some("a frame of 3 rows of 12 bytes for 4 pixels has 35 bytes"));
        check(Encoding::Rgb8, [4, 3, 8], 24, Some("a frame of 3 rows of 8 bytes for 4 pixels has 24 bytes"));
        check(Encoding::Rgb8, [4, 3, 20], 60, Some("a frame has 60 bytes, the first had 48"));
    }
}
