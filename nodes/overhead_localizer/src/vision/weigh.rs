//! Sums over the pixels of a disc, eight pixels in a step.

use super::balance::Weights;
use super::blob::Tracer;
use super::chroma::{chroma, chroma_of_eight, white_chroma_of_eight};
use std::ops::Range;
use wide::{i16x8, i32x4, u8x16};

/// Sums of the weights of pixels, and of their products with column and row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Moments {
    pub(super) sum: i64,
    pub(super) across: i64,
    pub(super) down: i64,
}

/// Pixels in a step.
const STEP: usize = 8;
/// Lanes of a vector: a step takes three.
const LANES: usize = 8;
/// Bytes that a step may read: a vector is loaded with sixteen, the last from the nineteenth on.
const READ: usize = 34;
/// Wider things might overflow a lane's sum: 128 x 128 pixels of the largest weight, about 2,000 in lamp light, do not.
const WIDEST: usize = 128;

/// A step works on every byte as if a pixel began there, since vectors of neighbours are made faster than vectors of each third
/// byte. These masks take the others out; and from `3 * (STEP - n)` on, all pixels but the first `n`.
const PICK: [i16; 6 * STEP] = {
    let mut pick = [0; 6 * STEP];
    let mut lane = 0;
    while lane < 3 * STEP {
        pick[lane] = if lane % 3 == 0 { -1 } else { 0 };
        lane += 1;
    }
    pick
};
/// The pixel that a byte belongs to.
const COLUMN: [i16; 3 * STEP] = {
    let mut column = [0; 3 * STEP];
    let mut lane = 0;
    while lane < 3 * STEP {
        column[lane] = (lane / 3) as i16;
        lane += 1;
    }
    column
};

/// Adds up pixels, each weighted by how far its chroma is above `limits[0]`, at most as far as `limits[1]` is: those between the
/// two columns of each of `rows`, of which the first is the frame's row `top`.
pub(super) fn moments<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    limits: [i32; 2],
    top: usize,
    rows: &[[usize; 2]],
) -> Moments {
    let left = rows.iter().map(|row| row[0]).min().unwrap_or_default();
    let right = rows.iter().map(|row| row[1]).max().unwrap_or_default();
    let in_steps = rows.len().max(right.saturating_sub(left)) <= WIDEST;
    let mut block = Block { sum: i32x4::ZERO, across: i32x4::ZERO, down: i32x4::ZERO };
    let mut moments = Moments::default();
    for (v, &[first, end]) in (top..).zip(rows) {
        let next = if !in_steps {
            first
        } else if tracer.weights == Weights::NEUTRAL {
            block.add_row(tracer, limits, [left, top], v, first..end, white_chroma_of_eight)
        } else {
            let chroma = |pixels| chroma_of_eight(pixels, tracer.weights);
            block.add_row(tracer, limits, [left, top], v, first..end, chroma)
        };
        // The last pixels before the image's edge; things larger than discs are.
        let rest = tracer.frame.row(v).get(3 * next..3 * end).unwrap_or_default();
        for (u, pixel) in (next..).zip(rest.chunks_exact(3)) {
            let chroma = tracer.colour.sign() * chroma::<RED>([pixel[0], pixel[1], pixel[2]], tracer.weights);
            let weight = i64::from(chroma.clamp(limits[0], limits[1]) - limits[0]);
            moments.sum += weight;
            moments.across += weight * u as i64;
            moments.down += weight * v as i64;
        }
    }
    let total = |lanes: i32x4| lanes.to_array().map(i64::from).iter().sum::<i64>();
    let sum = total(block.sum);
    moments.sum += sum;
    moments.across += total(block.across) + sum * left as i64;
    moments.down += total(block.down) + sum * top as i64;
    moments
}

/// Sums in lanes, columns and rows counted from a corner.
struct Block {
    sum: i32x4,
    across: i32x4,
    down: i32x4,
}

