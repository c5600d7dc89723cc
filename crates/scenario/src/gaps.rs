//! How near the robots of a team come to obstacles, without looking at all of these for every robot at every step.

use trench_formation::Vector2;
use trench_formation::hull::Obstacle;
use trench_formation::kinematics::PointState;

/// What rounding may do to a gap or a way is far less, m.
const ROUNDING: f64 = 1e-6;

/// The least gap between a team and each obstacle's own outline so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Gaps {
    /// Id and least gap of each obstacle, m.
    least: Vec<(u32, f64)>,
    /// The obstacles as they were when the robots were last looked at.
    known: Vec<Obstacle>,
    looked_at: Vec<LookedAt>,
}

/// When a robot needs to be looked at again: once it has gone farther from there than any gap was above the least.
#[derive(Debug, Clone, Copy)]
struct LookedAt {
    /// m.
    position: Vector2<f64>,
    /// m; not positive: at once.
    room: f64,
}

impl Gaps {
    /// Id and least gap of each obstacle, m.
    pub(crate) fn least(&self) -> &[(u32, f64)] {
        &self.least
    }

    /// Takes note of the obstacles as they are now; whether they are others, and all robots have to be looked at.
    pub(crate) fn prepare(&mut self, real: &[Obstacle], team: &[PointState]) -> bool {
        let same = self.known == real && self.looked_at.len() == team.len();
        if !same {
            self.known.clear();
            self.known.extend_from_slice(real);
            self.least.resize(real.len(), (0, f64::INFINITY));
            for (least, obstacle) in self.least.iter_mut().zip(real) {
                least.0 = obstacle.id;
            }
            self.looked_at.clear();
            self.looked_at.extend(team.iter().map(|robot| LookedAt { position: robot.position, room: -1.0 }));
        }
        !same
    }

    /// Looks at a robot of the team that was prepared, if that may say something new. As far as it may go until then, m.
    pub(crate) fn look(&mut self, index: usize, position: Vector2<f64>) -> f64 {
        if self.known.is_empty() {
            return f64::INFINITY;
        }
        let LookedAt { position: before, room } = self.looked_at[index];
        // Gaps have fallen by no more than the way since then, and the least has not risen.
        let left = room - (position - before).norm();
        if left > 0.0 {
            return left;
        }
        let looked_at = look(&mut self.least, &self.known, position);
        self.looked_at[index] = looked_at;
        looked_at.room
    }
}

fn look(least: &mut [(u32, f64)], real: &[Obstacle], position: Vector2<f64>) -> LookedAt {
    let mut room = f64::INFINITY;
    for (obstacle, (_, least)) in real.iter().zip(least) {
        let gap = obstacle.shape.outline().approach(position).gap;
        *least = least.min(gap);
        room = room.min(gap - *least);
    }
    LookedAt { position, room: room - ROUNDING }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trench_formation::hull::{HullError, Shape};

    fn obstacles(at: &[(f64, f64)]) -> Result<Vec<Obstacle>, HullError> {
        let angle = |x, y| vec![Vector2::new(x, y), Vector2::new(x + 2.0, y), Vector2::new(x + 2.0, y + 1.0)];
        let obstacle = |(id, &(x, y))| {
            let points = if id == 8 { angle(x, y) } else { vec![Vector2::new(x, y)] };
            Ok(Obstacle { id, shape: Shape::new(&points, 0.5)? })
        };
        (7..).zip(at).map(obstacle).collect()
    }

    proptest! {
        /// The same bits as from every robot and obstacle at every step, while obstacles rest and after they have moved.
        #[test]
        fn all_robots_and_obstacles_say_the_same(
            starts in prop::collection::vec((-20.0..20.0_f64, -20.0..20.0_f64), 0..12),
            moves in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 12),
            at in prop::collection::vec((-20.0..20.0_f64, -20.0..20.0_f64), 0..5),
        ) {
            let mut team: Vec<PointState> =
                starts.iter().map(|&(x, y)| PointState::at_rest(Vector2::new(x, y))).collect();
            let mut real = obstacles(&at)?;
            let (mut gaps, mut least) = (Gaps::default(), vec![f64::INFINITY; at.len()]);
            for step in 0..40 {
                gaps.prepare(&real, &team);
                for (index, robot) in team.iter().enumerate() {
                    gaps.look(index, robot.position);
                }
                for (obstacle, least) in real.iter().zip(&mut least) {
                    for robot in &team {
                        *least = least.min(obstacle.shape.outline().approach(robot.position).gap);
                    }
                }
                let told: Vec<(u32, u64)> = gaps.least().iter().map(|(id, gap)| (*id, gap.to_bits())).collect();
                let expected: Vec<(u32, u64)> = (7..).zip(&least).map(|(id, gap)| (id, gap.to_bits())).collect();
                prop_assert_eq!(told, expected);
                for (robot, (x, y)) in team.iter_mut().zip(&moves) {
                    robot.position += Vector2::new(*x, *y) * if step % 7 < 4 { 0.3 } else { -0.25 };
                }
                if step % 10 == 9 {
                    for obstacle in &mut real {
                        obstacle.shape = obstacle.shape.moved(Vector2::new(1.0, -0.5))?;
                    }
                }
            }
        }
    }
}
