//! The colour of the light, and what takes it out again.
//!
//! Most of a picture is floor, robots and other grey things: the median of red over green and of blue over green is the
//! light's. Pixels that are cut off at 255 say nothing of it, and dark ones little. What is found is kept within the colours
//! that lamps and daylight have, and followed slowly: a hand before the camera is no sunset.

use super::frame::{ChannelOrder, Frame};

/// Weights of red and blue that make grey grey; green's is [`UNIT`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Weights {
    pub(super) red: i32,
    pub(super) blue: i32,
}

/// The colour of the light in a picture, as the detector takes it out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Light(Weights);

impl Light {
    /// Of one picture alone.
    #[must_use]
    pub fn of(frame: Frame<'_>) -> Self {
        let mut balance = Balance::default();
        Self(match frame.order {
            ChannelOrder::Rgb => balance.look::<0>(frame),
            ChannelOrder::Bgr => balance.look::<2>(frame),
        })
    }

    /// A pixel (red, green, blue) as it would be in white light.
    #[must_use]
    pub fn take_out(self, [red, green, blue]: [u8; 3]) -> [u8; 3] {
        let white = |value: u8, weight: i32| (i32::from(value) * weight / UNIT).min(255) as u8;
        [white(red, self.0.red), green, white(blue, self.0.blue)]
    }

    /// What red and blue are multiplied by.
    #[must_use]
    pub fn gains(self) -> [f64; 2] {
        [self.0.red, self.0.blue].map(|weight| f64::from(weight) / f64::from(UNIT))
    }
}

impl From<Weights> for Light {
    fn from(weights: Weights) -> Self {
        Self(weights)
    }
}

/// A weight of one.
pub(super) const UNIT: i32 = 64;

impl Weights {
    pub(super) const NEUTRAL: Self = Self { red: UNIT, blue: UNIT };

    /// The largest weight of a channel, whose noise is largest too.
    pub(super) fn strongest(self) -> i32 {
        self.red.max(self.blue).max(UNIT)
    }
}

/// Every so many rows and columns a pixel is looked at.
const STRIDE: [usize; 2] = [24, 16];
/// Values cut off, and values too dark for their ratio to be told.
const USABLE: std::ops::RangeInclusive<u8> = 12..=249;
/// Bins of value / (value + green): a ratio of one lies in the middle.
const BINS: usize = 256;
/// Fewer pixels are no floor.
const FEWEST: u32 = 10;
/// Light between 2,000 K and 10,000 K for a camera balanced for any of it: ratios to green.
const RED: [f64; 2] = [0.6, 2.2];
const BLUE: [f64; 2] = [0.28, 1.9];
/// Light that is white to so much needs no correction: the camera's own balance is as good.
const WHITE: f64 = 0.07;
/// The part of a new estimate that is taken over in each frame.
const FOLLOW: f64 = 0.1;

/// Follows the light from frame to frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Balance {
    /// Red and blue over green, of grey.
    ratios: Option<[f64; 2]>,
}

impl Balance {
    /// Looks at a frame and gives the weights for it. Red and blue are the bytes at `RED_BYTE` and `2 - RED_BYTE`.
    pub(super) fn look<const RED_BYTE: usize>(&mut self, frame: Frame<'_>) -> Weights {
        if let Some(seen) = estimate::<RED_BYTE>(frame) {
            let follow = |before: f64, now: f64| before + FOLLOW * (now - before);
            self.ratios = Some(match self.ratios {
                Some([red, blue]) => [follow(red, seen[0]), follow(blue, seen[1])],
                None => seen,
            });
        }
        self.weights()
    }

    /// For frames in the light seen so far.
    pub(super) fn weights(&self) -> Weights {
        match self.ratios {
            Some([red, blue]) if (red - 1.0).abs() > WHITE || (blue - 1.0).abs() > WHITE => {
                let weight = |ratio: f64| (f64::from(UNIT) / ratio + 0.5) as i32;
                Weights { red: weight(red), blue: weight(blue) }
            }
            _ => Weights::NEUTRAL,
        }
    }
}

