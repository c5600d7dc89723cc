//! What a team has seen of the boundaries of obstacles (Remark 7.4.1, which leaves it to further work).
use crate::Vector2;
use crate::hull::{HullError, Obstacle, Shape};
use crate::kinematics::PointState;

/// How far a team sees. What one robot has seen all know (7.4), and nobody forgets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// A robot sees boundaries that nothing hides from it up to this distance, m.
    pub range: f64,
    /// Boundaries are seen in pieces no longer than this, by their middle, m.
    pub piece: f64,
}

/// Points per rounded corner of a boundary.
const CORNER: usize = 16;
/// Every robot looks at every piece that nobody has seen yet, and every edge may hide it.
pub(super) const MOST_PIECES: f64 = 1e4;
/// What meets a line of sight within this part of it from either end does not hide anything.
const TOUCH: f64 = 1e-6;

type Edge = [Vector2<f64>; 2];

/// What is known of resting obstacles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Knowledge {
    sight: Sight,
    /// What may hide something.
    edges: Vec<Edge>,
    /// Pieces that nobody has seen.
    unseen: Vec<Edge>,
    /// Those that were seen, by the order in which they were: the least id of what they are combined to stays as more is seen.
    known: Vec<Obstacle>,
}

impl Knowledge {
    /// A team that has seen nothing; none where the boundaries are more than [`MOST_PIECES`].
    pub(super) fn new(obstacles: &[Obstacle], sight: Sight) -> Option<Self> {
        let mut edges = Vec::new();
        for obstacle in obstacles {
            let outline = obstacle.shape.outline();
            if outline.radius > 0.0 {
                edges.extend(outline.boundary(CORNER).windows(2).map(|pair| [pair[0], pair[1]]));
            } else {
                edges.extend(outline.edges().map(|(start, end)| [start, end]));
            }
        }
        let pieces = |&[start, end]: &Edge| libm::ceil((end - start).norm() / sight.piece).max(1.0);
        if edges.iter().map(pieces).sum::<f64>() > MOST_PIECES {
            return None;
        }
        let cut = |edge: &Edge| {
            let (&[start, end], count) = (edge, pieces(edge));
            let at = move |index: u32| start + (end - start) * (f64::from(index) / count);
            (0..count as u32).map(move |index| [at(index), at(index + 1)])
        };
        let unseen = edges.iter().flat_map(cut).collect();
        Some(Self { sight, edges, unseen, known: Vec::new() })
    }

    /// The pieces that were seen, as obstacles.
    pub(super) fn known(&self) -> &[Obstacle] {
        &self.known
    }

    /// Looks round; whether there is anything new.
    ///
    /// # Errors
    /// Obstacles that are not finite.
    pub(super) fn look(&mut self, robots: &[PointState]) -> Result<bool, HullError> {
        let before = self.known.len();
        let mut hidden = Vec::with_capacity(self.unseen.len());
        for piece in core::mem::take(&mut self.unseen) {
            let middle = 0.5 * (piece[0] + piece[1]);
            if robots.iter().any(|robot| self.sees(robot.position, middle)) {
                let id = self.known.len() as u32;
                self.known.push(Obstacle { id, shape: Shape::enclosing(&piece, 0.0)? });
            } else {
                hidden.push(piece);
            }
        }
        self.unseen = hidden;
        Ok(self.known.len() > before)
    }

    fn sees(&self, robot: Vector2<f64>, point: Vector2<f64>) -> bool {
        let ray = point - robot;
        let hides = |&[start, end]: &Edge| {
            let edge = end - start;
            let turn = ray.perp(&edge);
            let (along, across) = ((start - robot).perp(&edge) / turn, (start - robot).perp(&ray) / turn);
            (TOUCH..1.0 - TOUCH).contains(&along) && (0.0..=1.0).contains(&across)
        };
        ray.norm_squared() <= self.sight.range * self.sight.range && !self.edges.iter().any(hides)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> PointState {
        PointState::at_rest(Vector2::new(x, y))
    }

    fn seen(obstacles: &[Obstacle], robot: PointState) -> Vec<Obstacle> {
        let mut knowledge = Knowledge::new(obstacles, Sight { range: 5.0, piece: 0.5 }).unwrap();
        knowledge.look(&[robot]).unwrap();
        knowledge.known().to_vec()
    }

    #[test]
    fn the_far_side_and_what_is_behind_stay_unknown() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| Vector2::new(x, y));
        let wall = [Vector2::new(0.5, -2.0), Vector2::new(1.5, -2.0)];
        let obstacle = |id, points: &[Vector2<f64>]| Obstacle { id, shape: Shape::new(points, 0.0).unwrap() };
        let both = [obstacle(1, &square), obstacle(2, &wall)];
        let above = seen(&both, at(1.0, 4.0));
        assert_eq!(above.len(), 4, "half a metre each of the upper side alone: {above:?}");
        assert!(above.iter().all(|piece| piece.shape.outline().points.iter().all(|point| point.y == 2.0)));
        let corner = seen(&both, at(4.0, 3.0));
        assert_eq!(corner.len(), 8, "two sides: {corner:?}");
        assert!(seen(&both, at(1.0, 8.0)).is_empty(), "out of range");
    }

    #[test]
    fn what_was_seen_is_kept() {
        let disc = Obstacle { id: 1, shape: Shape::new(&[Vector2::zeros()], 1.0).unwrap() };
        let mut knowledge = Knowledge::new(&[disc], Sight { range: 5.0, piece: 0.5 }).unwrap();
        assert!(knowledge.look(&[at(3.0, 0.0)]).unwrap());
        let first = knowledge.known().to_vec();
        assert!(!knowledge.look(&[at(3.0, 0.0)]).unwrap(), "nothing new");
        assert!(knowledge.look(&[at(-3.0, 0.0)]).unwrap());
        assert!(knowledge.known().starts_with(&first) && knowledge.known().len() > first.len());
    }
}
