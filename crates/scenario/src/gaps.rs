//! How near the robots of a team come to obstacles, without looking at all of these for every robot at every step.

use crate::collisions::{Collision, Collisions, Meeting};
use trench_formation::Vector2;
use trench_formation::hull::{Obstacle, Outline};
use trench_formation::kinematics::PointState;

/// What rounding may do to a gap or a way is far less, m.
const ROUNDING: f64 = 1e-6;

/// The least gap between a team and each obstacle's own outline so far, and who did not stop before it. A robot goes straight from where it
/// was to where it is after a step, so that a thin wall is not crossed unseen between the two.
#[derive(Debug, Clone, Default)]
pub(crate) struct Gaps {
    /// Id and least gap of each obstacle, m.
    least: Vec<(u32, f64)>,
    /// The obstacles as they were when the robots were last looked at.
    known: Vec<Obstacle>,
    /// By how much each has moved since the step before, m; nothing where they rest.
    moved: Vec<Vector2<f64>>,
    looked_at: Vec<LookedAt>,
    /// Where the robots were a step ago, m; nothing at the first look, and where there are no obstacles.
    before: Vec<Vector2<f64>>,
    collisions: Collisions,
}

/// When a robot needs to be looked at again: once it has gone farther from there than any gap was above the least, or as far as to an outline.
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

    /// Who went through or into an obstacle.
    pub(crate) fn collisions(&self) -> &[Collision] {
        self.collisions.found()
    }

    /// Takes note of the obstacles as they are now; whether they are others, and all robots have to be looked at.
    pub(crate) fn prepare(&mut self, real: &[Obstacle], team: &[PointState]) -> bool {
        self.moved.clear();
        let same = self.known == real && self.looked_at.len() == team.len();
        if !same {
            let corner = |obstacle: &Obstacle| obstacle.shape.outline().points[0];
            self.moved.extend(self.known.iter().zip(real).map(|(then, now)| corner(now) - corner(then)));
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

    /// Looks at the way that a robot of the team that was prepared went until `time` (s), if that may say something new. As far as it may go
    /// until then, m.
    pub(crate) fn look(&mut self, index: usize, position: Vector2<f64>, time: f64) -> f64 {
        if self.known.is_empty() {
            return f64::INFINITY;
        }
        let LookedAt { position: before, room } = self.looked_at[index];
        // Gaps have fallen by no more than the way since then, and the least has not risen: of all steps since then nothing was near.
        let left = room - (position - before).norm();
        if left > 0.0 {
            return left;
        }
        let Self { least, known, moved, before, collisions, .. } = self;
        let before = before.get(index).copied();
        let mut room = f64::INFINITY;
        for (number, (obstacle, (_, least))) in known.iter().zip(least).enumerate() {
            let outline = obstacle.shape.outline();
            let gap = outline.approach(position).gap;
            // As it looks from the obstacle.
            let from = before.map(|before| before + moved.get(number).copied().unwrap_or_else(Vector2::zeros));
            let way = way(&outline, from.unwrap_or(position), (position, gap), least.max(0.0));
            *least = least.min(gap).min(way.max(0.0));
            room = room.min(gap - *least).min(gap.abs());
            let (pair, obstacle) = ((index, number), obstacle.id);
            collisions.note(Meeting { time, pair, obstacle, outline, way, gap });
        }
        self.looked_at[index] = LookedAt { position, room: room - ROUNDING };
        room - ROUNDING
    }

    /// The step is over: the next one leads from here.
    pub(crate) fn remember(&mut self, team: &[PointState]) {
        if !self.known.is_empty() {
            self.before.clear();
            self.before.extend(team.iter().map(|robot| robot.position));
        }
    }
}

/// Least gap between an outline and the straight way from a point to one with this gap, m, not positive where they meet; anything above
/// `limit` where it is above that.
fn way(outline: &Outline<'_>, from: Vector2<f64>, (to, gap): (Vector2<f64>, f64), limit: f64) -> f64 {
    let least = gap - (to - from).norm();
    if least > limit + ROUNDING { gap } else { outline.gap(&Outline { points: &[from, to], radius: 0.0 }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trench_formation::hull::{HullError, Shape};

    fn obstacles(at: &[(f64, f64)]) -> Result<Vec<Obstacle>, HullError> {
        let angle = |x, y| vec![Vector2::new(x, y), Vector2::new(x + 2.0, y), Vector2::new(x + 2.0, y + 1.0)];
        let obstacle = |(id, &(x, y))| {
            let (points, radius) = match id {
                8 => (angle(x, y), 0.5),
                9 => (angle(x, y)[..2].to_vec(), 0.0),
                _ => (vec![Vector2::new(x, y)], 0.5),
            };
            Ok(Obstacle { id, shape: Shape::new(&points, radius)? })
        };
        (7..).zip(at).map(obstacle).collect()
    }

    proptest! {
        /// The same bits, and the same collisions, as from every robot and obstacle at every step, while obstacles rest and after they have
        /// moved.
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
            let (mut before, mut then, mut collisions) = (team.clone(), real.clone(), Collisions::default());
            let corner = |obstacle: &Obstacle| obstacle.shape.outline().points[0];
            for step in 0..40 {
                let time = f64::from(step);
                gaps.prepare(&real, &team);
                for (index, robot) in team.iter().enumerate() {
                    gaps.look(index, robot.position, time);
                }
                gaps.remember(&team);
                for (index, (robot, before)) in team.iter().zip(&before).enumerate() {
                    for (number, (obstacle, least)) in real.iter().zip(&mut least).enumerate() {
                        let outline = obstacle.shape.outline();
                        let gap = outline.approach(robot.position).gap;
                        // What an obstacle has moved by is known from where it was, to the last bit.
                        let from = before.position + (corner(obstacle) - corner(&then[number]));
                        let way = outline.gap(&Outline { points: &[from, robot.position], radius: 0.0 });
                        *least = least.min(gap).min(way.max(0.0));
                        let (pair, obstacle) = ((index, number), obstacle.id);
                        collisions.note(Meeting { time, pair, obstacle, outline, way, gap });
                    }
                }
                let told: Vec<(u32, u64)> = gaps.least().iter().map(|(id, gap)| (*id, gap.to_bits())).collect();
                let expected: Vec<(u32, u64)> = (7..).zip(&least).map(|(id, gap)| (id, gap.to_bits())).collect();
                prop_assert_eq!(told, expected);
                prop_assert_eq!(gaps.collisions(), collisions.found());
                before.clone_from(&team);
                for (robot, (x, y)) in team.iter_mut().zip(&moves) {
                    robot.position += Vector2::new(*x, *y) * if step % 7 < 4 { 0.3 } else { -0.25 };
                }
                then.clone_from(&real);
                if step % 10 == 9 {
                    for obstacle in &mut real {
                        obstacle.shape = obstacle.shape.moved(Vector2::new(1.0, -0.5))?;
                    }
                }
            }
        }
    }
}
