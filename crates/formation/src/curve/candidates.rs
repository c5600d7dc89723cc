//! Which pieces can be nearest to a point, looked up by the square of a grid that the point lies in.
//!
//! Points that are nearer to a point P than to a convex set are a convex set themselves: an intersection of half-planes, or of the
//! inside of branches of hyperbolas about P where P is to be nearer by some length. So a point of the curve that is nearer to all four
//! corners of a square than a piece is proves that the piece is nearest to nothing in it.
use super::piece::Piece;
use crate::lanes::{LANES, Lanes, Plane, Vectors};
use core::ops::Range;
use nalgebra::Vector2;
use wide::f64x4;

/// Squares of the grid for each piece, and at most.
const SQUARES: usize = 8;
const MOST_SQUARES: usize = 1 << 18;
/// Most blocks of pieces that a square is told of, as many as fit into the lower bits of an entry; where it would be more, the tree of
/// boxes is asked.
pub(super) const BLOCKS: usize = 3;
/// So few pieces are not worth the division of what they are told to.
const FEW: usize = 4;
/// A curve of so few pieces has one node of boxes, which is as quick.
const LEAST: usize = 5;
/// How far the grid reaches beyond the curve: as a part of the curve's longer side, and by pieces of mean length.
const BEYOND: (f64, f64) = (0.25, 16.0);
/// How much larger squares are taken to be than they are, as a part of their side and of the largest coordinate.
const ROUNDING: (f64, f64) = (1e-9, 1e-12);

/// A piece as its chord, and what its squared length is divided by: all that most questions ask of it.
#[derive(Debug, Clone, PartialEq)]
struct Chord {
    start: Vector2<f64>,
    along: Vector2<f64>,
    per_squared: f64,
}

impl Chord {
    /// Farther than anything.
    const NOWHERE: Self = Self { start: Vector2::new(1e150, 1e150), along: Vector2::new(0.0, 0.0), per_squared: 0.0 };

    fn of(piece: &Piece) -> Self {
        let along = piece.end - piece.start;
        let squared = along.norm_squared();
        Self { start: piece.start, along, per_squared: if squared > 0.0 { 1.0 / squared } else { 0.0 } }
    }

    /// From the nearest points of some to a point each, m.
    #[inline(always)]
    fn away<L: Lanes>(chords: [&Self; LANES], points: Vectors<L>) -> Vectors<L> {
        let along = Vectors::<L>::of(chords.map(|chord| chord.along));
        let offset = points - Vectors::of(chords.map(|chord| chord.start));
        let fraction = L::new(chords.map(|chord| chord.per_squared)) * Plane::dot(&offset, &along);
        offset - fraction.most(L::splat(0.0)).least(L::splat(1.0)) * along
    }
}

/// A grid over a curve and what lies around it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Candidates {
    low: Vector2<f64>,
    per_side: f64,
    columns: usize,
    rows: usize,
    /// For each square, row by row, where its list begins, in blocks, times 4, and its length in blocks; 0 where it is unknown.
    squares: Vec<u32>,
    /// Blocks of pieces; where there are no more, the one after the last.
    lists: Vec<[u32; LANES]>,
    /// Of all pieces, and of that one.
    chords: Vec<Chord>,
}

impl Candidates {
    /// Of the pieces of a curve of this length, m.
    pub(super) fn new(pieces: &[Piece], length: f64) -> Self {
        if pieces.len() < LEAST {
            return Self::default();
        }
        let corner = |by: fn(&Vector2<f64>, &Vector2<f64>) -> Vector2<f64>| {
            pieces.iter().map(|piece| by(&piece.start, &piece.end)).reduce(|a, b| by(&a, &b)).unwrap_or_default()
        };
        let (low, high) = (corner(Vector2::inf), corner(Vector2::sup));
        let beyond = (BEYOND.0 * (high - low).max()).min(BEYOND.1 * length / pieces.len() as f64);
        let (low, sides) = (low.add_scalar(-beyond), (high - low).add_scalar(2.0 * beyond));
        let side = (sides.x * sides.y / (SQUARES * pieces.len()).min(MOST_SQUARES) as f64).sqrt();
        let [columns, rows] = [sides.x, sides.y].map(|whole| libm::ceil(whole / side) as usize);
        let chords = pieces.iter().map(Chord::of).chain([Chord::NOWHERE]).collect();
        let table =
            Self { low, per_side: 1.0 / side, columns, rows, squares: vec![0; columns * rows], lists: vec![], chords };
        let largest = low.abs().max().max((low + sides).abs().max());
        let slack = ROUNDING.0 * side + ROUNDING.1 * largest;
        let pending = (0..pieces.len() as u32).collect();
        let mut builder = Builder { pieces, table, side, slack, pending, distances: vec![] };
        builder.fill(0..columns, 0..rows, 0);
        builder.table
    }

