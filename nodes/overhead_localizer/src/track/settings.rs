//! What the tracker must know of the robots.

use super::filter::Motion;
use trench_optics::{Pad, Pose2};

/// One robot that carries a pad.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Its name.
    pub name: String,
    /// Where it stands at the start, if that is known.
    pub start: Option<Pose2>,
}

/// How robots get their names where no place says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Names {
    /// By small turns of one robot after the other.
    Turns,
    /// Somebody says them; until then they are in doubt.
    Told,
    /// By the pads' x.
    Order,
}

/// Everything the tracker is told once.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The robots, ordered by name.
    pub robots: Vec<Robot>,
    /// Their pads.
    pub pad: Pad,
    /// How far a pair's spacing may be from the pad's, m.
    pub spacing_tolerance: f64,
    /// Standard deviation of a disc's measured centre along each axis, m.
    pub disc_sigma: f64,
    /// Standard deviations of noise added to measured poses (x m, y m, heading rad), zero for none.
    pub added_sigma: [f64; 3],
    /// How long an unseen robot is carried forward, s; then it is lost.
    pub hold: f64,
    /// How robots move.
    pub motion: Motion,
    /// How doubts about names end.
    pub names: Names,
}

impl Settings {
    /// Standard deviation of the centres that [`crate::vision`] finds, m: a sixtieth of a pixel of the test bed's camera.
    pub const FOUND_SIGMA: f64 = 5e-5;

    /// For these robots, everything else as on the test bed.
    #[must_use]
    pub fn new(robots: Vec<Robot>) -> Self {
        Self {
            robots,
            pad: Pad::NOMINAL,
            spacing_tolerance: 0.005,
            disc_sigma: Self::FOUND_SIGMA,
            added_sigma: [0.0; 3],
            hold: 0.5,
            motion: Motion::default(),
            names: Names::Order,
        }
    }
}
