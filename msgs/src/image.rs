//! Writing an image whose pixels are not there yet: they are rendered straight into loaned memory.

use crate::Encode;
use crate::sensor_msgs::ImageView;
use std::ops::Range;

/// The bytes of the length in front of the pixels.
const LENGTH: usize = 4;

impl ImageView<'_> {
    /// The number of bytes of this image's CDR with `data_len` bytes of pixels in place of [`ImageView::data`].
    #[must_use]
    pub fn encoded_len_with(&self, data_len: usize) -> usize {
        Self { data: &[], ..*self }.encoded_len() + data_len
    }

    /// Writes everything but the pixels into the front of `out` and gives the range of `out` that is for `data_len` bytes
    /// of pixels, with which the message ends; [`ImageView::data`] is not looked at. Gives nothing when `out` is shorter
    /// than [`ImageView::encoded_len_with`].
    #[must_use]
    pub fn encode_around(&self, data_len: usize, out: &mut [u8]) -> Option<Range<usize>> {
        // The pixels are the last field: an image without them ends with their length.
        let frame = Self { data: &[], ..*self };
        let start = frame.encoded_len();
        let end = start.checked_add(data_len).filter(|end| *end <= out.len())?;
        let length = u32::try_from(data_len).ok()?;
        frame.encode_into(out);
        out[start - LENGTH..start].copy_from_slice(&length.to_le_bytes());
        Some(start..end)
    }
}
