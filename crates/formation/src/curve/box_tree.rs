//! Bounding boxes over consecutive pieces, in a complete tree of four branches: pieces are already sorted along the curve.
use super::piece::Piece;
use nalgebra::Vector2;

/// Axis-aligned box; empty if `low > high`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bounds {
    low: Vector2<f64>,
    high: Vector2<f64>,
}

impl Bounds {
    const EMPTY: Self = Self {
        low: Vector2::new(f64::INFINITY, f64::INFINITY),
        high: Vector2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    fn of(piece: &Piece) -> Self {
        let margin = Vector2::repeat(piece.sagitta);
        Self { low: piece.start.inf(&piece.end) - margin, high: piece.start.sup(&piece.end) + margin }
    }

    fn union(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }
}

/// The boxes of four nodes side by side, so that a processor measures several at once.
#[derive(Debug, Clone, PartialEq)]
struct Four {
    low: [[f64; 4]; 2],
    high: [[f64; 4]; 2],
}

impl Four {
    fn of(boxes: [Bounds; 4]) -> Self {
        let side = |of: fn(&Bounds) -> Vector2<f64>| [0, 1].map(|axis| boxes.map(|bounds| of(&bounds)[axis]));
        Self { low: side(|bounds| bounds.low), high: side(|bounds| bounds.high) }
    }

    fn get(&self, index: usize) -> Bounds {
        let at = |side: &[[f64; 4]; 2]| Vector2::new(side[0][index], side[1][index]);
        Bounds { low: at(&self.low), high: at(&self.high) }
    }

    /// Squared distances from `point`, ascending, each with the index of its box in its two lowest bits (which makes it less by a few
    /// units in the last place at most); infinite if empty.
    fn ranked(&self, point: Vector2<f64>) -> [u64; 4] {
        let greater = |a: f64, b: f64| if a > b { a } else { b };
        let mut squares = [0.0; 4];
        for axis in 0..2 {
            for (index, square) in squares.iter_mut().enumerate() {
                let (low, high) = (self.low[axis][index], self.high[axis][index]);
                let beyond = greater(greater(low - point[axis], point[axis] - high), 0.0);
                *square += beyond * beyond;
            }
        }
        // The bits of numbers that are not negative are in the order of the numbers.
        let mut keys: [u64; 4] = core::array::from_fn(|index| squares[index].to_bits() & !3 | index as u64);
        for (a, b) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            (keys[a], keys[b]) = (keys[a].min(keys[b]), keys[a].max(keys[b]));
        }
        keys
    }
}

/// Node 0 is the root, 4 n + 1 to 4 n + 4 are the children of n, leaf i is node `inner` + i.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoxTree {
    /// The boxes of the children of each inner node.
    children: Vec<Four>,
    inner: usize,
}

impl BoxTree {
    pub(super) fn new(pieces: &[Piece]) -> Self {
        let mut levels: Vec<Vec<Bounds>> = vec![pieces.iter().map(Bounds::of).collect()];
        let mut leaves = 1;
        while leaves < pieces.len() || levels.len() < 2 {
            leaves *= 4;
            let below = &levels[levels.len() - 1];
            let above = below.chunks(4).map(|four| four.iter().fold(Bounds::EMPTY, |all, one| all.union(one)));
            levels.push(above.collect());
        }
        // The root has a box too, that nobody asks for.
        levels.pop();
        let inner = (leaves - 1) / 3;
        let mut children = Vec::with_capacity(inner);
        for (depth, level) in levels.iter().rev().enumerate() {
            let get = |index: usize| level.get(index).copied().unwrap_or(Bounds::EMPTY);
            children.extend((0..1_usize << (2 * depth)).map(|node| Four::of([0, 1, 2, 3].map(|i| get(4 * node + i)))));
        }
        Self { children, inner }
    }

    /// Calls `visit` with every piece whose box is within `reach` of `point`, nearer boxes first; `visit` returns the
    /// reach from then on. Nothing is near a point that is not finite.
    pub(super) fn visit_near(&self, point: Vector2<f64>, reach: f64, mut visit: impl FnMut(usize) -> f64) {
        if !(point.x + point.y).is_finite() {
            return;
        }
        self.visit_below(0, point, squared(reach), &mut visit);
    }

    /// Visits what is below `node` and within the root of `limit`; the limit that is left.
    fn visit_below(
        &self,
        node: usize,
        point: Vector2<f64>,
        mut limit: f64,
        visit: &mut impl FnMut(usize) -> f64,
    ) -> f64 {
        for key in self.children[node].ranked(point) {
            let distance = f64::from_bits(key & !3);
            if distance > limit || distance == f64::INFINITY {
                break;
            }
            let child = 4 * node + 1 + (key & 3) as usize;
            limit = match child.checked_sub(self.inner) {
                Some(leaf) => squared(visit(leaf)),
                None => self.visit_below(child, point, limit, visit),
            };
        }
        limit
    }

    /// All pairs (i, j), i < j, of pieces whose boxes meet.
    pub(super) fn meeting_pairs(&self) -> Vec<(usize, usize)> {
        let bounds = |node: usize| self.children[(node - 1) / 4].get((node - 1) % 4);
        let below = |node: usize| 4 * node + 1..4 * node + 5;
        let mut pairs = Vec::new();
        let mut stack = vec![(0_usize, 0_usize)];
        while let Some((a, b)) = stack.pop() {
            if let (Some(a), Some(b)) = (a.checked_sub(self.inner), b.checked_sub(self.inner)) {
                if a != b {
                    pairs.push((a, b));
                }
                continue;
            }
            let all = below(a).flat_map(|child| below(b).map(move |other| (child, other)));
            stack.extend(all.filter(|(child, other)| child <= other && bounds(*child).meets(&bounds(*other))));
        }
        pairs.sort_unstable();
        pairs
    }
}

/// The square of a reach, and a little more than rounding may take: a box as far as the reach is not missed.
fn squared(reach: f64) -> f64 {
    reach * reach * (1.0 + 8.0 * f64::EPSILON)
}
