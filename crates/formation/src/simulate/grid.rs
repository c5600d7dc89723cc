//! Who is near whom, without looking at all pairs.
use crate::Vector2;

/// Points by square cells, found by a table of their hashes: building and asking cost the same a point however many there are.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    size: f64,
    /// Where the bucket of each hash begins in `entries`, and where the last one ends.
    starts: Vec<u32>,
    entries: Vec<(Cell, u32)>,
    /// Buckets of the points in order, kept for its space.
    buckets: Vec<(Cell, u32)>,
}

type Cell = (i32, i32);

impl Grid {
    /// Sorts `points` into cells of `size` (m).
    pub(super) fn fill(&mut self, size: f64, points: impl ExactSizeIterator<Item = Vector2<f64>>) {
        self.size = size;
        let count = (2 * points.len()).next_power_of_two();
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        self.buckets.clear();
        for point in points {
            let cell = self.cell(point);
            let bucket = hash(cell) & (count as u32 - 1);
            self.starts[bucket as usize + 1] += 1;
            self.buckets.push((cell, bucket));
        }
        for bucket in 0..count {
            self.starts[bucket + 1] += self.starts[bucket];
        }
        self.entries.clear();
        self.entries.resize(self.buckets.len(), ((0, 0), 0));
        // From the last point on, so that the points of a bucket stand in order before its end has come down to its beginning.
        for (index, (cell, bucket)) in self.buckets.iter().enumerate().rev() {
            let end = &mut self.starts[*bucket as usize + 1];
            *end -= 1;
            self.entries[*end as usize] = (*cell, index as u32);
        }
        self.starts.remove(0);
        self.starts.push(self.entries.len() as u32);
    }

    /// Indices of the points in the cells within one size of `point`, ascending, into `found`: all that are that near, and some
    /// that are farther.
    pub(super) fn near(&self, point: Vector2<f64>, found: &mut Vec<u32>) {
        found.clear();
        let (column, row) = self.cell(point);
        for cell in
            (-1..=1).flat_map(|up| (-1..=1).map(move |right| (column.wrapping_add(right), row.wrapping_add(up))))
        {
            let bucket = (hash(cell) & (self.starts.len() as u32 - 2)) as usize;
            let entries = &self.entries[self.starts[bucket] as usize..self.starts[bucket + 1] as usize];
            found.extend(entries.iter().filter(|(of, _)| *of == cell).map(|(_, index)| *index));
        }
        found.sort_unstable();
    }

    fn cell(&self, point: Vector2<f64>) -> Cell {
        // Casts saturate, and a point that is not a number is put at 0: nobody is lost.
        (libm::floor(point.x / self.size) as i32, libm::floor(point.y / self.size) as i32)
    }
}

fn hash((column, row): Cell) -> u32 {
    let mixed = (column as u32).wrapping_mul(0x9e37_79b1) ^ (row as u32).wrapping_mul(0x85eb_ca77);
    mixed ^ (mixed >> 15)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_all_that_are_near(
            points in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 1..60), x in -9.0..9.0_f64, y in -9.0..9.0_f64,
        ) {
            let points: Vec<Vector2<f64>> = points.into_iter().map(|(x, y)| Vector2::new(x, y)).collect();
            let mut grid = Grid::default();
            grid.fill(1.5, [Vector2::zeros()].into_iter()); // what was there before is gone
            grid.fill(1.5, points.iter().copied());
            let (centre, mut found) = (Vector2::new(x, y), vec![7]);
            grid.near(centre, &mut found);
            let near = |index: &u32| (points[*index as usize] - centre).norm() <= 1.5;
            let expected: Vec<u32> = (0..points.len() as u32).filter(near).collect();
            prop_assert!(found.is_sorted_by(|a, b| a < b));
            prop_assert_eq!(found.into_iter().filter(near).collect::<Vec<_>>(), expected);
        }
    }
}
