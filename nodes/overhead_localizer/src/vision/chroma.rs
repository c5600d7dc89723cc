//! One number that tells yellow from blue: the opponent channel R + G - 2 B.
//!
//! It is zero on everything grey, linear in the colours (a pixel half covered by a disc has half the disc's chroma) and
//! proportional to the light; divided by the pixel's sum it does not depend on the light at all.

/// What a disc is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Colour {
    /// In front.
    Yellow,
    /// Behind.
    Blue,
}

impl Colour {
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
    /// Pads as the test bed's, light between a third of full and full.
    fn default() -> Self {
        Self { yellow_ratio: 0.45, blue_ratio: 0.45, minimum: 60.0 }
    }
}

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
    pub(super) fn classify<const RED: usize>(&self, pixel: [u8; 3]) -> Option<Colour> {
        let chroma = chroma::<RED>(pixel);
        if chroma.abs() < self.minimum {
            return None;
        }
        let (red, green, blue) = (i32::from(pixel[RED]), i32::from(pixel[1]), i32::from(pixel[2 - RED]));
        // Red, green and purple things differ in red and green; yellow and blue do not.
        if 2 * (red - green).abs() > chroma.abs() {
            return None;
        }
        let (colour, ratio) =
            if chroma > 0 { (Colour::Yellow, self.yellow_ratio) } else { (Colour::Blue, self.blue_ratio) };
        (256 * chroma.abs() > ratio * (red + green + blue)).then_some(colour)
    }
}

/// R + G - 2 B.
#[inline]
pub(super) fn chroma<const RED: usize>(pixel: [u8; 3]) -> i32 {
    i32::from(pixel[RED]) + i32::from(pixel[1]) - 2 * i32::from(pixel[2 - RED])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knows_the_pads_colours_in_any_light_and_nothing_else() {
        let classifier = Classifier::new(&ColourLimits::default());
        let check = |rgb: [u8; 3], expected| {
            assert_eq!(classifier.classify::<0>(rgb), expected, "{rgb:?}");
            assert_eq!(classifier.classify::<2>([rgb[2], rgb[1], rgb[0]]), expected, "{rgb:?} as bgr");
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
}
