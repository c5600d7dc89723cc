//! Both discs of a pad that something lies over, as one figure.
//!
//! Two circles of one size, at a spacing that is known in their diameters: four numbers place them. What is seen of either
//! rim counts for both, so that pieces are enough with which a circle alone could be anywhere.

use super::blob::Tracer;
use super::rim;
use nalgebra::{Matrix4, Vector2, Vector4};
use trench_optics::Pixel;

/// How often rims are looked for anew from where the circles lie now, and steps of least squares for each look.
const LOOKS: usize = 4;
const STEPS: usize = 4;
/// Places inside a circle lose their weight beyond this, in radii: the edge of what hides the disc is there. Drawn in from look
/// to look.
const HIDDEN: [f64; LOOKS] = [0.5, 0.3, 0.2, 0.14];
/// Nothing hides what is outside: such places count up to here.
const BEYOND: f64 = 0.5;
/// So many places must lie on both rims together, and on each.
const FEWEST: usize = 22;
const FEWEST_EACH: usize = 6;
/// So many may lie outside: noise.
const MOST_BEYOND: usize = 3;
/// The whole is so large, as expected.
const SIZE: [f64; 2] = [0.95, 1.05];
/// What is within so much of a circle's radius is surely inside.
const INNER: f64 = 0.85;
/// Of each disc at least this part is seen.
const SEEN: f64 = 0.3;

/// A pad as it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PadFit {
    /// Of the discs, in the order of the tracers.
    pub(super) centres: [Pixel; 2],
    /// The mean pixel of what is seen of each disc.
    pub(super) colours: [[u8; 3]; 2],
    /// The chroma of each.
    pub(super) contrast: [i32; 2],
    /// The part of each disc that is seen, 0..1.
    pub(super) seen: [f64; 2],
    /// Of the expected radius.
    pub(super) size: f64,
}