fn estimate<const RED_BYTE: usize>(frame: Frame<'_>) -> Option<[f64; 2]> {
    let (mut reds, mut blues) = ([0_u32; BINS], [0_u32; BINS]);
    let (mut all, mut usable) = (0_u32, 0_u32);
    for v in (STRIDE[0] / 2..frame.height).step_by(STRIDE[0]) {
        frame.call_for(0..frame.width, v + STRIDE[0]..v + STRIDE[0] + 1);
        for pixel in frame.row(v).chunks_exact(3 * STRIDE[1]) {
            all += 1;
            let (red, green, blue) = (pixel[RED_BYTE], pixel[1], pixel[2 - RED_BYTE]);
            if ![red, green, blue].iter().all(|value| USABLE.contains(value)) {
                continue;
            }
            usable += 1;
            let bin = |value: u8| (BINS - 1) * usize::from(value) / (usize::from(value) + usize::from(green));
            reds[bin(red)] += 1;
            blues[bin(blue)] += 1;
        }
    }
    if usable < FEWEST || all == 0 {
        return None;
    }
    let ratio = |bins: &[u32; BINS], [low, high]: [f64; 2]| {
        let mut before = 0;
        let median = bins.iter().position(|count| {
            before += count;
            2 * before >= usable
        });
        let part = (median.unwrap_or(BINS / 2) as f64 + 0.5) / (BINS - 1) as f64;
        (part / (1.0 - part)).clamp(low, high)
    };
    Some([ratio(&reds, RED), ratio(&blues, BLUE)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(bytes: &[u8]) -> Frame<'_> {
        Frame { width: 320, height: 240, step: 960, order: ChannelOrder::Rgb, bytes }
    }

    #[test]
    fn grey_in_lamp_light_becomes_grey_and_white_light_stays() {
        let check = |grey: [u8; 3], expected: Option<[f64; 2]>| {
            let weights = Balance::default().look::<0>(frame(&grey.repeat(320 * 240)));
            let expected = expected.map_or(Weights::NEUTRAL, |[red, blue]| Weights {
                red: (64.0 / red + 0.5) as i32,
                blue: (64.0 / blue + 0.5) as i32,
            });
            assert!(
                (weights.red - expected.red).abs() <= 1 && (weights.blue - expected.blue).abs() <= 2,
                "{weights:?}"
            );
        };
        check([150, 150, 145], None);
        check([200, 128, 60], Some([1.56, 0.47]));
        check([120, 140, 170], Some([0.857, 1.21]));
        // Nothing to judge by, and light that is none.
        check([255, 255, 196], None);
        check([3, 3, 3], None);
        check([20, 200, 20], Some([0.6, 0.28]));
    }

    #[test]
    fn the_light_is_taken_out_of_grey() {
        let lamp = [200, 128, 60];
        let white = Light::of(frame(&lamp.repeat(320 * 240))).take_out(lamp);
        assert!(white[0].abs_diff(128) < 4 && white[1] == 128 && white[2].abs_diff(128) < 4, "{white:?}");
        let grey = [150, 150, 145];
        assert_eq!(Light::of(frame(&grey.repeat(320 * 240))).take_out(grey), grey);
    }

    #[test]
    fn it_follows_slowly() {
        let (white, lamp) = ([150, 150, 145].repeat(320 * 240), [200, 128, 60].repeat(320 * 240));
        let mut balance = Balance::default();
        balance.look::<0>(frame(&white));
        assert!(balance.look::<0>(frame(&lamp)).blue < 75);
        let mut last = Weights::NEUTRAL;
        for _ in 0..60 {
            last = balance.look::<0>(frame(&lamp));
        }
        assert!((last.red - 41).abs() <= 1 && (last.blue - 136).abs() <= 3, "{last:?}");
    }
}
