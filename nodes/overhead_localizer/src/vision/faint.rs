//! The centre of a disc that hardly stands out: dark, in lamp light, or behind JPEG's coarse colours.
//!
//! There the opponent channel, white light restored, is mostly the noise of the weakest channel. What tells most is the
//! difference between the disc's own red, green and blue and those of the ground around it: pixels are measured along that
//! (R. A. Fisher's linear discriminant, with noise alike in all channels). Grey floor is not nothing in that measure; so it is
//! used only where the other fails, and looks from the disc outwards, no farther than to its edge.

use super::blob::Tracer;
use super::rim;
use trench_optics::Pixel;

/// The disc's own colours are taken from within this part of its radius.
const WITHIN: f64 = 0.65;
/// The ground's from this ring, in radii, and pixels count up to its middle.
const GROUND: [f64; 2] = [1.12, 1.28];
const REACH: f64 = 1.2;
/// How often the centre is measured anew where the last one was.
const ROUNDS: usize = 4;
/// Up to this part of its radius a pixel belongs to the disc wholly.
const WHOLE: f64 = 0.85;
/// Directions in which the edge is looked for, and from where to where, in radii.
const DIRECTIONS: usize = 32;
const EDGE: [f64; 2] = [0.5, 1.4];
/// An edge of this size, in radii, is the disc's.
const SIZE: [f64; 2] = [0.85, 1.15];

/// A disc measured by its own colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Faint {
    pub(super) centre: Pixel,
    /// Its red, green and blue (in the frame's order).
    pub(super) inside: [f64; 3],
    /// Those of the ground around it.
    pub(super) outside: [f64; 3],
    /// How far pixels are from what a disc on a ground has, of the contrast between both: their noise, if it is one.
    pub(super) scatter: f64,
}

/// The disc around `centre`, more or less, with these half axes, pixels. None without contrast; whether it is a disc the
/// scatter tells.
pub(super) fn measure<const RED: usize>(tracer: &Tracer<'_, RED>, centre: Pixel, half: [f64; 2]) -> Option<Faint> {
    let mut at = [centre.u, centre.v];
    for _ in 0..ROUNDS {
        at = shift(tracer, at, half, &Contrast::around(tracer, at, half)?)?;
    }
    let contrast = Contrast::around(tracer, at, half)?;
    at = edge(tracer, at, half, &contrast).unwrap_or(at);
    Some(Faint {
        centre: Pixel { u: at[0], v: at[1] },
        inside: contrast.inside,
        outside: contrast.outside,
        scatter: scatter(tracer, at, half, &contrast),
    })
}

/// What tells a disc from its ground.
struct Contrast {
    inside: [f64; 3],
    outside: [f64; 3],
    along: [f64; 3],
    length2: f64,
}

impl Contrast {
    fn around<const RED: usize>(tracer: &Tracer<'_, RED>, at: [f64; 2], half: [f64; 2]) -> Option<Self> {
        let mut disc = Mean::default();
        let mut ground: [Vec<u8>; 3] = Default::default();
        each(tracer, at, half, GROUND[1], |radius, _, pixel| {
            if radius < WITHIN {
                disc.add(pixel);
            } else if radius > GROUND[0] {
                ground.iter_mut().zip(pixel).for_each(|(values, value)| values.push(value));
            }
        });
        // Where the centre is not known yet the ring touches what lies beyond the pad: the median does not mind.
        let (inside, outside) = (disc.get()?, ground.map(median));
        let along = [0, 1, 2].map(|channel| inside[channel] - outside[channel]);
        let length2: f64 = along.iter().map(|part| part * part).sum();
        (length2 >= 1.0).then_some(Self { inside, outside, along, length2 })
    }

    /// 0 on the ground, 1 on the disc.
    fn part(&self, pixel: [u8; 3]) -> f64 {
        let part = |channel: usize| self.along[channel] * (f64::from(pixel[channel]) - self.outside[channel]);
        (part(0) + part(1) + part(2)) / self.length2
    }
}