impl Block {
    /// Adds the pixels of a row as far as a step can read; gives the first column that is left.
    fn add_row<const RED: usize>(
        &mut self,
        tracer: &Tracer<'_, RED>,
        limits: [i32; 2],
        corner: [usize; 2],
        v: usize,
        columns: Range<usize>,
        chroma: impl Fn([i16x8; 3]) -> i16x8,
    ) -> usize {
        let [low, high] = limits.map(|limit| i16x8::splat(limit as i16));
        let sign = i16x8::splat(tracer.colour.sign() as i16);
        let down = i16x8::splat((v - corner[1]) as i16);
        let row = tracer.frame.row(v);
        let mut first = columns.start;
        while first < columns.end
            && let Some(bytes) = row.get(3 * first..).and_then(|rest| rest.first_chunk::<READ>())
        {
            let count = (columns.end - first).min(STEP);
            let picked = 3 * (STEP - count);
            let start = i16x8::splat((first - corner[0]) as i16);
            for third in [0, LANES, 2 * LANES] {
                let from = |at: usize| i16x8::from_u8x16_low(u8x16::new(chunk(&bytes[third + at..])));
                let chroma = sign * chroma([from(RED), from(1), from(2 - RED)]);
                let pick = i16x8::new(chunk(&PICK[picked + third..]));
                let weight = (chroma.max(low).min(high) - low) & pick;
                let column = i16x8::new(chunk(&COLUMN[third..])) + start;
                self.sum += weight.dot(i16x8::ONE);
                self.across += weight.dot(column);
                self.down += weight.dot(down);
            }
            first += count;
        }
        first.min(columns.end)
    }
}

fn chunk<T: Copy + Default, const N: usize>(slice: &[T]) -> [T; N] {
    slice.first_chunk().copied().unwrap_or([T::default(); N])
}

#[cfg(test)]
mod tests {
    use super::super::chroma::Colour;
    use super::super::frame::{ChannelOrder, Frame};
    use super::*;

    const WIDTH: usize = 61;
    const HEIGHT: usize = 40;

    /// Bytes without order (a linear congruence), rows padded.
    fn bytes(step: usize) -> Vec<u8> {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        (0..step * HEIGHT).map(|_| next()).collect()
    }

    fn one_by_one<const RED: usize>(
        tracer: &Tracer<'_, RED>,
        limits: [i32; 2],
        top: usize,
        rows: &[[usize; 2]],
    ) -> Moments {
        let mut moments = Moments::default();
        for (v, row) in (top..).zip(rows) {
            for u in row[0]..row[1] {
                let weight = i64::from(tracer.chroma(u, v).clamp(limits[0], limits[1]) - limits[0]);
                moments.sum += weight;
                moments.across += weight * u as i64;
                moments.down += weight * v as i64;
            }
        }
        moments
    }

    fn check<const RED: usize>(order: ChannelOrder, weights: Weights, top: usize, rows: &[[usize; 2]]) {
        let step = 3 * WIDTH + 5;
        let bytes = bytes(step);
        let frame = Frame { width: WIDTH, height: HEIGHT, step, order, bytes: &bytes };
        for colour in [Colour::Yellow, Colour::Blue] {
            let tracer = Tracer::<RED> { frame, colour, weights, longest: 0 };
            for limits in [[-40, 200], [-510, 510], [100, 101]] {
                let expected = one_by_one(&tracer, limits, top, rows);
                assert!(expected.sum > 0, "nothing to compare");
                assert_eq!(moments(&tracer, limits, top, rows), expected, "{colour:?} {order:?} {limits:?} {rows:?}");
            }
        }
    }

    #[test]
    fn steps_give_what_pixels_give_one_by_one() {
        let all_lengths: Vec<[usize; 2]> = (0..HEIGHT).map(|v| [v / 2, v / 2 + v]).collect();
        let at_the_edge: Vec<[usize; 2]> = (0..20).map(|v| [WIDTH - 1 - v, WIDTH]).collect();
        let with_empty_rows = [[7, 7], [3, 30], [9, 5], [0, 1]];
        let (white, lamp) = (Weights::NEUTRAL, Weights { red: 41, blue: 140 });
        for (top, rows) in [(0, &all_lengths[..]), (20, &at_the_edge), (36, &with_empty_rows)] {
            check::<0>(ChannelOrder::Rgb, white, top, rows);
            check::<2>(ChannelOrder::Bgr, white, top, rows);
            check::<2>(ChannelOrder::Bgr, lamp, top, rows);
        }
    }

    #[test]
    fn nothing_overflows_in_the_widest_thing() {
        let (width, height) = (WIDEST, WIDEST);
        let bytes = [0, 0, 255].repeat(width * height);
        let frame = Frame { width, height, step: 3 * width, order: ChannelOrder::Rgb, bytes: &bytes };
        // The strongest weights that there are (balance.rs).
        let weights = Weights { red: 107, blue: 229 };
        let tracer = Tracer::<0> { frame, colour: Colour::Blue, weights, longest: 0 };
        let most = tracer.chroma(0, 0);
        // An eighth and seven eighths of the contrast between the strongest yellow and blue.
        let limits = [-681 + (most + 681) / 8, most - (most + 681) / 8];
        let rows = vec![[0, width]; height];
        assert_eq!(moments(&tracer, limits, 0, &rows), one_by_one(&tracer, limits, 0, &rows));
    }
}