/// The pad whose discs are near `start`, with these half axes (pixels); `spacing` is in diameters.
pub(super) fn fit<const RED: usize>(
    tracers: [&Tracer<'_, RED>; 2],
    start: [Pixel; 2],
    half: [f64; 2],
    spacing: f64,
) -> Option<PadFit> {
    let in_radii = |place: Pixel| Vector2::new(place.u / half[0], place.v / half[1]);
    let level = tracer_level(tracers[1], in_radii(start[1]), half)?;
    let (second, _) = rim::settle(tracers[1], [start[1].u, start[1].v], half, level)?;
    let mut pad = Figure::between([start[0], Pixel { u: second[0], v: second[1] }].map(in_radii), spacing);
    let mut places = [Vec::new(), Vec::new()];
    for hidden in HIDDEN {
        for (index, tracer) in tracers.into_iter().enumerate() {
            let centre = pad.centre(index);
            let level = tracer_level(tracer, centre, half)?;
            let (found, count) = rim::rim(tracer, [centre.x * half[0], centre.y * half[1]], half, level);
            places[index] = found[..count].iter().map(|place| centre + Vector2::from(*place)).collect();
        }
        for _ in 0..STEPS {
            pad = pad.nearer(&places, hidden)?;
        }
    }
    let off = |index: usize| places[index].iter().map(move |place| (place, index));
    let all = || off(0).chain(off(1)).map(|(place, index)| (index, pad.off(index, *place)));
    let on_rim = [0, 1].map(|disc| all().filter(|(index, off)| *index == disc && off.abs() < rim::ON_RIM).count());
    let beyond = all().filter(|(_, off)| *off > 2.0 * rim::ON_RIM).count();
    let size = pad.size();
    let centres = [0, 1].map(|index| pad.centre(index));
    let (mut seen, mut colours, mut contrast) = ([0.0; 2], [[0; 3]; 2], [0; 2]);
    for (index, tracer) in tracers.into_iter().enumerate() {
        let look = Look::at(tracer, centres[index], half, INNER * size)?;
        (contrast[index], seen[index], colours[index]) = (2 * look.level, look.seen, look.colour);
    }
    let fits = on_rim[0] + on_rim[1] >= FEWEST
        && on_rim.iter().all(|count| *count >= FEWEST_EACH)
        && beyond <= MOST_BEYOND
        && (SIZE[0]..SIZE[1]).contains(&size)
        && seen.iter().all(|part| *part >= SEEN);
    let in_pixels = |centre: Vector2<f64>| Pixel { u: centre.x * half[0], v: centre.y * half[1] };
    fits.then(|| PadFit { centres: centres.map(in_pixels), colours, contrast, seen, size })
}

/// Half the chroma of a disc of which a fifth is seen.
fn tracer_level<const RED: usize>(tracer: &Tracer<'_, RED>, centre: Vector2<f64>, half: [f64; 2]) -> Option<i32> {
    let mut chroma = Vec::new();
    rim::for_ellipse([centre.x * half[0], centre.y * half[1]], half, |u, v| chroma.push(tracer.chroma(u, v)));
    level(&mut chroma)
}

fn level(chroma: &mut [i32]) -> Option<i32> {
    let rank = chroma.len() * 4 / 5;
    (rank < chroma.len()).then(|| *chroma.select_nth_unstable(rank).1 / 2)
}

/// What the pixels of a disc say, each read once.
struct Look {
    /// Half the disc's chroma.
    level: i32,
    /// The part of the disc that has it, 0..1.
    seen: f64,
    /// The mean of the pixels that have it.
    colour: [u8; 3],
}

impl Look {
    /// At the circle around `centre` (radii of the expected size); what is within `inner` of its radius is surely inside.
    fn at<const RED: usize>(
        tracer: &Tracer<'_, RED>,
        centre: Vector2<f64>,
        half: [f64; 2],
        inner: f64,
    ) -> Option<Self> {
        let (mut all, mut inside) = (Vec::new(), Vec::new());
        rim::for_ellipse([centre.x * half[0], centre.y * half[1]], half, |u, v| {
            let chroma = tracer.chroma(u, v);
            all.push(chroma);
            let away = Vector2::new(u as f64 / half[0], v as f64 / half[1]) - centre;
            if away.norm_squared() <= inner * inner {
                inside.push((chroma, tracer.pixel(u, v)));
            }
        });
        let level = level(&mut all)?;
        let coloured = || inside.iter().filter(|(chroma, _)| *chroma >= level);
        let (mut count, mut sum) = (0_u32, [0_u32; 3]);
        for pixel in coloured().filter_map(|(_, pixel)| *pixel) {
            count += 1;
            sum = [0, 1, 2].map(|channel| sum[channel] + u32::from(pixel[channel]));
        }
        let seen = coloured().count() as f64 / inside.len().max(1) as f64;
        Some(Self { level, seen, colour: sum.map(|total| (total / count.max(1)) as u8) })
    }
}

/// Two circles of one size; places in radii of the expected size.
#[derive(Debug, Clone, Copy)]
struct Figure {
    middle: Vector2<f64>,
    /// From the middle to the first circle's centre, against the direction to the second.
    arm: Vector2<f64>,
    /// From centre to centre, in the circles' own radii.
    spacing: f64,
}

impl Figure {
    fn between([first, second]: [Vector2<f64>; 2], spacing: f64) -> Self {
        Self { middle: 0.5 * (first + second), arm: 0.5 * (first - second), spacing: 2.0 * spacing }
    }

    fn side(index: usize) -> f64 {
        if index == 0 { 1.0 } else { -1.0 }
    }

    fn centre(&self, index: usize) -> Vector2<f64> {
        self.middle + Self::side(index) * self.arm
    }

    fn size(&self) -> f64 {
        2.0 * self.arm.norm() / self.spacing
    }

    /// How far a place is outside a circle.
    fn off(&self, index: usize, place: Vector2<f64>) -> f64 {
        (place - self.centre(index)).norm() - self.size()
    }

    /// One step of weighted least squares (J. Tukey's biweight).
    fn nearer(&self, places: &[Vec<Vector2<f64>>; 2], hidden: f64) -> Option<Self> {
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        let growth = self.arm.normalize() * (2.0 / self.spacing);
        for (index, place) in places.iter().enumerate().flat_map(|(index, all)| all.iter().map(move |it| (index, it))) {
            let away = place - self.centre(index);
            let distance = away.norm().max(1e-6);
            let off = distance - self.size();
            let part = (off / if off < 0.0 { hidden } else { BEYOND }).abs();
            if part < 1.0 {
                let weight = (1.0 - part * part) * (1.0 - part * part);
                let outwards = away / distance;
                let arm = Self::side(index) * outwards + growth;
                let slope = Vector4::new(outwards.x, outwards.y, arm.x, arm.y);
                normal += weight * slope * slope.transpose();
                right += weight * off * slope;
            }
        }
        let step = normal.try_inverse()? * right;
        let next = Self { middle: self.middle + step.xy(), arm: self.arm + Vector2::new(step.z, step.w), ..*self };
        next.arm.norm().is_normal().then_some(next)
    }
}
