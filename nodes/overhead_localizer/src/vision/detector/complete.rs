//! What the discs of a frame tell of each other: where a pad's other disc must be, and how both lie below what covers them.

use super::super::balance::Weights;
use super::super::blob::Tracer;
use super::super::frame::Frame;
use super::super::{pad_fit, partner};
use super::{Detector, Disc, Expectation, Found, MOST_DISCS, is_faint};
use trench_optics::Pixel;

/// So many discs without a partner are looked at again: a frame full of colour must not take for ever.
const MOST_PARTNERS: usize = 32;
/// A partner has this part of the chroma that is asked of a disc without one.
const WASHED_OUT: f64 = 0.5;

/// Discs whose distance differs from the pad's spacing by less than this part of it can be one's; more where something lies
/// over one of them.
const NEIGHBOUR: f64 = 0.1;
const HIDDEN_NEIGHBOUR: f64 = 0.2;
/// Two discs that are seen whole agree with the spacing to this part of it; otherwise something covers an edge.
const EXACT: f64 = 0.055;

impl Detector {
    /// Adds the discs that others tell of, those of pads of which one disc was found; and where something lies over a pad,
    /// measures both of its discs together.
    pub(super) fn complete<const RED: usize>(&self, frame: Frame<'_>, weights: Weights, found: &mut Vec<Found>) {
        let Expectation { width, height, spacing } = self.expectation;
        let distance2 = |a: &Found, b: &Found| {
            let u = (a.disc.centre.u - b.disc.centre.u) / (spacing * width);
            let v = (a.disc.centre.v - b.disc.centre.v) / (spacing * height);
            u * u + v * v
        };
        let misfit = |a: &Found, b: &Found| (libm::sqrt(distance2(a, b)) - 1.0).abs();
        let exact = (1.0 - EXACT) * (1.0 - EXACT)..(1.0 + EXACT) * (1.0 + EXACT);
        let mut looks = 0;
        for index in 0..found.len() {
            let Some(&one) = found.get(index) else { break };
            if looks == MOST_PARTNERS || found.len() == MOST_DISCS {
                break;
            }
            let is_other = |it: &Found| it.disc.colour != one.disc.colour;
            let is_sure = |it: &Found| it.is_whole && is_other(it) && exact.contains(&distance2(&one, it));
            if one.is_whole && found.iter().any(is_sure) {
                continue;
            }
            let others = found.iter().enumerate().filter(|(_, it)| is_other(it));
            let nearest = others.map(|(other, it)| (other, misfit(&one, it))).min_by(|a, b| a.1.total_cmp(&b.1));
            looks += 1;
            let limit = if one.is_whole { NEIGHBOUR } else { HIDDEN_NEIGHBOUR };
            if let Some((other, _)) = nearest.filter(|(_, misfit)| *misfit < limit)
                && let Some(pad) = self.covered::<RED>(frame, weights, &one.disc, found[other].disc.centre)
            {
                (found[index], found[other]) = (pad[0], pad[1]);
            } else if nearest.is_none_or(|(_, misfit)| misfit >= NEIGHBOUR) {
                self.find_partner::<RED>(frame, weights, index, found);
            }
        }
    }

    /// Adds the disc whose partner is `found[index]`, if it is seen or enough of it is.
    fn find_partner<const RED: usize>(&self, frame: Frame<'_>, weights: Weights, index: usize, found: &mut Vec<Found>) {
        let Some(&Found { disc: one, .. }) = found.get(index) else { return };
        let Expectation { width, height, spacing } = self.expectation;
        let tracer = Tracer::<RED> { frame, colour: one.colour.other(), weights, longest: 0 };
        let spacing = [spacing * width, spacing * height];
        let places = partner::places(&tracer, one.centre, spacing, self.expectation.half());
        let is_new = |it: &Disc| !self.is_known(found, it.colour, it.centre.u as usize, it.centre.v as usize);
        let at = |place: &Pixel| self.covered::<RED>(frame, weights, &one, *place);
        if let Some(disc) = self.partner(&tracer, &places, &one, spacing).filter(is_new) {
            found.push(Found { disc, is_whole: true });
        } else if let Some(pad) = places.iter().find_map(at).filter(|pad| is_new(&pad[1].disc)) {
            found[index] = pad[0];
            found.push(pad[1]);
        }
    }

    /// The pad of a disc whose partner is near `place`, by the rims of both.
    fn covered<const RED: usize>(
        &self,
        frame: Frame<'_>,
        weights: Weights,
        of: &Disc,
        place: Pixel,
    ) -> Option<[Found; 2]> {
        let (spacing, half) = (self.expectation.spacing, self.expectation.half());
        let colours = [of.colour, of.colour.other()];
        let tracers = colours.map(|colour| Tracer::<RED> { frame, colour, weights, longest: 0 });
        let pad = pad_fit::fit([&tracers[0], &tracers[1]], [of.centre, place], half, spacing)?;
        let is_coloured = [0, 1]
            .into_iter()
            .all(|index| self.classifier.classify::<RED>(pad.colours[index], weights) == Some(colours[index]));
        let is_inside = pad.centres.iter().all(|centre| frame.holds(*centre, half));
        let disc = |index: usize| Disc {
            colour: colours[index],
            centre: pad.centres[index],
            area: pad.size * pad.size * self.expectation.area(),
            confidence: 0.5 * pad.seen[index],
        };
        // Rims of faint discs are noise: all of their pixels tell more.
        let is_clear = pad.contrast.iter().all(|contrast| !is_faint(*contrast, weights));
        (is_clear && is_coloured && is_inside).then(|| [0, 1].map(|index| Found { disc: disc(index), is_whole: true }))
    }

    /// The disc of the tracer's colour at one of `places` that tells from its ground as a partner of `of` does.
    fn partner<const RED: usize>(
        &self,
        tracer: &Tracer<'_, RED>,
        places: &[Pixel],
        of: &Disc,
        spacing: [f64; 2],
    ) -> Option<Disc> {
        let Tracer { colour, weights, .. } = *tracer;
        let found = partner::find(tracer, places, of.centre, spacing, self.expectation.half())?;
        let is_coloured = self.classifier.admits::<RED>(colour, found.inside, found.outside, weights, WASHED_OUT);
        is_coloured.then(|| Disc {
            colour,
            centre: found.centre,
            area: self.expectation.area(),
            confidence: 0.5 * of.confidence * (1.0 - found.scatter),
        })
    }
}
