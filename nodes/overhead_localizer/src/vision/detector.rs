//! All discs of a frame.

mod complete;

use super::balance::{Balance, Light, UNIT, Weights};
use super::blob::Tracer;
use super::centroid;
use super::chroma::{Classifier, Colour, ColourLimits};
use super::faint::{self, Faint};
use super::frame::{ChannelOrder, Frame};
use super::looks::{Look, looks};
use super::rim;
use nalgebra::Point3;
use trench_optics::{Camera, Pad, Pixel};

/// A disc in the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Yellow or blue.
    pub colour: Colour,
    /// Its centre of area.
    pub centre: Pixel,
    /// pixel^2
    pub area: f64,
    /// 0..1: how well its area fits, and its area to its extent.
    pub confidence: f64,
}

/// How large a disc appears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expectation {
    /// Along a row, pixels.
    pub width: f64,
    /// Along a column, pixels.
    pub height: f64,
    /// From one disc of a pad to the other, in diameters.
    pub spacing: f64,
}

impl Expectation {
    /// The discs of `pad` below the middle of the camera's view; None where the camera sees no pad there.
    #[must_use]
    pub fn new(camera: &Camera, pad: &Pad) -> Option<Self> {
        let mount = camera.mount();
        let scale = camera.pixels_per_metre(Point3::new(mount.x, mount.y, pad.height))?;
        // The reach of a circle's image along an axis is the length of that row of the derivative.
        let [width, height] = [0, 1].map(|axis| pad.disc_diameter * scale.row(axis).norm());
        Some(Self { width, height, spacing: pad.disc_spacing / pad.disc_diameter })
    }

    /// Half axes, pixels.
    #[must_use]
    pub fn half(&self) -> [f64; 2] {
        [0.5 * self.width, 0.5 * self.height]
    }

    fn area(&self) -> f64 {
        std::f64::consts::FRAC_PI_4 * self.width * self.height
    }
}

/// Sizes between these fractions of the expected one can be a disc's: lens, tilt, blur and light change them.
const SMALLEST: f64 = 0.7;
const LARGEST: f64 = 1.35;
/// More discs than any team has: a frame full of colour must not take for ever.
const MOST_DISCS: usize = 256;

/// A disc's area is this part of that of the ellipse in its extent, or it has holes, corners or tails.
const ROUND: [f64; 2] = [0.7, 1.25];

/// Below this contrast of 510 a disc hardly stands out.
const FAINT: i32 = 130;

/// So far a faint disc's centre may be from where its chroma has it, in radii.
const NEAR: f64 = 0.35;
/// With less scatter than this nothing lies over a disc: a cable adds twice as much.
const CLEAR: f64 = 0.2;

/// A disc's pixels, and those around it that it is told from, end within so many diameters of a first look at it.
const AROUND: f64 = 1.3;

/// Above this confidence a disc is seen whole.
const CERTAIN: f64 = 0.8;

/// A disc as it was found.
#[derive(Debug, Clone, Copy)]
struct Found {
    disc: Disc,
    /// Nothing lies over it, as far as one disc tells; or its pad was measured as a whole.
    is_whole: bool,
}

/// Finds discs; keeps nothing from frame to frame but the colour of the light.
#[derive(Debug, Clone)]
pub struct Detector {
    classifier: Classifier,
    expectation: Expectation,
    stride: usize,
    balance: Balance,
    /// Whether discs come in pairs.
    paired: bool,
}

impl Detector {
    /// For discs of the expected size and the colours within the limits.
    #[must_use]
    pub fn new(limits: &ColourLimits, expectation: Expectation) -> Self {
        // Two looks across the smallest disc.
        let stride = (0.4 * expectation.width.min(expectation.height)) as usize;
        let (classifier, balance) = (Classifier::new(limits), Balance::default());
        Self { classifier, expectation, stride: stride.max(1), balance, paired: true }
    }

    /// For discs that stand alone: none is looked for where a partner would be.
    #[must_use]
    pub fn of_single_discs(self) -> Self {
        Self { paired: false, ..self }
    }

    /// Puts the discs of `frame` into `discs`, in the order of their topmost look. Discs cut by the image's edge are left
    /// out: their centre is not where it seems.
    pub fn detect(&mut self, frame: Frame<'_>, discs: &mut Vec<Disc>) {
        let mut found = Vec::new();
        match frame.order {
            ChannelOrder::Rgb => {
                let weights = self.balance.look::<0>(frame);
                self.scan::<0>(frame, weights, &mut found);
                self.complete_pairs::<0>(frame, weights, &mut found);
            }
            ChannelOrder::Bgr => {
                let weights = self.balance.look::<2>(frame);
                self.scan::<2>(frame, weights, &mut found);
                self.complete_pairs::<2>(frame, weights, &mut found);
            }
        }
        discs.clear();
        discs.extend(found.into_iter().map(|found| found.disc));
    }

    fn complete_pairs<const RED: usize>(&self, frame: Frame<'_>, weights: Weights, found: &mut Vec<Found>) {
        if self.paired {
            self.complete::<RED>(frame, weights, found);
        }
    }

    /// The colour of every pixel of a frame, row by row, in the light of the frame that was looked at last: 0 none, 1 yellow, 2 blue.
    /// For those who want to see what the limits cover; finding discs looks at few pixels only.
    pub fn cover(&self, frame: Frame<'_>, colours: &mut Vec<u8>) {
        colours.clear();
        match frame.order {
            ChannelOrder::Rgb => self.cover_with::<0>(frame, colours),
            ChannelOrder::Bgr => self.cover_with::<2>(frame, colours),
        }
    }

