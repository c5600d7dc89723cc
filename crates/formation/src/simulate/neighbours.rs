//! Lists of neighbours that outlast several ticks (L. Verlet, "Computer experiments on classical fluids", 1967).
use super::grid::Grid;
use crate::Vector2;
use crate::hull::ApparentObstacle;
use crate::kinematics::PointState;

/// How much farther than asked the lists reach, as a part of the range: the more, the longer they last, and the longer they are.
const SKIN: f64 = 0.5;

/// For each robot all others within a range. They are sought anew once a robot has moved so far that one may be missing.
#[derive(Debug, Clone, Default)]
pub struct Neighbours {
    grid: Grid,
    range: f64,
    /// Where the robots were when the lists were made.
    anchors: Vec<Vector2<f64>>,
    /// The lists one after the other, each ascending, and where they end.
    others: Vec<u32>,
    ends: Vec<u32>,
    found: Vec<u32>,
    /// How far each robot was from all obstacles then, at least, m.
    clear: Vec<f64>,
    keeps: f64,
}

impl Neighbours {
    /// Makes sure that the lists hold whoever is within `range` (m) of each other now. `obstacles` rest, and are the
    /// same as before unless all was forgotten.
    pub fn update(&mut self, range: f64, robots: &[PointState], obstacles: &[ApparentObstacle]) {
        // Two robots come nearer to each other by twice as much, and a position that is not a number never keeps.
        self.keeps = 0.499 * SKIN * range;
        let keeps = self.keeps;
        let near =
            |(anchor, robot): (&Vector2<f64>, &PointState)| (robot.position - anchor).norm_squared() <= keeps * keeps;
        let same = self.range == range && self.anchors.len() == robots.len();
        if same && self.anchors.iter().zip(robots).all(near) {
            return;
        }
        self.range = range;
        self.anchors.clear();
        self.anchors.extend(robots.iter().map(|robot| robot.position));
        let reach = (1.0 + SKIN) * range;
        self.grid.fill(reach, self.anchors.iter().copied());
        self.others.clear();
        self.ends.clear();
        for (index, anchor) in self.anchors.iter().enumerate() {
            self.grid.near(*anchor, &mut self.found);
            let within = |other: &u32| {
                *other as usize != index && (self.anchors[*other as usize] - anchor).norm_squared() <= reach * reach
            };
            self.others.extend(self.found.iter().copied().filter(within));
            self.ends.push(self.others.len() as u32);
        }
        let least = |anchor: &Vector2<f64>| {
            obstacles.iter().map(|obstacle| obstacle.shape.least_gap(*anchor)).fold(f64::INFINITY, f64::min)
        };
        self.clear.clear();
        self.clear.extend(self.anchors.iter().map(least));
    }

    /// Seeks all anew at the next update.
    pub(super) fn forget(&mut self) {
        self.anchors.clear();
    }

    /// No obstacle is nearer to a robot than this, m.
    #[inline]
    pub(super) fn clear(&self, index: usize) -> f64 {
        self.clear[index] - self.keeps
    }

    /// The others that may be within range of a robot, ascending.
    #[inline]
    pub fn of(&self, index: usize) -> &[u32] {
        let begin = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.others[begin as usize..self.ends[index] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Nobody within range is missing, however the robots have moved since the lists were made.
        #[test]
        fn nobody_is_missing(
            starts in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 2..40),
            moves in prop::collection::vec((-0.2..0.2_f64, -0.2..0.2_f64), 40),
        ) {
            let mut robots: Vec<PointState> =
                starts.iter().map(|(x, y)| PointState::at_rest(Vector2::new(*x, *y))).collect();
            let mut neighbours = Neighbours::default();
            for _ in 0..6 {
                neighbours.update(1.2, &robots, &[]);
                for (index, robot) in robots.iter().enumerate() {
                    let near = |other: &usize| {
                        *other != index && (robots[*other].position - robot.position).norm() <= 1.2
                    };
                    let listed = neighbours.of(index);
                    prop_assert!(listed.is_sorted_by(|a, b| a < b));
                    prop_assert!((0..robots.len()).filter(near).all(|other| listed.contains(&(other as u32))));
                }
                for (robot, (x, y)) in robots.iter_mut().zip(&moves) {
                    robot.position += Vector2::new(*x, *y);
                }
            }
        }
    }
}
