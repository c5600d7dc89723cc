//! What is near each robot at a tick: the robots ahead that may push it, and the lines of the safety filter.
use super::ChainScenario;
use super::neighbours::Neighbours;
use crate::Vector2;
use crate::hull::Obstacle;
use crate::kinematics::PointState;
use crate::safety::{Line, Passing, Stopping};

/// Interactions are of finite range: a robot is told of no others than those within it.
#[derive(Debug, Clone, Default)]
pub(super) struct Vicinity {
    neighbours: Neighbours,
    /// What is near the robots, one robot after the other: it ends there for each of them.
    ahead: Vec<PointState>,
    lines: Vec<Line>,
    ends: Vec<Ends>,
}

#[derive(Debug, Clone, Copy)]
struct Ends {
    ahead: usize,
    lines: usize,
}

impl Vicinity {
    /// Looks around at a tick. `seen` and `real` are robots and obstacles then.
    pub(super) fn look<T>(&mut self, scenario: &ChainScenario<T>, seen: &[PointState], real: &[Obstacle]) {
        let reach = reach_of_potentials(scenario);
        let safety = scenario.options.safety.as_ref();
        if reach.is_none() && safety.is_none() {
            return;
        }
        let period = scenario.step * f64::from(scenario.steps_per_tick);
        let range = safety.map_or(0.0, |safety| safety.range(period));
        self.neighbours.update(range.max(reach.unwrap_or(0.0)), seen);
        self.ahead.clear();
        self.lines.clear();
        self.ends.clear();
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
            if let Some(safety) = safety {
                self.lines.extend(resting(scenario, real, safety, *robot, range));
            }
            self.ends.push(Ends { ahead: self.ahead.len(), lines: self.lines.len() });
        }
    }

    /// Robots ahead of the one at `index` besides its leader, by rank: those within reach, or all where reach has no bound.
    pub(super) fn ahead<'a, T>(
        &'a self,
        scenario: &ChainScenario<T>,
        seen: &'a [PointState],
        index: usize,
    ) -> &'a [PointState] {
        match self.ends.get(index) {
            Some(end) if reach_of_potentials(scenario).is_some() => &self.ahead[self.begin(index).ahead..end.ahead],
            _ => &seen[..index.saturating_sub(1)],
        }
    }

    fn begin(&self, index: usize) -> Ends {
        index.checked_sub(1).map_or(Ends { ahead: 0, lines: 0 }, |before| self.ends[before])
    }

    /// What the filter leaves of the acceleration of a robot, `since` seconds after the tick.
    pub(super) fn admit<T>(
        &self,
        scenario: &ChainScenario<T>,
        real: &[Obstacle],
        (index, robot): (usize, PointState),
        wanted: Vector2<f64>,
        since: f64,
    ) -> Vector2<f64> {
        let (Some(safety), Some(end)) = (&scenario.options.safety, self.ends.get(index)) else { return wanted };
        let passing = real.iter().zip(scenario.velocities()).filter(|(_, velocity)| *velocity != Vector2::zeros());
        let passing =
            passing.map(|(obstacle, velocity)| Passing { outline: obstacle.shape.outline(), velocity, since });
        safety.admit(robot, wanted, &self.lines[self.begin(index).lines..end.lines], passing, scenario.step)
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

/// Lines before the obstacles that rest.
fn resting<'a, T>(
    scenario: &'a ChainScenario<T>,
    real: &'a [Obstacle],
    safety: &'a Stopping,
    robot: PointState,
    range: f64,
) -> impl Iterator<Item = Line> + 'a {
    let at_rest = real.iter().zip(scenario.velocities()).filter(|(_, velocity)| *velocity == Vector2::zeros());
    let near = at_rest
        .filter(move |(obstacle, _)| !obstacle.shape.is_beyond(robot.position, range))
        .map(|(obstacle, _)| obstacle.shape.outline())
        .filter(move |outline| outline.approach(robot.position).gap < range);
    near.map(move |outline| safety.before(robot, &outline))
}