    /// All pieces that can be nearest to `point`, in order, and perhaps others; nothing where that is not known.
    #[inline]
    pub(super) fn near(&self, point: Vector2<f64>) -> Option<&[[u32; LANES]]> {
        let across = self.per_side * (point - self.low);
        if !(across.x >= 0.0 && across.y >= 0.0 && across.x < self.columns as f64 && across.y < self.rows as f64) {
            return None;
        }
        let square = self.squares[across.y as usize * self.columns + across.x as usize];
        let (begin, count) = (square as usize / (BLOCKS + 1), square as usize % (BLOCKS + 1));
        self.lists.get(begin..begin + count).filter(|blocks| !blocks.is_empty())
    }

    /// Squared distances of the chords of a block of pieces from a point, m^2.
    #[inline(always)]
    pub(super) fn distances_squared<L: Lanes>(&self, block: &[u32; LANES], point: Vector2<f64>) -> L {
        let chords = block.map(|index| &self.chords[index as usize]);
        Chord::away(chords, Vectors::<L>::splat(point)).norm_squared()
    }
}

/// Divides the grid, with what can be nearest to anything in a part of it, down to its squares.
struct Builder<'a> {
    pieces: &'a [Piece],
    table: Candidates,
    side: f64,
    slack: f64,
    /// What can be nearest in the parts under way, the smallest last.
    pending: Vec<u32>,
    /// Distances of the pieces that are looked at from the corners of a part.
    distances: Vec<f64x4>,
}

impl Builder<'_> {
    /// Fills a part of the grid, in which none can be nearest but those pending from `begin` on.
    fn fill(&mut self, columns: Range<usize>, rows: Range<usize>, begin: usize) {
        let kept = self.pending.len();
        self.keep(&columns, &rows, begin);
        let count = self.pending.len() - kept;
        if count <= FEW || columns.len() * rows.len() == 1 {
            let entry = self.enlist(kept);
            for row in rows {
                let first = row * self.table.columns;
                self.table.squares[first + columns.start..first + columns.end].fill(entry);
            }
        } else if columns.len() >= rows.len() {
            let middle = columns.start + columns.len() / 2;
            self.fill(columns.start..middle, rows.clone(), kept);
            self.fill(middle..columns.end, rows, kept);
        } else {
            let middle = rows.start + rows.len() / 2;
            self.fill(columns.clone(), rows.start..middle, kept);
            self.fill(columns, middle..rows.end, kept);
        }
        self.pending.truncate(kept);
    }

    /// What a square says whose list are those pending from `begin` on.
    fn enlist(&mut self, begin: usize) -> u32 {
        let (list, at) = (&self.pending[begin..], self.table.lists.len());
        let blocks = list.len().div_ceil(LANES);
        if blocks > BLOCKS || at >= (u32::MAX as usize) / (BLOCKS + 1) {
            return 0;
        }
        let none = self.pieces.len() as u32;
        let block = |some: &[u32]| core::array::from_fn(|lane| some.get(lane).copied().unwrap_or(none));
        self.table.lists.extend(list.chunks(LANES).map(block));
        (at * (BLOCKS + 1) + blocks) as u32
    }

    /// Adds those pending from `begin` on that can be nearest to something in a part of the grid.
    fn keep(&mut self, columns: &Range<usize>, rows: &Range<usize>, begin: usize) {
        let at = |column: usize, row: usize| self.table.low + self.side * Vector2::new(column as f64, row as f64);
        let (low, high) = (at(columns.start, rows.start), at(columns.end, rows.end));
        let corners = Vectors::<f64x4>::of([low, Vector2::new(high.x, low.y), Vector2::new(low.x, high.y), high]);
        // The points of the curve nearest to the corners, how far these may be from there, and the distance that is less than.
        let (mut nearest, mut off, mut least) = (corners, f64x4::ZERO, f64x4::splat(f64::INFINITY));
        self.distances.clear();
        for index in self.pending[begin..].iter().map(|index| *index as usize) {
            let sagitta = f64x4::splat(self.pieces[index].sagitta);
            let away = Chord::away([&self.table.chords[index]; LANES], corners);
            let distance = away.norm();
            let nearer = (distance + sagitta).simd_lt(least);
            nearest = (corners - away).or(nearer, &nearest);
            (off, least) = (nearer.select(sagitta, off), nearer.select(distance + sagitta, least));
            self.distances.push(distance);
        }
        let nearest = nearest.to_array();
        let reach: [f64x4; LANES] = core::array::from_fn(|corner| {
            let off = f64x4::splat(off.as_array()[corner] + self.slack);
            (corners - Vectors::splat(nearest[corner])).norm() + off
        });
        for (offset, distances) in self.distances.iter().enumerate() {
            let index = self.pending[begin + offset];
            let sagitta = f64x4::splat(self.pieces[index as usize].sagitta);
            if !reach.iter().any(|reach| (*reach + sagitta).simd_lt(*distances).all()) {
                self.pending.push(index);
            }
        }
    }
}
