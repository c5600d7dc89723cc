//! Dijkstra's search from one row over reduced costs, in vector code.
use super::CostMatrix;
use super::solve::FREE;
use crate::lanes::{LANES, Lanes, first_at};

/// Columns whose least distance is kept together.
const BLOCK: usize = 64;

/// Memory of searches, used again from one to the next.
pub(super) struct Search {
    /// Distance of each column that is not reached for good; infinite for the others.
    open: Vec<f64>,
    /// v, and minus infinity for columns that are reached for good: no distance of theirs is shorter.
    prices: Vec<f64>,
    /// Row from which the shortest path comes; a number like a distance, for vector code.
    previous: Vec<f64>,
    /// Least distance of each block of columns.
    least: Vec<f64>,
    /// Columns reached for good, in order, and their distances.
    scanned: Vec<(usize, f64)>,
    reached: f64,
}

impl Search {
    pub(super) fn new(columns: usize) -> Self {
        Self {
            open: vec![0.0; columns],
            prices: vec![0.0; columns],
            previous: vec![0.0; columns],
            least: vec![0.0; columns.div_ceil(BLOCK)],
            scanned: Vec::with_capacity(columns),
            reached: 0.0,
        }
    }

    /// From which row the shortest path reaches `column`.
    pub(super) fn previous(&self, column: usize) -> usize {
        self.previous[column] as usize
    }

    /// The nearest free column.
    #[inline(always)]
    pub(super) fn shortest_path<L: Lanes>(
        &mut self,
        costs: &CostMatrix,
        from: usize,
        (u, v): (&[f64], &[f64]),
        row_of: &[usize],
    ) -> usize {
        self.open.fill(f64::INFINITY);
        self.prices.copy_from_slice(v);
        self.scanned.clear();
        self.reached = 0.0;
        let mut row = from;
        loop {
            self.relax::<L>(costs.row(row), self.reached - u[row], row as f64);
            let column = self.nearest::<L>();
            self.reached = self.open[column];
            self.scanned.push((column, self.reached));
            (self.open[column], self.prices[column]) = (f64::INFINITY, f64::NEG_INFINITY);
            if row_of[column] == FREE {
                return column;
            }
            row = row_of[column];
        }
    }

    /// Shortens the paths of all columns that are nearer by way of a row.
    #[inline(always)]
    fn relax<L: Lanes>(&mut self, costs: &[f64], offset: f64, row: f64) {
        let blocks = self.open.chunks_mut(BLOCK).zip(self.previous.chunks_mut(BLOCK));
        let given = costs.chunks(BLOCK).zip(self.prices.chunks(BLOCK));
        for (((open, previous), (costs, prices)), least) in blocks.zip(given).zip(&mut self.least) {
            let (open, open_rest) = open.as_chunks_mut::<LANES>();
            let (previous, previous_rest) = previous.as_chunks_mut::<LANES>();
            let ((costs, costs_rest), (prices, prices_rest)) =
                (costs.as_chunks::<LANES>(), prices.as_chunks::<LANES>());
            let mut lanes = L::splat(f64::INFINITY);
            for ((open, previous), (costs, prices)) in open.iter_mut().zip(previous).zip(costs.iter().zip(prices)) {
                let (distance, before) = (L::splat(offset) + L::new(*costs) - L::new(*prices), L::new(*open));
                let shorter = distance.is_below(before);
                let now = distance.or(shorter, before);
                // Most paths do not become shorter: no store is quicker than a store of the same.
                if shorter.bits() != 0 {
                    *open = now.to_array();
                    *previous = L::splat(row).or(shorter, L::new(*previous)).to_array();
                }
                lanes = now.least(lanes);
            }
            *least = lanes.to_array().into_iter().fold(f64::INFINITY, f64::min);
            let rest = open_rest.iter_mut().zip(previous_rest).zip(costs_rest.iter().zip(prices_rest));
            for ((open, previous), (cost, price)) in rest {
                let distance = offset + cost - price;
                if distance < *open {
                    (*open, *previous) = (distance, row);
                }
                *least = least.min(*open);
            }
        }
    }

    /// The nearest column, the first of equally near ones.
    #[inline(always)]
    fn nearest<L: Lanes>(&self) -> usize {
        let (mut block, mut least) = (0, f64::INFINITY);
        for (index, value) in self.least.iter().enumerate() {
            if *value < least {
                (block, least) = (index, *value);
            }
        }
        let begin = block * BLOCK;
        begin + position::<L>(&self.open[begin..], least).unwrap_or(0)
    }

    /// Changes the dual variables so that the path costs nothing; `row_of` is as it was for the search.
    pub(super) fn update(&self, from: usize, (u, v): (&mut [f64], &mut [f64]), row_of: &[usize]) {
        u[from] += self.reached;
        for &(column, distance) in &self.scanned {
            let change = self.reached - distance;
            v[column] -= change;
            if row_of[column] != FREE {
                u[row_of[column]] += change;
            }
        }
    }
}

/// Where a value is first found.
#[inline(always)]
fn position<L: Lanes>(values: &[f64], wanted: f64) -> Option<usize> {
    let (lanes, rest) = values.as_chunks::<LANES>();
    let in_rest = || rest.iter().position(|value| *value == wanted);
    let all = lanes.iter().map(|values| L::new(*values));
    first_at(all, wanted).or_else(|| Some(LANES * lanes.len() + in_rest()?))
}
