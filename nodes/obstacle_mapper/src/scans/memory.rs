//! What lasers have seen lately, of all robots together: cells of a grid, forgotten when nobody sees them any more.

use super::Beams;
use std::collections::BTreeMap;
use trench_core::Steady;
use trench_formation::Vector2;

/// Edge of a cell, m: a few times the noise of a range.
pub(crate) const CELL: f64 = 0.04;
/// More cells than any field has walls: the oldest are kept, new ones are not taken.
const MOST_CELLS: usize = 20_000;
/// A cell seen within this time, s, is not doubted: what is seen is there.
const UNDOUBTED: f64 = 0.15;
/// Rays must have gone on for so long behind a cell to clear it, m.
const BEYOND: f64 = 0.12;

/// Row and column.
pub(crate) type Place = (i32, i32);

/// A cell in which something was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cell {
    /// The mean of what was seen, m.
    pub(crate) point: Vector2<f64>,
    /// The boundary it belongs to; 0: none yet.
    pub(crate) id: u32,
    seen: Steady,
}

/// The cells.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    pub(crate) cells: BTreeMap<Place, Cell>,
}

impl Memory {
    /// Takes the points of a scan; whether there was room for all.
    pub(crate) fn see(&mut self, at: Steady, points: &[Vector2<f64>]) -> bool {
        let mut all = true;
        for point in points {
            // Conversion saturates: far away is far away.
            let place = ((point.y / CELL).floor() as i32, (point.x / CELL).floor() as i32);
            let full = self.cells.len() >= MOST_CELLS;
            match self.cells.get_mut(&place) {
                Some(cell) => {
                    // Forgets slowly: obstacles move a little, measurements are noisy.
                    cell.point += 0.2 * (point - cell.point);
                    cell.seen = at;
                }
                None if full => all = false,
                None => {
                    self.cells.insert(place, Cell { point: *point, id: 0, seen: at });
                }
            }
        }
        all
    }

    /// Forgets cells that rays passed through, unless somebody has seen them just now.
    pub(crate) fn clear(&mut self, at: Steady, beams: &Beams) {
        self.cells.retain(|_, cell| at.seconds_since(cell.seen) < UNDOUBTED || !beams.pass(cell.point, BEYOND));
    }

    /// Forgets what was last seen longer than `memory` (s) ago.
    pub(crate) fn expire(&mut self, at: Steady, memory: f64) {
        self.cells.retain(|_, cell| at.seconds_since(cell.seen) <= memory);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_merged_and_expire() {
        let (mut memory, at) = (Memory::default(), |seconds: f64| Steady(0).plus_seconds(seconds));
        let (a, b) = (Vector2::new(1.01, 1.01), Vector2::new(1.02, 1.01));
        assert!(memory.see(at(0.0), &[a]));
        assert!(memory.see(at(1.0), &[b, Vector2::new(-0.01, 0.0)]));
        assert_eq!(memory.cells.keys().copied().collect::<Vec<_>>(), [(0, -1), (25, 25)]);
        assert!((memory.cells[&(25, 25)].point.x - 1.012).abs() < 1e-9);
        memory.expire(at(3.0), 2.0);
        assert_eq!(memory.cells.len(), 2);
        memory.expire(at(3.1), 2.0);
        assert_eq!(memory.cells.len(), 0);
    }

    #[test]
    fn a_flood_of_points_does_not_fill_the_memory() {
        let mut memory = Memory::default();
        let flood: Vec<_> = (0..30_000_u32).map(|index| Vector2::new(f64::from(index), 1e300)).collect();
        assert!(!memory.see(Steady(0), &flood));
        assert_eq!(memory.cells.len(), MOST_CELLS);
    }
}
