//! One frame of the camera as red, green, blue.

use image::RgbImage;
use std::io::Cursor;
use trench_harness::vision::{Frame, decode};
use trench_msgs::Message;
use trench_msgs::sensor_msgs::{CompressedImage, ImageView};

/// A frame, numbered in the order of their coming.
#[derive(Debug, Clone)]
pub(super) struct Shot {
    pub(super) number: u64,
    pub(super) picture: RgbImage,
}

/// JPEG quality of what browsers get: a click reads the frame itself, not what it looks like.
const QUALITY: u8 = 85;
/// Red, green, blue, opacity of what counts as nothing, yellow and blue.
const COVER: [[u8; 4]; 3] = [[0; 4], [255, 0, 170, 255], [0, 255, 140, 255]];

impl Shot {
    /// Reads a message; `size` is what the lens file says.
    ///
    /// # Errors
    /// With the reason, for the person at the page.
    pub(super) fn read(number: u64, cdr: &[u8], compressed: bool, size: [usize; 2]) -> Result<Self, String> {
        let picture = if compressed {
            let packed = CompressedImage::decode(cdr).map_err(|error| error.to_string())?;
            decode(&packed.data)?
        } else {
            let image = ImageView::decode(cdr).map_err(|error| error.to_string())?;
            let (given, mut room, mut rgb) = ([image.width, image.height], Vec::new(), Vec::new());
            let given_size = given.map(|side| side as usize);
            let frame = Frame::new(size, image.encoding, given_size, image.step as usize, image.data, &mut room);
            frame.map_err(|error| error.to_string())?.to_rgb(&mut rgb);
            RgbImage::from_raw(given[0], given[1], rgb).ok_or("the frame has too few pixels")?
        };
        let shot = Self { number, picture };
        let mut room = Vec::new();
        shot.frame(size, &mut room).map_err(|error| error.to_string())?;
        Ok(shot)
    }

    /// As the localizer reads it.
    pub(super) fn frame<'a>(
        &'a self,
        size: [usize; 2],
        room: &'a mut Vec<u8>,
    ) -> Result<Frame<'a>, trench_harness::vision::FrameError> {
        let (width, height) = self.picture.dimensions();
        let given = [width, height].map(|side| side as usize);
        Frame::new(size, "rgb8", given, 3 * given[0], self.picture.as_raw(), room)
    }

    /// As JPEG.
    pub(super) fn jpeg(&self) -> Result<Vec<u8>, image::ImageError> {
        let mut bytes = Vec::new();
        self.picture.write_with_encoder(image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, QUALITY))?;
        Ok(bytes)
    }

    /// What is covered, `colours` being as the detector gives them, as PNG to lay over the picture.
    pub(super) fn overlay(&self, colours: &[u8]) -> Result<Vec<u8>, image::ImageError> {
        let (width, height) = self.picture.dimensions();
        let pixel = |u: u32, v: u32| {
            let number = colours.get(v as usize * width as usize + u as usize).copied().unwrap_or_default();
            image::Rgba(COVER.get(usize::from(number)).copied().unwrap_or_default())
        };
        let mut bytes = Cursor::new(Vec::new());
        image::RgbaImage::from_fn(width, height, pixel).write_to(&mut bytes, image::ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }
}