/// The centre of area of what is within reach.
fn shift<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    at: [f64; 2],
    half: [f64; 2],
    contrast: &Contrast,
) -> Option<[f64; 2]> {
    let (mut sum, mut moment) = (0.0, [0.0; 2]);
    each(tracer, at, half, REACH, |_, place, pixel| {
        let weight = contrast.part(pixel).clamp(0.0, 1.0);
        sum += weight;
        moment = [moment[0] + weight * place[0], moment[1] + weight * place[1]];
    });
    (sum > 1.0).then(|| moment.map(|total| total / sum))
}

/// The middle of the circle on which, from inside outwards, the disc ends.
fn edge<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    at: [f64; 2],
    half: [f64; 2],
    contrast: &Contrast,
) -> Option<[f64; 2]> {
    let step = 0.5 / half[0].max(half[1]);
    let mut places = Vec::with_capacity(DIRECTIONS);
    for direction in 0..DIRECTIONS {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64);
        let part = |radius: f64| {
            rim::between([at[0] + half[0] * radius * cosine, at[1] + half[1] * radius * sine], |u, v| {
                tracer.pixel(u, v).map_or(0.0, |pixel| contrast.part(pixel))
            })
        };
        let (mut radius, mut inner) = (EDGE[0], part(EDGE[0]));
        while radius < EDGE[1] {
            let outer = part(radius + step);
            if inner >= 0.5 && outer < 0.5 {
                let edge = radius + step * (inner - 0.5) / (inner - outer);
                places.push([edge * cosine, edge * sine]);
                break;
            }
            (radius, inner) = (radius + step, outer);
        }
    }
    let circle = rim::fit(&places)?;
    (SIZE[0]..SIZE[1]).contains(&circle.z).then(|| [at[0] + half[0] * circle.x, at[1] + half[1] * circle.y])
}

fn scatter<const RED: usize>(tracer: &Tracer<'_, RED>, at: [f64; 2], half: [f64; 2], contrast: &Contrast) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    each(tracer, at, half, GROUND[1], |radius, _, pixel| {
        if !(WHOLE..GROUND[0]).contains(&radius) {
            let off = contrast.part(pixel) - if radius < WHOLE { 1.0 } else { 0.0 };
            (sum, count) = (sum + off * off, count + 1.0);
        }
    });
    libm::sqrt(sum / f64::max(count, 1.0))
}

#[derive(Default)]
struct Mean {
    sum: [u32; 3],
    count: u32,
}

impl Mean {
    fn add(&mut self, pixel: [u8; 3]) {
        self.count += 1;
        for (sum, value) in self.sum.iter_mut().zip(pixel) {
            *sum += u32::from(value);
        }
    }

    fn get(&self) -> Option<[f64; 3]> {
        (self.count > 0).then(|| self.sum.map(|sum| f64::from(sum) / f64::from(self.count)))
    }
}

fn median(mut values: Vec<u8>) -> f64 {
    values.sort_unstable();
    let middle = values.len() / 2;
    values
        .get(middle.saturating_sub(1)..=middle)
        .map_or(0.0, |both| f64::from(u16::from(both[0]) + u16::from(both[both.len() - 1])) / 2.0)
}

/// Visits the pixels within `reach` radii: how many radii away, where, and what is there.
fn each<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    at: [f64; 2],
    half: [f64; 2],
    reach: f64,
    mut visit: impl FnMut(f64, [f64; 2], [u8; 3]),
) {
    let range = |axis: usize| {
        let far = reach * half[axis];
        (at[axis] - far).max(0.0) as usize..(at[axis] + far).max(0.0) as usize + 2
    };
    for v in range(1) {
        let row = tracer.frame.row(v);
        for u in range(0) {
            let Some(&[a, b, c]) = row.get(3 * u..3 * u + 3) else { continue };
            let place = [u as f64, v as f64];
            let radius = libm::hypot((place[0] - at[0]) / half[0], (place[1] - at[1]) / half[1]);
            if radius <= reach {
                visit(radius, place, [a, b, c]);
            }
        }
    }
}
