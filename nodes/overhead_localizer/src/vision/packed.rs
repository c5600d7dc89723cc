//! PNG and JPEG frames.

use image::RgbImage;

/// Decodes a PNG or JPEG image, told by its first bytes, to rgb8.
///
/// # Errors
/// With the reason, when the bytes are no such image, it is larger than 512 MiB or it has no colours.
pub fn decode(bytes: &[u8]) -> Result<RgbImage, String> {
    let image = image::load_from_memory(bytes).map_err(|error| error.to_string())?;
    if !image.color().has_color() {
        return Err("the image is grey: pads are told by their colours; set the camera to colours".to_owned());
    }
    Ok(image.into_rgb8())
}
