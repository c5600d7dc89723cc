//! Looks at a grid of pixels, too dense for a disc to fall through.

use super::balance::Weights;
use super::chroma::{Classifier, Colour};
use super::frame::Frame;

/// A pixel of the grid that has a colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    pub(super) colour: Colour,
    pub(super) u: usize,
    pub(super) v: usize,
}

/// The coloured pixels of a grid, row by row; `stride` pixels from one to the next; the pixels
/// that a disc is measured by are at most `reach` columns and rows from the first look at it.
///
/// Rows of pixels lie kilobytes apart in memory, and one that is read for the first time is waited for: so the next row of looks,
/// and what lies around the first look at something coloured, are called for ahead, and come while others are looked at.
pub(super) fn looks<const RED: usize>(
    classifier: Classifier,
    frame: Frame<'_>,
    weights: Weights,
    stride: usize,
    reach: [usize; 2],
) -> Vec<Look> {
    let mut looks: Vec<Look> = Vec::with_capacity(256);
    let mut row_before = 0;
    for v in (stride / 2..frame.height).step_by(stride) {
        let this_row = looks.len();
        frame.call_for(0..frame.width, v + stride..v + stride + 1);
        for (index, look) in frame.row(v).chunks_exact(3 * stride).enumerate() {
            if let Some(colour) = classifier.classify::<RED>([look[0], look[1], look[2]], weights) {
                let u = index * stride;
                if !looks[row_before..].iter().rev().any(|other| other.u.abs_diff(u) <= stride) {
                    let columns = u.saturating_sub(reach[0])..u + reach[0];
                    frame.call_for(columns, v.saturating_sub(stride)..v + reach[1]);
                }
                looks.push(Look { colour, u, v });
            }
        }
        row_before = this_row;
    }
    looks
}
