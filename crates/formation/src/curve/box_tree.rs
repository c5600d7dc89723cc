//! Bounding boxes over consecutive pieces, in a complete binary tree: pieces are already sorted along the curve.
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

    /// Squared distance from `point`; infinite if empty.
    fn distance_squared(&self, point: Vector2<f64>) -> f64 {
        (self.low - point).sup(&(point - self.high)).sup(&Vector2::zeros()).norm_squared()
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }
}

/// More pieces than 2 to this have no room in memory.
const MOST_LEVELS: usize = 40;

/// Node 1 is the root, 2 n and 2 n + 1 are the children of n, leaf i is node `leaves` + i.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoxTree {
    nodes: Vec<Bounds>,
    leaves: usize,
}

impl BoxTree {
    pub(super) fn new(pieces: &[Piece]) -> Self {
        let leaves = pieces.len().next_power_of_two();
        let mut nodes = vec![Bounds::EMPTY; 2 * leaves];
        for (node, piece) in nodes[leaves..].iter_mut().zip(pieces) {
            *node = Bounds::of(piece);
        }
        for i in (1..leaves).rev() {
            nodes[i] = nodes[2 * i].union(&nodes[2 * i + 1]);
        }
        Self { nodes, leaves }
    }

    /// Calls `visit` with every piece whose box is within `reach` of `point`, nearer boxes first; `visit` returns the
    /// reach from then on.
    pub(super) fn visit_near(&self, point: Vector2<f64>, reach: f64, mut visit: impl FnMut(usize) -> f64) {
        self.visit_below(1, point, squared(reach), &mut visit);
    }

    /// As [`Self::visit_near`] without a limit, but the piece `first` first, and then what is near it in the tree: from a piece
    /// near the nearest one hardly anything else is looked at.
    pub(super) fn visit_near_from(&self, first: usize, point: Vector2<f64>, mut visit: impl FnMut(usize) -> f64) {
        let mut limit = squared(visit(first));
        let mut node = self.leaves + first;
        while node > 1 {
            // Most of them are too far.
            if self.nodes[node ^ 1].distance_squared(point) <= limit {
                limit = self.visit_below(node ^ 1, point, limit, &mut visit);
            }
            node /= 2;
        }
    }

    /// Visits what is below `top` and within the root of `limit`; the limit that is left.
    fn visit_below(
        &self,
        top: usize,
        point: Vector2<f64>,
        mut limit: f64,
        visit: &mut impl FnMut(usize) -> f64,
    ) -> f64 {
        let mut stack = [(0, 0.0); MOST_LEVELS];
        stack[0] = (top, self.nodes[top].distance_squared(point));
        let mut used = 1;
        while used > 0 {
            used -= 1;
            let (node, distance) = stack[used];
            if distance > limit || distance == f64::INFINITY {
                continue;
            }
            if node >= self.leaves {
                limit = squared(visit(node - self.leaves));
                continue;
            }
            let left = (2 * node, self.nodes[2 * node].distance_squared(point));
            let right = (2 * node + 1, self.nodes[2 * node + 1].distance_squared(point));
            let (near, far) = if left.1 <= right.1 { (left, right) } else { (right, left) };
            stack[used] = far;
            stack[used + 1] = near;
            used += 2;
        }
        limit
    }

    /// All pairs (i, j), i < j, of pieces whose boxes meet.
    pub(super) fn meeting_pairs(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        let mut stack = vec![(1, 1)];
        while let Some((a, b)) = stack.pop() {
            if !self.nodes[a].meets(&self.nodes[b]) {
                continue;
            }
            match (a >= self.leaves, a == b) {
                (true, true) => {}
                (true, false) => pairs.push((a - self.leaves, b - self.leaves)),
                (false, true) => stack.extend([(2 * a + 1, 2 * a + 1), (2 * a, 2 * a + 1), (2 * a, 2 * a)]),
                (false, false) => {
                    stack.extend([2 * a, 2 * a + 1].into_iter().flat_map(|l| [(l, 2 * b), (l, 2 * b + 1)]));
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }
}

/// The square of a reach, and a little more than rounding may take: a box as far as the reach is not missed.
fn squared(reach: f64) -> f64 {
    reach * reach * (1.0 + 8.0 * f64::EPSILON)
}
