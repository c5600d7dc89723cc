//! The floor, painted once.

use super::appearance::{Appearance, Background, Light};
use super::noise::SplitMix;
use super::renderer::blend;

/// Paints the lit floor into `image` (rgb8, `width` pixels a row).
pub(super) fn paint(appearance: &Appearance, light: Light, width: usize, image: &mut [u8]) {
    let blotches = Lattice { seed: appearance.seed, cell: [14.0, 14.0] };
    let grain = Lattice { seed: appearance.seed ^ 0x5eed, cell: [120.0, 3.0] };
    for (v, row) in image.chunks_exact_mut(3 * width).enumerate() {
        for (u, pixel) in row.chunks_exact_mut(3).enumerate() {
            let (colour, factor) = match appearance.background {
                Background::Plain(colour) => (colour, 1.0),
                Background::Noisy(colour, contrast) => (colour, 1.0 + contrast * (2.0 * blotches.at(u, v) - 1.0)),
                Background::Wood => ([172, 134, 98], board(u, v, appearance.seed) * (0.82 + 0.3 * grain.at(u, v))),
            };
            blend(pixel, light.on(colour.map(|channel| f32::from(channel) * factor), u, v), 1.0);
        }
    }
}

/// Boards 48 pixels wide with dark joints, each of its own brightness.
fn board(u: usize, v: usize, seed: u64) -> f32 {
    let shift = SplitMix(seed ^ (v / 48) as u64).unit();
    let end = (u + (shift * 300.0) as usize) % 300 < 2;
    if v % 48 < 2 || end { 0.45 } else { 0.85 + 0.15 * shift as f32 }
}

/// Smooth random values in [0, 1): random at the corners of a lattice, interpolated between them.
struct Lattice {
    seed: u64,
    cell: [f32; 2],
}

impl Lattice {
    fn at(&self, u: usize, v: usize) -> f32 {
        let (x, y) = (u as f32 / self.cell[0], v as f32 / self.cell[1]);
        let (column, row) = (x as u64, y as u64);
        let (fx, fy) = (x - column as f32, y - row as f32);
        let corner = |column: u64, row: u64| SplitMix(self.seed ^ (column << 32 | row)).unit() as f32;
        let upper = corner(column, row) * (1.0 - fx) + corner(column + 1, row) * fx;
        let lower = corner(column, row + 1) * (1.0 - fx) + corner(column + 1, row + 1) * fx;
        upper * (1.0 - fy) + lower * fy
    }
}
