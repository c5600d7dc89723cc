//! The disc that a pad's other disc tells of.
//!
//! A disc that is seen has another one of the other colour at the pad's spacing, in a direction that is not known. Where none
//! was found there, it is looked for once more: somewhere on that circle must be what tells from its ground as a disc does, with
//! the sign of its colour. That is much to ask by chance, and so less is asked of the colour itself, which bad light or JPEG may
//! have washed out.

use super::blob::Tracer;
use super::faint::{self, Faint};
use trench_optics::Pixel;

/// Directions in which it is looked for: two pixels from one to the next on the test bed.
const DIRECTIONS: usize = 72;
/// So many places are tried, and so many directions apart.
const TRIES: usize = 4;
const APART: usize = 5;
/// Its distance from the other disc is this part of the spacing.
const DISTANCE: [f64; 2] = [0.9, 1.1];
/// Its pixels differ no more from a disc's on a ground, of the contrast of both: noise does, edges and corners do more.
const SCATTER: f64 = 0.3;

/// The disc of `tracer`'s colour at one of `places` whose partner is at `of`, `spacing` away (pixels along row and column), with
/// these half axes.
pub(super) fn find<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    places: &[Pixel],
    of: Pixel,
    spacing: [f64; 2],
    half: [f64; 2],
) -> Option<Faint> {
    let at =
        |place: &Pixel| faint::measure(tracer, *place, half).filter(|found| fits(tracer, found, of, spacing, half));
    places.iter().find_map(at)
}

/// Where the disc may be whose partner is at `of`, the likeliest place first.
pub(super) fn places<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    of: Pixel,
    spacing: [f64; 2],
    half: [f64; 2],
) -> Vec<Pixel> {
    let mut looks = [(0, Pixel::default()); DIRECTIONS];
    for (direction, look) in looks.iter_mut().enumerate() {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64);
        let place = Pixel { u: of.u + spacing[0] * cosine, v: of.v + spacing[1] * sine };
        *look = (spread(tracer, place, half), place);
    }
    let mut places = Vec::with_capacity(TRIES);
    while places.len() < TRIES
        && let Some((best, &(chroma, place))) = looks.iter().enumerate().max_by_key(|(_, (chroma, _))| *chroma)
        && chroma > 0
    {
        places.push(place);
        // Elsewhere, then.
        for near in 0..=2 * APART {
            looks[(best + DIRECTIONS + near - APART) % DIRECTIONS].0 = 0;
        }
    }
    places
}

/// Whether this is a disc, at the pad's spacing, away from the image's edge.
fn fits<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    found: &Faint,
    of: Pixel,
    spacing: [f64; 2],
    half: [f64; 2],
) -> bool {
    let away = libm::hypot((found.centre.u - of.u) / spacing[0], (found.centre.v - of.v) / spacing[1]);
    tracer.frame.holds(found.centre, half) && found.scatter < SCATTER && (DISTANCE[0]..DISTANCE[1]).contains(&away)
}

/// The chroma of nine places all over a disc, at their sum; little where one of them lies outside the image.
fn spread<const RED: usize>(tracer: &Tracer<'_, RED>, centre: Pixel, half: [f64; 2]) -> i32 {
    let steps = [-0.55, 0.0, 0.55];
    let at = |across: f64, down: f64| {
        let (u, v) = (centre.u + across * half[0], centre.v + down * half[1]);
        // Negative places are none.
        if u < 0.0 || v < 0.0 { i32::MIN / 64 } else { tracer.chroma(u as usize, v as usize) / 4 }
    };
    steps.into_iter().flat_map(|down| steps.map(|across| at(across, down))).sum()
}
