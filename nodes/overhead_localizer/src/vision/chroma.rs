//! One number that tells yellow from blue: the opponent channel R + G - 2 B, of pixels whose grey is grey.
//!
//! It is zero on everything grey, linear in the colours (a pixel half covered by a disc has half the disc's chroma) and
//! proportional to the light; divided by the pixel's sum it does not depend on the light at all. The colour of the light is
//! taken out before ([`super::balance`]). Where a channel is cut off at 255 the chroma is less than it should be, and red and
//! green differ more: there less is asked for.

use super::balance::{UNIT, Weights};
use wide::{i16x8, i32x8};

/// What a disc is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Colour {
    /// In front.
    Yellow,
    /// Behind.
    Blue,
}

impl Colour {
    /// The colour of the pad's other disc.
    pub(super) fn other(self) -> Self {
        match self {
            Self::Yellow => Self::Blue,
            Self::Blue => Self::Yellow,
        }
    }

    /// The sign of this colour's chroma.
    pub(super) fn sign(self) -> i32 {
        match self {
            Self::Yellow => 1,
            Self::Blue => -1,
        }
    }
}

/// When a pixel counts as yellow or blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourLimits {
    /// Smallest R + G - 2 B of a yellow pixel as a fraction of R + G + B.
    pub yellow_ratio: f64,
    /// Smallest 2 B - R - G of a blue pixel as a fraction of R + G + B.
    pub blue_ratio: f64,
    /// Smallest absolute value of either, of 510: below, it is noise in a dark place.
    pub minimum: f64,
}

impl Default for ColourLimits {
    /// Pads as the test bed's, light between a third of nominal and three times as much.
    fn default() -> Self {
        Self { yellow_ratio: 0.45, blue_ratio: 0.45, minimum: 40.0 }
    }
}

/// From here on a channel may be cut off, of 255; JPEG leaves less than 255 of what was.
const MAYBE_CUT_OFF: u8 = 234;
/// From here on it is.
const CUT_OFF: u8 = 250;

/// The limits in integers, ratios in 1/256.
#[derive(Debug, Clone, Copy)]
pub(super) struct Classifier {
    yellow_ratio: i32,
    blue_ratio: i32,
    minimum: i32,
}

impl Classifier {
    pub(super) fn new(limits: &ColourLimits) -> Self {
        let scaled = |ratio: f64| (256.0 * ratio) as i32;
        Self {
            yellow_ratio: scaled(limits.yellow_ratio),
            blue_ratio: scaled(limits.blue_ratio),
            minimum: limits.minimum as i32,
        }
    }

    /// The colour of a pixel, if it has one. Red and blue are the bytes at `RED` and `2 - RED`.
    #[inline]
    pub(super) fn classify<const RED: usize>(&self, pixel: [u8; 3], weights: Weights) -> Option<Colour> {
        let chroma = chroma::<RED>(pixel, weights);
        if chroma.abs() < self.minimum {
            return None;
        }
        self.judge::<RED>(pixel, weights, chroma)
    }

    /// Whether what has these mean values on such a ground has at least `part` of the chroma that a disc of this colour has.
    pub(super) fn admits<const RED: usize>(
        &self,
        colour: Colour,
        inside: [f64; 3],
        outside: [f64; 3],
        weights: Weights,
        part: f64,
    ) -> bool {
        let [inside, outside] = [inside, outside].map(|mean| mean.map(|value| (value + 0.5) as u8));
        let own = colour.sign() * chroma::<RED>(inside, weights);
        let ground = colour.sign() * chroma::<RED>(outside, weights);
        let ratio = if colour == Colour::Yellow { self.yellow_ratio } else { self.blue_ratio };
        let sum = weighted(inside[RED], weights.red) / UNIT
            + i32::from(inside[1])
            + weighted(inside[2 - RED], weights.blue) / UNIT;
        f64::from(own - ground) >= part * f64::from(self.minimum)
            && f64::from(256 * own) >= part * f64::from(ratio * sum)
    }

    fn judge<const RED: usize>(&self, pixel: [u8; 3], weights: Weights, chroma: i32) -> Option<Colour> {
        let (raw_red, raw_blue) = (pixel[RED], pixel[2 - RED]);
        let (colour, ratio, weakest) = if chroma > 0 {
            (Colour::Yellow, self.yellow_ratio, raw_blue)
        } else {
            (Colour::Blue, self.blue_ratio, raw_red)
        };
        let is_cut_off = pixel.iter().any(|value| *value >= MAYBE_CUT_OFF);
        // The channel that a disc lacks is never bright: white in lamp light, cut off, is.
        if is_cut_off && weakest >= CUT_OFF {
            return None;
        }
        let (red, green) = (weighted(raw_red, weights.red) / UNIT, i32::from(pixel[1]));
        let blue = weighted(raw_blue, weights.blue) / UNIT;
        // Red, green and purple things differ in red and green; yellow and blue do not.
        let (difference, limit) = if is_cut_off { (10 * (red - green).abs(), 9) } else { (2 * (red - green).abs(), 1) };
        let excusable = is_cut_off && colour == Colour::Yellow && raw_red >= MAYBE_CUT_OFF && green > red;
        if difference > limit * chroma.abs() && !excusable {
            return None;
        }
        let ratio = if is_cut_off { ratio / 2 } else { ratio };
        (256 * chroma.abs() > ratio * (red + green + blue)).then_some(colour)
    }
}

