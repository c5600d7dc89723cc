//! A robot of whose pad one disc is hidden: the other one still tells where it is, for a while.
//!
//! One disc tells two of the three numbers of a pose. The third drifts with what the robot does, so that after
//! [`LONGEST`] it is lost like one that nobody sees.

use super::pairing::{MapDisc, Pair};
use super::tracker::Track;
use crate::vision::Colour;
use nalgebra::Point2;
use trench_optics::Pad;

/// How long one disc keeps a robot, s.
pub(super) const LONGEST: f64 = 2.0;
/// From where a disc is expected to where it is, m: far less than the 80 mm between discs of one colour of touching robots.
const GATE: f64 = 0.02;
/// A disc of a pair is the pair's own, m.
const SAME: f64 = 0.006;

/// Corrects the robots that `matched` no pair by discs that are left over.
pub(super) fn correct(
    tracks: &mut [Track],
    matched: &[Option<usize>],
    pairs: &[Pair],
    discs: &[MapDisc],
    pad: &Pad,
    sigma: f64,
) {
    let in_pair = |disc: &MapDisc| {
        let mut own = pairs.iter().map(|pair| pad.discs(pair.pose)[index(disc.colour)]);
        own.any(|place| (place - disc.position).norm() < SAME)
    };
    let loose: Vec<&MapDisc> = discs.iter().filter(|disc| !in_pair(disc)).collect();
    let expected: Vec<Option<[Point2<f64>; 2]>> =
        tracks.iter().map(|track| track.filter.as_ref().map(|filter| pad.discs(filter.state().pose))).collect();
    for (robot, track) in tracks.iter_mut().enumerate() {
        track.half_seen = false;
        if matched[robot].is_some() || track.in_doubt || track.unseen > LONGEST {
            continue;
        }
        let (Some(own), Some(filter)) = (expected[robot], &mut track.filter) else { continue };
        for colour in [Colour::Yellow, Colour::Blue] {
            let off = |place: &[Point2<f64>; 2], disc: &MapDisc| (place[index(colour)] - disc.position).norm();
            // A disc that another robot may have is nobody's.
            let is_own = |disc: &&&MapDisc| {
                let near = |other: &Option<[Point2<f64>; 2]>| other.is_some_and(|place| off(&place, disc) < GATE);
                disc.colour == colour
                    && off(&own, disc) < GATE
                    && expected.iter().filter(|other| near(other)).count() == 1
            };
            let mut candidates = loose.iter().filter(is_own);
            if let (Some(disc), None) = (candidates.next(), candidates.next()) {
                let along = if colour == Colour::Yellow { 0.5 } else { -0.5 } * pad.disc_spacing;
                filter.update_point(along, disc.position, sigma);
                track.half_seen = true;
            }
        }
    }
}

/// The place of a colour in [`Pad::discs`].
fn index(colour: Colour) -> usize {
    match colour {
        Colour::Yellow => 0,
        Colour::Blue => 1,
    }
}
