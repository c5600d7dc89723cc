//! What is near each robot at a tick: the robots ahead that may push it, and the lines of the safety filter.
use super::ChainScenario;
use super::neighbours::Neighbours;
use crate::Vector2;
use crate::hull::{ApparentObstacle, Obstacle};
use crate::kinematics::PointState;
use crate::safety::{Line, Passing};

/// Interactions are of finite range: a robot is told of no others than those within it.
#[derive(Debug, Clone, Default)]
pub(super) struct Vicinity {
    neighbours: Neighbours,
    /// What is near the robots, one robot after the other: it ends there for each of them.
    ahead: Vec<PointState>,
    lines: Vec<Line>,
    ends: Vec<Ends>,
    /// Whether the robots ahead are those of the lists: where potentials have no bound, all are.
    bounded: bool,
    /// Indices of the real obstacles that rest, and whether all do.
    resting: Vec<usize>,
    all_rest: bool,
    /// Whether what is clear of obstacles at a tick is so until the next: robots act but once, or there are none.
    stays_clear: bool,
}

#[derive(Debug, Clone, Copy)]
struct Ends {
    ahead: u32,
    lines: u32,
}

impl Vicinity {
    /// Looks around at a tick. `seen` and `real` are robots and obstacles then.
    pub(super) fn look<T>(
        &mut self,
        scenario: &ChainScenario<T>,
        seen: &[PointState],
        (real, apparent): (&[Obstacle], &[ApparentObstacle]),
    ) {
        let reach = reach_of_potentials(scenario);
        let safety = scenario.options.safety.as_ref();
        self.bounded = reach.is_some();
        if reach.is_none() && safety.is_none() {
            return;
        }
        let period = scenario.step * f64::from(scenario.steps_per_tick);
        let range = safety.map_or(0.0, |safety| safety.range(period));
        self.neighbours.update(range.max(reach.unwrap_or(0.0)), seen, apparent);
        self.ahead.clear();
        self.lines.clear();
        self.ends.clear();
        let at_rest = |(_, velocity): &(usize, Vector2<f64>)| *velocity == Vector2::zeros();
        let obstacles = (0..real.len()).zip(scenario.velocities());
        self.resting.clear();
        self.resting.extend(obstacles.filter(at_rest).map(|(index, _)| index));
        self.all_rest = self.resting.len() == real.len();
        self.stays_clear = self.all_rest && (scenario.steps_per_tick == 1 || real.is_empty());
        let reach_squared = reach.map_or(0.0, |reach| reach * reach);
        for (index, robot) in seen.iter().enumerate() {
            for other in self.neighbours.of(index) {
                let at = *other as usize;
                let distance_squared = (seen[at].position - robot.position).norm_squared();
                // The leader of a robot is not among those ahead of it: it has a potential of its own.
                if at + 1 < index && distance_squared < reach_squared {
                    self.ahead.push(seen[at]);
                }
                if let Some(safety) = safety.filter(|_| distance_squared < range * range) {
                    self.lines.push(safety.between(*robot, seen[at]));
                }
            }
            if let Some(safety) = safety.filter(|_| !(self.all_rest && self.neighbours.clear(index) > range)) {
                for obstacle in &self.resting {
                    let shape = &real[*obstacle].shape;
                    if !shape.is_beyond(robot.position, range) {
                        let outline = shape.outline();
                        let near = outline.approach(robot.position).gap < range;
                        self.lines.extend(near.then(|| safety.before(*robot, &outline)));
                    }
                }
            }
            self.ends.push(Ends { ahead: self.ahead.len() as u32, lines: self.lines.len() as u32 });
        }
    }

    /// Robots ahead of the one at `index` besides its leader, by rank: those within reach, or all where reach has no bound.
    #[inline]
    pub(super) fn ahead<'a>(&'a self, seen: &'a [PointState], index: usize) -> &'a [PointState] {
        match self.ends.get(index) {
            Some(end) if self.bounded => &self.ahead[self.begin(index).ahead as usize..end.ahead as usize],
            _ => &seen[..index.saturating_sub(1)],
        }
    }

    /// No apparent obstacle is nearer to a robot than this until the next tick, m; 0 where that is not known.
    #[inline]
    pub(super) fn clear(&self, index: usize) -> f64 {
        let known = self.stays_clear && index < self.ends.len();
        if known { self.neighbours.clear(index) } else { 0.0 }
    }

    /// Whether a robot has nobody and nothing near it but its leader until the next tick: no robot ahead, no obstacle within `cut` (m),
    /// nothing that the safety filter looks at.
    #[inline]
    pub(super) fn is_alone(&self, index: usize, cut: f64) -> bool {
        let Some(end) = self.ends.get(index) else { return false };
        let begin = self.begin(index);
        (begin.ahead, begin.lines) == (end.ahead, end.lines) && self.bounded && self.clear(index) > cut
    }

    /// What rests has changed.
    pub(super) fn forget(&mut self) {
        self.neighbours.forget();
    }

    #[inline]
    fn begin(&self, index: usize) -> Ends {
        index.checked_sub(1).map_or(Ends { ahead: 0, lines: 0 }, |before| self.ends[before])
    }

    /// What the filter leaves of the acceleration of a robot, `since` seconds after the tick.
    #[inline]
    pub(super) fn admit<T>(
        &self,
        scenario: &ChainScenario<T>,
        real: &[Obstacle],
        (index, robot): (usize, PointState),
        wanted: Vector2<f64>,
        since: f64,
    ) -> Vector2<f64> {
        let (Some(safety), Some(end)) = (&scenario.options.safety, self.ends.get(index)) else { return wanted };
        let lines = &self.lines[self.begin(index).lines as usize..end.lines as usize];
        if lines.is_empty() && self.all_rest {
            return wanted;
        }
        let passing = real.iter().zip(scenario.velocities()).filter(|(_, velocity)| *velocity != Vector2::zeros());
        let passing =
            passing.map(|(obstacle, velocity)| Passing { outline: obstacle.shape.outline(), velocity, since });
        safety.admit(robot, wanted, lines, passing, scenario.step)
    }
}

/// How far robots act on each other by their potentials until the next tick, m; nothing if that has no bound, or all matter.
fn reach_of_potentials<T>(scenario: &ChainScenario<T>) -> Option<f64> {
    if scenario.encroaching.robot_radius().is_some() {
        return None;
    }
    let later = match (scenario.steps_per_tick, scenario.options.limits) {
        (1, _) => 0.0,
        (ticks, Some(limits)) => 2.0 * limits.speed * scenario.step * f64::from(ticks),
        (_, None) => return None,
    };
    Some(scenario.zoning.radii().rho_hat + later)
}
