//! Robots that an obstacle did not stop.

use trench_formation::hull::Outline;

/// Which robots of a team went through or into which obstacles. Robots are points here: their bodies have gaps of their own.
#[derive(Debug, Clone, Default)]
pub(crate) struct Collisions {
    /// Each robot with each obstacle once, in the order in which they first met.
    found: Vec<Collision>,
    /// Who is on or in what now, by indices: as long as it stays there, it is the same collision.
    touching: Vec<(usize, usize)>,
}

/// A robot's way met the outline of an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Collision {
    /// When that was seen first: at the end of the step on whose way it was, s.
    pub(crate) time: f64,
    /// Index in the team.
    pub(crate) robot: usize,
    /// Its id.
    pub(crate) obstacle: u32,
    /// Whether the robot was inside at the end of that step, and not out again, or beyond a wall, which has no inside.
    pub(crate) stayed: bool,
    /// How often it happened.
    pub(crate) times: usize,
}

/// How a robot's way of a step lies to an obstacle.
pub(crate) struct Meeting<'a> {
    /// s, at the end of the step.
    pub(crate) time: f64,
    /// Indices of the robot and the obstacle.
    pub(crate) pair: (usize, usize),
    pub(crate) obstacle: u32,
    pub(crate) outline: Outline<'a>,
    /// Least gap of the way, m; not positive where it meets the outline.
    pub(crate) way: f64,
    /// Gap at the end of the step, m.
    pub(crate) gap: f64,
}

impl Collisions {
    pub(crate) fn found(&self) -> &[Collision] {
        &self.found
    }

    /// Takes note of the way of a step.
    pub(crate) fn note(&mut self, Meeting { time, pair, obstacle, outline, way, gap }: Meeting<'_>) {
        // Nearly always.
        if way > 0.0 && self.touching.is_empty() {
            return;
        }
        let known = self.touching.iter().position(|other| *other == pair);
        let stays = gap <= 0.0;
        match known {
            Some(known) if !stays => {
                self.touching.swap_remove(known);
            }
            None if way <= 0.0 && stays => self.touching.push(pair),
            _ => {}
        }
        if known.is_some() || way > 0.0 {
            return;
        }
        let same = |other: &&mut Collision| (other.robot, other.obstacle) == (pair.0, obstacle);
        match self.found.iter_mut().find(same) {
            Some(again) => again.times += 1,
            None => {
                let has_inside = outline.radius > 0.0 || outline.points.len() > 2;
                self.found.push(Collision { time, robot: pair.0, obstacle, stayed: stays && has_inside, times: 1 });
            }
        }
    }
}
