//! The centre of a disc that hardly stands out: dark, in lamp light, or behind JPEG's coarse colours.
//!
//! There the opponent channel, white light restored, is mostly the noise of the weakest channel. What tells most is the
//! difference between the disc's own red, green and blue and those of the ground around it: pixels are measured along that
//! (R. A. Fisher's linear discriminant, with noise alike in all channels). Grey floor is not nothing in that measure; so it is
//! used only where the other fails, and looks no farther than the pad.

use super::blob::Tracer;
use trench_optics::Pixel;

/// The disc's own colours are taken from within this part of its radius.
const WITHIN: f64 = 0.65;
/// The ground's from this ring, in radii, and pixels count up to its middle.
const GROUND: [f64; 2] = [1.12, 1.28];
const REACH: f64 = 1.2;
/// How often the centre is measured anew where the last one was.
const ROUNDS: usize = 4;

/// The centre of the disc near `centre` with these half axes, pixels. None without contrast.
pub(super) fn centre<const RED: usize>(tracer: &Tracer<'_, RED>, centre: Pixel, half: [f64; 2]) -> Option<Pixel> {
    let mut at = [centre.u, centre.v];
    for _ in 0..ROUNDS {
        at = measure(tracer, at, half)?;
    }
    let moved = libm::hypot((at[0] - centre.u) / half[0], (at[1] - centre.v) / half[1]);
    (moved < 0.35).then_some(Pixel { u: at[0], v: at[1] })
}

fn measure<const RED: usize>(tracer: &Tracer<'_, RED>, at: [f64; 2], half: [f64; 2]) -> Option<[f64; 2]> {
    let (mut disc, mut ground) = (Mean::default(), Mean::default());
    each(tracer, at, half, GROUND[1], |radius, _, pixel| {
        if radius < WITHIN {
            disc.add(pixel);
        } else if radius > GROUND[0] {
            ground.add(pixel);
        }
    });
    let (inside, outside) = (disc.get()?, ground.get()?);
    let along = [0, 1, 2].map(|channel| inside[channel] - outside[channel]);
    let length2: f64 = along.iter().map(|part| part * part).sum();
    if length2 < 1.0 {
        return None;
    }
    let (mut sum, mut moment) = (0.0, [0.0; 2]);
    each(tracer, at, half, REACH, |_, place, pixel| {
        // 0 on the ground, 1 on the disc.
        let part: f64 = (0..3).map(|channel| along[channel] * (f64::from(pixel[channel]) - outside[channel])).sum();
        let weight = (part / length2).clamp(0.0, 1.0);
        sum += weight;
        moment = [moment[0] + weight * place[0], moment[1] + weight * place[1]];
    });
    (sum > 1.0).then(|| moment.map(|total| total / sum))
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