/// R + G - 2 B of a pixel in white light.
#[inline]
pub(super) fn chroma<const RED: usize>(pixel: [u8; 3], weights: Weights) -> i32 {
    if weights == Weights::NEUTRAL {
        // The same number in few steps.
        return i32::from(pixel[RED]) + i32::from(pixel[1]) - 2 * i32::from(pixel[2 - RED]);
    }
    let (red, blue) = (weighted(pixel[RED], weights.red), weighted(pixel[2 - RED], weights.blue));
    (red + UNIT * i32::from(pixel[1]) - 2 * blue) / UNIT
}

/// A value in white light. One that is cut off is at least what it says; what lies between is weighted in between, so that
/// noise does not make it jump.
#[inline]
fn weighted(value: u8, weight: i32) -> i32 {
    // Sixteen steps, so that no pixel costs a division.
    let over = i32::from(value.saturating_sub(MAYBE_CUT_OFF).min(CUT_OFF - MAYBE_CUT_OFF));
    let raised = weight + (((weight.max(UNIT) - weight) * over) >> 4);
    i32::from(value) * raised
}

/// [`chroma`] of eight pixels in white light, given their red, green and blue.
#[inline]
pub(super) fn white_chroma_of_eight([red, green, blue]: [i16x8; 3]) -> i16x8 {
    red + green - blue - blue
}

/// [`chroma`] of eight pixels, given their red, green and blue.
#[inline]
pub(super) fn chroma_of_eight([red, green, blue]: [i16x8; 3], weights: Weights) -> i16x8 {
    let blue = weighted_eight(blue, weights.blue);
    let scaled = weighted_eight(red, weights.red) + green.widening_mul(i16x8::splat(UNIT as i16)) - blue - blue;
    // Division rounds towards zero, a shift downwards.
    let rounded = scaled + ((scaled >> 31) & i32x8::splat(UNIT - 1));
    i16x8::from_i32x8_truncate(rounded >> UNIT.trailing_zeros())
}

#[inline]
fn weighted_eight(value: i16x8, weight: i32) -> i32x8 {
    let [maybe, cut_off] = [MAYBE_CUT_OFF, CUT_OFF].map(i16::from);
    let over = (value - i16x8::splat(maybe)).max(i16x8::ZERO).min(i16x8::splat(cut_off - maybe));
    let raise = i16x8::splat((weight.max(UNIT) - weight) as i16);
    value.widening_mul(i16x8::splat(weight as i16) + ((raise * over) >> 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_pixels_have_the_chroma_of_each() {
        for weights in [Weights::NEUTRAL, Weights { red: 107, blue: 34 }, Weights { red: 29, blue: 229 }] {
            for green in 0..=255_u8 {
                for step in 0..32 {
                    let [red, blue]: [[u8; 8]; 2] = [97, 31].map(|by| {
                        std::array::from_fn(|lane| green.wrapping_mul(by).wrapping_add(8 * step + lane as u8))
                    });
                    let lanes = |values: [u8; 8]| i16x8::new(values.map(i16::from));
                    let pixels = [lanes(red), lanes([green; 8]), lanes(blue)];
                    let eight = chroma_of_eight(pixels, weights).to_array();
                    if weights == Weights::NEUTRAL {
                        assert_eq!(white_chroma_of_eight(pixels).to_array(), eight);
                    }
                    for lane in 0..8 {
                        let one = chroma::<0>([red[lane], green, blue[lane]], weights);
                        assert_eq!(i32::from(eight[lane]), one, "{weights:?} {} {green} {}", red[lane], blue[lane]);
                    }
                }
            }
        }
    }

    #[test]
    fn knows_the_pads_colours_in_any_light_and_nothing_else() {
        let classifier = Classifier::new(&ColourLimits::default());
        let check = |rgb: [u8; 3], expected| {
            let weights = Weights::NEUTRAL;
            assert_eq!(classifier.classify::<0>(rgb, weights), expected, "{rgb:?}");
            assert_eq!(classifier.classify::<2>([rgb[2], rgb[1], rgb[0]], weights), expected, "{rgb:?} as bgr");
        };
        check([235, 205, 45], Some(Colour::Yellow));
        check([80, 70, 15], Some(Colour::Yellow));
        check([35, 80, 200], Some(Colour::Blue));
        check([12, 27, 67], Some(Colour::Blue));
        for other in
            [[150; 3], [0; 3], [255; 3], [38, 38, 40], [172, 134, 98], [220, 30, 30], [30, 200, 40], [150, 20, 180]]
        {
            check(other, None);
        }
    }

    /// What the camera gives of a colour in this light.
    fn lit(rgb: [f64; 3], tint: [f64; 3], light: f64) -> [u8; 3] {
        [0, 1, 2].map(|channel| (rgb[channel] * tint[channel] * light).min(255.0) as u8)
    }

    #[test]
    fn knows_them_in_lamp_light_and_where_channels_are_cut_off() {
        let classifier = Classifier::new(&ColourLimits::default());
        for tint in [[1.57, 1.0, 0.45], [1.0, 1.0, 1.0], [0.885, 1.0, 1.24]] {
            let weight = |channel: usize| (64.0 / tint[channel] + 0.5) as i32;
            let weights = Weights { red: weight(0), blue: weight(2) };
            for step in 0..40 {
                let light = 0.3 * f64::powf(10.0, f64::from(step) / 39.0);
                let seen = |rgb| classifier.classify::<0>(lit(rgb, tint, light), weights);
                assert_eq!(seen([235.0, 205.0, 45.0]), Some(Colour::Yellow), "light {light}, {tint:?}");
                assert_eq!(seen([35.0, 80.0, 200.0]), Some(Colour::Blue), "light {light}, {tint:?}");
                for other in [[150.0, 150.0, 145.0], [38.0, 38.0, 40.0], [95.0; 3], [220.0, 30.0, 30.0]] {
                    assert_eq!(seen(other), None, "{other:?} in light {light}, {tint:?}");
                }
            }
        }
    }
}