    fn cover_with<const RED: usize>(&self, frame: Frame<'_>, colours: &mut Vec<u8>) {
        let weights = self.balance.weights();
        let number = |pixel: &[u8]| match self.classifier.classify::<RED>([pixel[0], pixel[1], pixel[2]], weights) {
            Some(Colour::Yellow) => 1,
            Some(Colour::Blue) => 2,
            None => 0,
        };
        for v in 0..frame.height {
            colours.extend(frame.row(v).chunks_exact(3).map(number));
        }
    }

    /// The colour of the light, as the frames so far tell it.
    #[must_use]
    pub fn light(&self) -> Light {
        self.balance.weights().into()
    }

    fn scan<const RED: usize>(&self, frame: Frame<'_>, weights: Weights, found: &mut Vec<Found>) {
        let reach = [self.expectation.width, self.expectation.height].map(|size| (AROUND * size) as usize);
        for Look { colour, u, v } in looks::<RED>(self.classifier, frame, weights, self.stride, reach) {
            if !self.is_known(found, colour, u, v)
                && let Some(one) = self.disc_around::<RED>(frame, colour, weights, [u, v])
                && !self.is_known(found, colour, one.disc.centre.u as usize, one.disc.centre.v as usize)
            {
                found.push(one);
                if found.len() == MOST_DISCS {
                    return;
                }
            }
        }
    }

    /// Whether a pixel belongs to a disc already found.
    fn is_known(&self, found: &[Found], colour: Colour, u: usize, v: usize) -> bool {
        let reach = 0.6 * self.expectation.width.max(self.expectation.height);
        found.iter().any(|Found { disc, .. }| {
            disc.colour == colour
                && (disc.centre.u - u as f64).abs() < reach
                && (disc.centre.v - v as f64).abs() < reach
        })
    }

    fn disc_around<const RED: usize>(
        &self,
        frame: Frame<'_>,
        colour: Colour,
        weights: Weights,
        [u, v]: [usize; 2],
    ) -> Option<Found> {
        let expected = self.expectation;
        let longest = (LARGEST * expected.width.max(expected.height)) as usize;
        let tracer = Tracer::<RED> { frame, colour, weights, longest };
        // One pixel may be noise; nine are not.
        if self.classifier.classify::<RED>(tracer.mean_pixel(u, v), weights) != Some(colour) {
            return None;
        }
        match self.whole(&tracer, [u, v]) {
            Some(disc) if disc.confidence > CERTAIN => Some(Found { disc, is_whole: true }),
            // Something may lie over it: then its centre of area is not its centre.
            unsure => self.hidden(&tracer, [u, v]).or(unsure.map(|disc| Found { disc, is_whole: false })),
        }
    }

    /// A disc that is seen whole.
    fn whole<const RED: usize>(&self, tracer: &Tracer<'_, RED>, [u, v]: [usize; 2]) -> Option<Disc> {
        let (expected, frame) = (self.expectation, tracer.frame);
        let extent = tracer.extent(u, v)?;
        let fits = |[first, last]: [usize; 2], size: f64, expected: f64| {
            let ratio = (last - first + 1) as f64 / expected;
            // A run that reaches the image's edge may go on outside.
            (SMALLEST..LARGEST).contains(&ratio) && first > 0 && (last as f64) < size - 1.0
        };
        if !fits(extent.columns, frame.width as f64, expected.width)
            || !fits(extent.rows, frame.height as f64, expected.height)
        {
            return None;
        }
        let measured = centroid::measure(tracer, extent)?;
        let ratio = measured.area / expected.area();
        let side = |[first, last]: [usize; 2]| (last - first + 1) as f64;
        let round = measured.area / (std::f64::consts::FRAC_PI_4 * side(extent.columns) * side(extent.rows));
        let fits = (SMALLEST..LARGEST).contains(&ratio) && (ROUND[0]..ROUND[1]).contains(&round);
        let half = expected.half();
        let is_faint = is_faint(measured.contrast, tracer.weights);
        let near = |found: &Faint| {
            let [across, down] = [found.centre.u - measured.centre.u, found.centre.v - measured.centre.v];
            libm::hypot(across / half[0], down / half[1]) < NEAR
        };
        let faint = if is_faint { faint::measure(tracer, measured.centre, half).filter(near) } else { None };
        fits.then(|| Disc {
            colour: tracer.colour,
            centre: faint.map_or(measured.centre, |faint| faint.centre),
            area: measured.area,
            confidence: ratio.min(1.0 / ratio) * round.min(1.0 / round),
        })
    }

    /// A disc that something lies over in part, away from the image's edge.
    fn hidden<const RED: usize>(&self, tracer: &Tracer<'_, RED>, place: [usize; 2]) -> Option<Found> {
        let half = self.expectation.half();
        let rim = rim::find(tracer, place, half)?;
        let whole = tracer.frame.holds(rim.centre, half);
        // Where nothing lies over it, colours were washed out: then all of its pixels tell more than its rim.
        let faint = faint::measure(tracer, rim.centre, half).filter(|faint| faint.scatter < CLEAR);
        whole.then(|| Found {
            disc: Disc {
                colour: tracer.colour,
                centre: faint.map_or(rim.centre, |faint| faint.centre),
                area: rim.size * rim.size * self.expectation.area(),
                confidence: 0.5 * rim.seen,
            },
            is_whole: faint.is_some(),
        })
    }
}

/// Whether a disc of this chroma hardly stands out: what lifts a weak channel lifts its noise.
fn is_faint(contrast: i32, weights: Weights) -> bool {
    contrast * UNIT < FAINT * weights.strongest()
}
