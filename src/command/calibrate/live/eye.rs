//! What the localizer sees in a frame: its own detector, its own limits.

use super::shot::Shot;
use image::RgbImage;
use trench_calibrate::{Colours, Samples};
use trench_harness::vision::{Colour, ColourLimits, Detector, Disc, Expectation, Light};
use trench_view::colours::Which;

/// Looks at frames of one camera.
pub(super) struct Eye {
    size: [usize; 2],
    expectation: Expectation,
    detector: Detector,
}

/// What it saw.
#[derive(Debug, Clone, Default)]
pub(super) struct Seen {
    pub(super) discs: Vec<Disc>,
    /// Of each pixel: 0 none, 1 yellow, 2 blue.
    pub(super) cover: Vec<u8>,
}

/// Of a disc's half axes, so much is surely inside it.
const INSIDE: f64 = 0.6;
/// A click stands for the square of pixels this far around it, in half axes.
const CLICKED: f64 = 0.4;
/// What is nearer to a disc than so many diameters is no sample of the rest.
const NEAR: f64 = 2.0;
/// Every so many pixels and rows is a sample of the rest.
const STRIDE: usize = 7;

impl Eye {
    pub(super) fn new(size: [usize; 2], expectation: Expectation, limits: &Colours) -> Self {
        Self { size, expectation, detector: detector(expectation, limits) }
    }

    /// Half axes of a disc, pixels.
    pub(super) fn half(&self) -> [f64; 2] {
        self.expectation.half()
    }

    pub(super) fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Other limits from the next look on.
    pub(super) fn limit(&mut self, limits: &Colours) {
        self.detector = detector(self.expectation, limits);
    }

    pub(super) fn light(&self) -> Light {
        self.detector.light()
    }

    pub(super) fn look(&mut self, shot: &Shot) -> Seen {
        let (mut seen, mut room) = (Seen::default(), Vec::new());
        // Its size was checked when it was read.
        if let Ok(frame) = shot.frame(self.size, &mut room) {
            self.detector.detect(frame, &mut seen.discs);
            self.detector.cover(frame, &mut seen.cover);
        }
        seen
    }

    /// What a click in the middle of a disc tells; None outside the picture.
    pub(super) fn clicked(
        &self,
        picture: &RgbImage,
        which: Which,
        [u, v]: [f64; 2],
        discs: &[Disc],
    ) -> Option<Samples> {
        let reach = self.half().map(|half| (CLICKED * half).round());
        let pixels = self.pixels(picture, [u, v], reach, |_, _| true)?;
        let mut samples = Samples { rest: self.rest(picture, discs, &[[u, v]]), ..Samples::default() };
        match which {
            Which::Yellow => samples.yellow = pixels,
            Which::Blue => samples.blue = pixels,
        }
        Some(samples)
    }

    /// What the discs tell that were found.
    pub(super) fn found(&self, picture: &RgbImage, discs: &[Disc]) -> Samples {
        let mut samples = Samples { rest: self.rest(picture, discs, &[]), ..Samples::default() };
        let half = self.half().map(|half| INSIDE * half);
        for disc in discs {
            let round = |across: f64, down: f64| (across / half[0]).powi(2) + (down / half[1]).powi(2) <= 1.0;
            let pixels = self.pixels(picture, [disc.centre.u, disc.centre.v], half.map(f64::floor), round);
            match disc.colour {
                Colour::Yellow => samples.yellow.extend(pixels.unwrap_or_default()),
                Colour::Blue => samples.blue.extend(pixels.unwrap_or_default()),
            }
        }
        samples
    }

    /// Pixels up to `reach` around a place, in white light; None where some are outside the picture.
    fn pixels(
        &self,
        picture: &RgbImage,
        [u, v]: [f64; 2],
        reach: [f64; 2],
        wanted: impl Fn(f64, f64) -> bool,
    ) -> Option<Vec<[u8; 3]>> {
        let light = self.light();
        let [across, down] = reach.map(|reach| reach.max(1.0) as i64);
        let offsets = (-down..=down).flat_map(|row| (-across..=across).map(move |column| (column, row)));
        let pixel = |(column, row): (i64, i64)| {
            let place = |centre: f64, offset: i64| u32::try_from(centre.round() as i64 + offset).ok();
            Some(light.take_out(picture.get_pixel_checked(place(u, column)?, place(v, row)?)?.0))
        };
        offsets.filter(|(column, row)| wanted(*column as f64, *row as f64)).map(pixel).collect()
    }

    /// What is far from all discs and clicks.
    fn rest(&self, picture: &RgbImage, discs: &[Disc], clicks: &[[f64; 2]]) -> Vec<[u8; 3]> {
        let light = self.light();
        let near = self.half().map(|half| 2.0 * NEAR * half);
        let centres = || discs.iter().map(|disc| [disc.centre.u, disc.centre.v]).chain(clicks.iter().copied());
        let is_far = |u: u32, v: u32| {
            centres()
                .all(|[column, row]| (f64::from(u) - column).abs() > near[0] || (f64::from(v) - row).abs() > near[1])
        };
        let sampled = picture.enumerate_rows().step_by(STRIDE).flat_map(|(_, row)| row.step_by(STRIDE));
        sampled.filter(|(u, v, _)| is_far(*u, *v)).map(|(_, _, pixel)| light.take_out(pixel.0)).collect()
    }
}

fn detector(expectation: Expectation, limits: &Colours) -> Detector {
    let Colours { yellow, blue, minimum } = *limits;
    Detector::new(&ColourLimits { yellow_ratio: yellow, blue_ratio: blue, minimum }, expectation)
}
