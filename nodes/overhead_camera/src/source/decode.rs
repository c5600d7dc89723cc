//! PNG and JPEG to rgb8.

use super::SourceError;
use crate::frame::{Encoding, Frame};
use image::{DynamicImage, ImageReader, Limits};
use std::io::Cursor;
use trench_core::RosTime;

/// The longest edge of an image, pixels: more is no camera's, and would fill the memory.
pub(super) const LONGEST_EDGE: u32 = 8192;

/// Decodes a PNG or JPEG image, told by its first bytes; `name` goes into the error.
pub(super) fn decode(bytes: &[u8], name: &str) -> Result<DynamicImage, SourceError> {
    let wrong = |problem: String| SourceError::Frame(format!("{name}: {problem}"));
    let mut reader =
        ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| wrong(error.to_string()))?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LONGEST_EDGE), Some(LONGEST_EDGE));
    reader.limits(limits);
    let image = reader.decode().map_err(|error| wrong(error.to_string()))?;
    if !image.color().has_color() {
        return Err(wrong("the image is grey: the pads' colours are needed".to_owned()));
    }
    Ok(DynamicImage::ImageRgb8(image.into_rgb8()))
}

/// A decoded image as a frame.
pub(super) fn frame(image: &DynamicImage, exposed: RosTime) -> Frame<'_> {
    let (width, height) = (image.width(), image.height());
    Frame { exposed, width, height, step: 3 * width, encoding: Encoding::Rgb8, pixels: image.as_bytes() }
}
