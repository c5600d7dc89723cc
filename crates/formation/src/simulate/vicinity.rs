//! What is near each robot at a tick: the robots ahead that may push it, and the lines of the safety filter.
use super::ChainScenario;
use super::links::Links;
use super::marks::Marks;
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
    /// Whose ends these are, in order: nothing is near the others.
    busy: Vec<u32>,
    /// Whether anything was looked for.
    looked: bool,
    /// Who is certainly clear of obstacles, however far any acts; and who has nobody and nothing near it but its leader.
    is_clear: Marks,
    is_alone: Marks,
    /// Whether the robots ahead are those of the lists: where potentials have no bound, all are.
    bounded: bool,
    /// Indices of the real obstacles that rest, and whether all do.
    resting: Vec<usize>,
    all_rest: bool,
    /// Whether what is clear of obstacles at a tick is so until the next: robots act but once, or there are none.
    stays_clear: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
        links: &Links,
    ) {
        let reach = reach_of_potentials(scenario);
        let safety = scenario.options.safety.as_ref();
        (self.bounded, self.looked) = (reach.is_some(), reach.is_some() || safety.is_some());
        self.is_alone.clear(seen.len());
        if !self.looked {
            return;
        }
        let period = scenario.step * f64::from(scenario.steps_per_tick);
        let range = safety.map_or(0.0, |safety| safety.range(period));
        let made = self.neighbours.update(range.max(reach.unwrap_or(0.0)), seen, apparent);
        self.ahead.clear();
        self.lines.clear();
        self.ends.clear();
        self.busy.clear();
        let at_rest = |(_, velocity): &(usize, Vector2<f64>)| *velocity == Vector2::zeros();
        let obstacles = (0..real.len()).zip(scenario.velocities());
        self.resting.clear();
        self.resting.extend(obstacles.filter(at_rest).map(|(index, _)| index));
        self.all_rest = self.resting.len() == real.len();
        self.stays_clear = self.all_rest && (scenario.steps_per_tick == 1 || real.is_empty());
        let cut = scenario.potential.cut();
        if made {
            self.mark_clear(seen.len(), cut.max(range));
        }
        // Robots ahead are those of the lists only where potentials are bounded.
        let reach_squared = reach.map_or(0.0, |reach| reach * reach);
        let Self { neighbours, ahead, lines, ends, busy, resting, all_rest, .. } = self;
        if self.stays_clear && self.bounded {
            self.is_alone.mark_without(&self.is_clear, neighbours.awake());
        }
        self.is_alone.for_each_without(seen.len(), |index| {
            let robot = &seen[index];
            for other in neighbours.of(index) {
                let at = *other as usize;
                let distance_squared = (seen[at].position - robot.position).norm_squared();
                // The leader of a robot is not among those ahead of it: it has a potential of its own, where it is heard.
                let is_ahead = at + 1 < index || (at + 1 == index && !links.hears(index));
                if is_ahead && distance_squared < reach_squared {
                    ahead.push(seen[at]);
                }
                if let Some(safety) = safety.filter(|_| distance_squared < range * range) {
                    lines.push(safety.between(*robot, seen[at]));
                }
            }
            if let Some(safety) = safety.filter(|_| !(*all_rest && neighbours.clear(index) > range)) {
                for obstacle in &*resting {
                    let shape = &real[*obstacle].shape;
                    if !shape.is_beyond(robot.position, range) {
                        let outline = shape.outline();
                        let near = outline.approach(robot.position).gap < range;
                        lines.extend(near.then(|| safety.before(*robot, &outline)));
                    }
                }
            }
            busy.push(index as u32);
            ends.push(Ends { ahead: ahead.len() as u32, lines: lines.len() as u32 });
        });
        self.mark_alone(cut);
    }

    /// Who is farther from all obstacles than `distance` (m) until the lists of neighbours are made anew.
    fn mark_clear(&mut self, count: usize, distance: f64) {
        self.is_clear.clear(count);
        let clear = (0..count).filter(|index| self.neighbours.clear(*index) > distance);
        clear.for_each(|index| self.is_clear.set(index));
    }

    /// Some of those that were looked at have nothing near them either, nor an obstacle within `cut` (m).
    fn mark_alone(&mut self, cut: f64) {
        let mut begin = Ends::default();
        for (index, end) in self.busy.iter().zip(&self.ends) {
            let index = *index as usize;
            if *end == begin && self.bounded && self.clear(index) > cut {
                self.is_alone.set(index);
            }
            begin = *end;
        }
    }

    /// Robots ahead of the one at `index`, by rank, without its leader if it `hears` that: those within reach, or all where reach has no bound.
    #[inline]
    pub(super) fn ahead<'a>(&'a self, seen: &'a [PointState], index: usize, hears: bool) -> &'a [PointState] {
        if !(self.looked && self.bounded) {
            return &seen[..index.saturating_sub(usize::from(hears))];
        }
        self.near(index).map_or(&[], |[begin, end]| &self.ahead[begin.ahead as usize..end.ahead as usize])
    }

    /// No apparent obstacle is nearer to a robot than this until the next tick, m; 0 where that is not known.
    #[inline]
    pub(super) fn clear(&self, index: usize) -> f64 {
        if self.looked && self.stays_clear { self.neighbours.clear(index) } else { 0.0 }
    }

    /// Whether a robot has nobody and nothing near it but its leader until the next tick: no robot ahead, no obstacle within the cut of its
    /// potential, nothing that the safety filter looks at.
    #[inline]
    pub(super) fn is_alone(&self, index: usize) -> bool {
        self.is_alone.get(index)
    }

    /// What rests has changed.
    pub(super) fn forget(&mut self) {
        self.neighbours.forget();
    }

    /// Where what is near a robot begins and ends.
    fn near(&self, index: usize) -> Option<[Ends; 2]> {
        let at = self.busy.binary_search(&(index as u32)).ok()?;
        let begin = at.checked_sub(1).map_or_else(Ends::default, |before| self.ends[before]);
        Some([begin, self.ends[at]])
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
        let Some(safety) = &scenario.options.safety else { return wanted };
        let near = self.near(index).map(|[begin, end]| &self.lines[begin.lines as usize..end.lines as usize]);
        let lines = near.unwrap_or_default();
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
