//! From one pixel inside a disc to the disc's extent.

use super::balance::Weights;
use super::chroma::{Colour, chroma};
use super::frame::Frame;

/// The box around a blob, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Extent {
    pub(super) columns: [usize; 2],
    pub(super) rows: [usize; 2],
}

/// Reads chroma of one sign around a place.
#[derive(Clone, Copy)]
pub(super) struct Tracer<'a, const RED: usize> {
    pub(super) frame: Frame<'a>,
    pub(super) colour: Colour,
    pub(super) weights: Weights,
    /// Longest run that can be a disc's, pixels.
    pub(super) longest: usize,
}

impl<const RED: usize> Tracer<'_, RED> {
    /// The extent of the disc around the seed at column `u` and row `v`, along the row and the column through its middle;
    /// None where it is larger than a disc.
    ///
    /// Runs through the seed find a point near the middle; there the disc's own chroma is measured, and runs at half of
    /// it end where the disc covers half a pixel.
    pub(super) fn extent(&self, u: usize, v: usize) -> Option<Extent> {
        let rough = self.chroma(u, v) / 2;
        let u = middle(self.run_in_row(u, v, rough)?);
        let v = middle(self.run_in_column(u, v, rough)?);
        let half = self.level(u, v) / 2;
        let u = middle(self.run_in_row(u, v, half)?);
        let rows = self.run_in_column(u, v, half)?;
        let columns = self.run_in_row(u, middle(rows), half)?;
        Some(Extent { columns, rows })
    }

    /// The mean chroma of the 3 x 3 pixels around a place.
    pub(super) fn level(&self, u: usize, v: usize) -> i32 {
        let around = |centre: usize| centre.saturating_sub(1)..centre + 2;
        around(v).flat_map(|row| around(u).map(move |column| self.chroma(column, row))).sum::<i32>() / 9
    }

    /// The mean of the 3 x 3 pixels around a place that is inside the image.
    pub(super) fn mean_pixel(&self, u: usize, v: usize) -> [u8; 3] {
        let (mut sum, mut count) = ([0_u32; 3], 0);
        for row in v.saturating_sub(1)..v + 2 {
            let pixels = self.frame.row(row);
            for pixel in
                pixels.get(3 * u.saturating_sub(1)..(3 * (u + 2)).min(pixels.len())).unwrap_or_default().chunks_exact(3)
            {
                sum = [0, 1, 2].map(|channel| sum[channel] + u32::from(pixel[channel]));
                count += 1;
            }
        }
        sum.map(|total| (total / count.max(1)) as u8)
    }

    /// Chroma in the direction of the colour; as good as none outside the image.
    #[inline]
    pub(super) fn chroma(&self, u: usize, v: usize) -> i32 {
        self.chroma_of(self.frame.row(v).get(3 * u..3 * u + 3))
    }

    /// [`Self::chroma`] of a pixel's bytes; none outside the image.
    #[inline]
    fn chroma_of(&self, pixel: Option<&[u8]>) -> i32 {
        match pixel {
            Some(&[a, b, c]) => self.colour.sign() * chroma::<RED>([a, b, c], self.weights),
            _ => i32::MIN / 16,
        }
    }

    /// None outside the image.
    #[inline]
    pub(super) fn pixel(&self, u: usize, v: usize) -> Option<[u8; 3]> {
        match self.frame.row(v).get(3 * u..3 * u + 3) {
            Some(&[a, b, c]) => Some([a, b, c]),
            _ => None,
        }
    }

    fn run_in_row(&self, u: usize, v: usize, least: i32) -> Option<[usize; 2]> {
        let row = self.frame.row(v);
        self.run(u, |u| self.chroma_of(row.get(3 * u..3 * u + 3)) >= least)
    }

    fn run_in_column(&self, u: usize, v: usize, least: i32) -> Option<[usize; 2]> {
        self.run(v, |v| self.chroma(u, v) >= least)
    }

    /// The longest interval around `start` on which `inside` holds; None if longer than a disc.
    fn run(&self, start: usize, inside: impl Fn(usize) -> bool) -> Option<[usize; 2]> {
        let (mut first, mut last) = (start, start);
        // A pixel that noise has taken out of the disc is passed over.
        while let Some(next) = [1, 2].into_iter().find(|step| first >= *step && inside(first - step)) {
            first -= next;
            if start - first > self.longest {
                return None;
            }
        }
        while let Some(next) = [1, 2].into_iter().find(|step| inside(last + step)) {
            last += next;
            if last - first > self.longest {
                return None;
            }
        }
        Some([first, last])
    }
}

fn middle([first, last]: [usize; 2]) -> usize {
    (first + last) / 2
}
