//! yuv422_yuy2 to rgb8: BT.601 in the range 16 to 235, as USB cameras send it.

/// Converts rows of `step` bytes, two pixels in four of them, into rows of three bytes a pixel without a gap.
///
/// Two pixels share their colour. Here each takes it as it is, which leaves a disc's centre where it is if the camera
/// averages both pixels' colours; one that takes the first one's shifts all discs by half a pixel along the rows, as the
/// calibration finds.
pub(super) fn to_rgb(bytes: &[u8], step: usize, width: usize, rgb: &mut Vec<u8>) {
    rgb.clear();
    for row in bytes.chunks(step) {
        for pair in row.chunks_exact(4).take(width / 2) {
            let (u, v) = (i32::from(pair[1]) - 128, i32::from(pair[3]) - 128);
            // In 1/256, a half added for rounding.
            let (red, green, blue) = (409 * v + 128, 128 - 100 * u - 208 * v, 516 * u + 128);
            for y in [pair[0], pair[2]] {
                let light = 298 * (i32::from(y) - 16);
                rgb.extend([red, green, blue].map(|colour| ((light + colour) >> 8).clamp(0, 255) as u8));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounded by the definition of BT.601.
    fn yuv([red, green, blue]: [f64; 3]) -> [u8; 3] {
        let luma = 0.299 * red + 0.587 * green + 0.114 * blue;
        let scaled = |value: f64, offset: f64| (value + offset).round().clamp(0.0, 255.0) as u8;
        [
            scaled(luma * 219.0 / 255.0, 16.0),
            scaled((blue - luma) / 1.772 * 224.0 / 255.0, 128.0),
            scaled((red - luma) / 1.402 * 224.0 / 255.0, 128.0),
        ]
    }

    #[test]
    fn colours_come_back() {
        for rgb in [[235, 205, 45], [35, 80, 200], [0; 3], [255; 3], [150; 3], [255, 0, 0], [0, 255, 0], [0, 0, 255]] {
            let [y, u, v] = yuv(rgb.map(f64::from));
            let mut back = Vec::new();
            // Two rows of two pixels, with padding.
            to_rgb(&[y, u, y, v, 9, 9, y, u, y, v, 9, 9], 6, 2, &mut back);
            assert_eq!(back.len(), 12);
            for (index, value) in back.iter().enumerate() {
                assert!(value.abs_diff(rgb[index % 3]) <= 2, "{rgb:?}: {back:?}");
            }
        }
    }
}
