//! The centre of area of a disc to a hundredth of a pixel.

use super::blob::{Extent, Tracer};
use super::weigh::{Moments, moments};
use trench_optics::Pixel;

/// A disc's measured centre and size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    pub(super) centre: Pixel,
    /// pixel^2
    pub(super) area: f64,
    /// Chroma of the disc less that of the ground.
    pub(super) contrast: i32,
}

/// How far outside the disc's edge pixels still count, pixels. The pad's other disc begins 3.9 pixels away, the floor
/// around the body 2.9 pixels.
const MARGIN: f64 = 2.2;

/// Below and above these fractions of the disc's contrast a pixel counts as outside or inside: with noise of 4/255 only
/// pixels on the edge have a weight in between. In 1/16.
const OUTSIDE: i32 = 2;
const INSIDE: i32 = 14;

/// The centre of area of the disc in `extent`: every pixel weighted by the fraction of it that the disc covers, which its
/// chroma tells between that of the surroundings and that of the disc itself. Both are measured here, so that neither the
/// light nor the ground matters. None without contrast.
pub(super) fn measure<const RED: usize>(tracer: &Tracer<'_, RED>, extent: Extent) -> Option<Measured> {
    let centre_u = 0.5 * (extent.columns[0] + extent.columns[1]) as f64;
    let centre_v = 0.5 * (extent.rows[0] + extent.rows[1]) as f64;
    let reach_u = 0.5 * (extent.columns[1] - extent.columns[0] + 1) as f64 + MARGIN;
    let reach_v = 0.5 * (extent.rows[1] - extent.rows[0] + 1) as f64 + MARGIN;

    let inside = tracer.level(centre_u as usize, centre_v as usize);
    let outside = surroundings(tracer, [centre_u, centre_v], [reach_u, reach_v]);
    let contrast = inside - outside;
    let (lowest, highest) = (outside + OUTSIDE * contrast / 16, outside + INSIDE * contrast / 16);
    if highest <= lowest {
        return None;
    }

    let first_row = (centre_v - reach_v).max(0.0) as usize;
    let last_row = ((centre_v + reach_v) as usize).min(tracer.frame.height.saturating_sub(1));
    // All of them before the first is used: the processor takes several roots at a time, if nothing depends on them yet.
    let rows = (first_row..last_row + 1).map(|v| {
        let down = (v as f64 - centre_v) / reach_v;
        let half_width = reach_u * (1.0 - down * down).max(0.0).sqrt();
        let first = (centre_u - half_width + 0.5).max(0.0) as usize;
        [first, ((centre_u + half_width + 0.5) as usize).min(tracer.frame.width)]
    });
    let rows: Vec<[usize; 2]> = rows.collect();
    let Moments { sum, across, down } = moments(tracer, [lowest, highest], first_row, &rows);
    let total = sum as f64;
    (sum > 0).then(|| Measured {
        centre: Pixel { u: across as f64 / total, v: down as f64 / total },
        area: total / f64::from(highest - lowest),
        contrast,
    })
}

/// The median chroma of sixteen pixels around the disc.
fn surroundings<const RED: usize>(tracer: &Tracer<'_, RED>, centre: [f64; 2], reach: [f64; 2]) -> i32 {
    // Cosines of multiples of 22.5 degrees.
    const QUARTER: [f64; 5] =
        [1.0, 0.923_879_532_511_286_7, std::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_8, 0.0];
    let mut samples = [0_i32; 16];
    for (index, sample) in samples.iter_mut().enumerate() {
        let within = index % 4;
        let (cosine, sine) = (QUARTER[within], QUARTER[4 - within]);
        let (right, down) = match index / 4 {
            0 => (cosine, sine),
            1 => (-sine, cosine),
            2 => (-cosine, -sine),
            _ => (sine, -cosine),
        };
        // Outside the image the nearest pixel stands in.
        let place = |centre: f64, offset: f64, size: usize| ((centre + offset + 0.5).max(0.0) as usize).min(size - 1);
        let u = place(centre[0], reach[0] * right, tracer.frame.width.max(1));
        let v = place(centre[1], reach[1] * down, tracer.frame.height.max(1));
        *sample = tracer.chroma(u, v);
    }
    samples.sort_unstable();
    (samples[7] + samples[8]) / 2
}
