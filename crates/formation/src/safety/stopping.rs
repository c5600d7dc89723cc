//! The safety filter of robots that are commanded by accelerations (3.4): what [`SafetyFilter`](super::SafetyFilter) is to wheels.
//!
//! A robot's *stopping way* is the straight piece on which it comes to rest when it brakes as it can. Braking shortens the way of
//! the robot that brakes and moves nobody else's, so ways that are apart stay apart when everybody brakes. Once a tick
//! each robot draws the line in the middle between its way and that of each neighbour; both see the same line, each keeps
//! its ways on its own side until the next tick, and bodies never meet, whatever the laws want (docs/theory/chapter7.md).
use crate::Vector2;
use crate::hull::Outline;
use crate::kinematics::PointState;
use crate::laws::Capability;

/// Rounds of mending a velocity that crosses several lines, before braking decides.
const ROUNDS: usize = 4;
/// Part of the acceleration with which moving obstacles are met: the rest is left for what comes besides.
const EVADING: f64 = 0.7;

/// Half-planes that a robot's stopping way must not leave until the next tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Unit vector across the line, away from the robot.
    pub outward: Vector2<f64>,
    /// The way's points x have outward . x at most this, m.
    pub reach: f64,
}

/// A robot and what it can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopping {
    /// Radius of its body, with what is to be left between bodies, m.
    pub radius: f64,
    /// What it can do.
    pub capability: Capability,
}

/// Something that moves and does not brake.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing<'a> {
    /// Where it was at the tick.
    pub outline: Outline<'a>,
    /// m/s.
    pub velocity: Vector2<f64>,
    /// Time since the tick, s.
    pub since: f64,
}

impl Stopping {
    /// From where the robot is to where it stands when it brakes from now on.
    pub fn way(&self, robot: PointState) -> [Vector2<f64>; 2] {
        let reach = robot.velocity.norm() / (2.0 * self.capability.acceleration);
        [robot.position, robot.position + reach * robot.velocity]
    }

    /// The line between this robot's way and that of another under the same filter.
    pub fn between(&self, robot: PointState, other: PointState) -> Line {
        let (mine, theirs) = closest(self.way(robot), self.way(other));
        let apart = theirs - mine;
        let outward = apart.try_normalize(1e-12).unwrap_or_else(|| other_side(robot.position, other.position));
        Line { outward, reach: outward.dot(&(0.5 * (mine + theirs))) - self.radius }
    }

    /// The line before an obstacle that rests.
    pub fn before(&self, robot: PointState, outline: &Outline<'_>) -> Line {
        let way = self.way(robot);
        let ends = way.map(|end| outline.approach(end));
        let mut best = if ends[1].gap < ends[0].gap { (way[1], ends[1]) } else { (way[0], ends[0]) };
        for corner in outline.points {
            let beside = foot(*corner, way);
            let approach = outline.approach(beside);
            if approach.gap < best.1.gap {
                best = (beside, approach);
            }
        }
        let (point, approach) = best;
        Line { outward: approach.towards, reach: approach.towards.dot(&point) + approach.gap - self.radius }
    }

    /// How far two robots can be from each other, at most, for the line between them to matter within `period` (s), m.
    pub fn range(&self, period: f64) -> f64 {
        let Capability { speed, acceleration } = self.capability;
        2.0 * (self.radius + speed * period + speed * speed / acceleration)
    }

    /// What [`Self::admit`] leaves of what the robot of an index wants, for a step of `step` (s), among others under the same filter and
    /// nothing else.
    pub fn admit_among(&self, robots: &[PointState], index: usize, wanted: Vector2<f64>, step: f64) -> Vector2<f64> {
        let (robot, range) = (robots[index], self.range(step));
        let others = robots.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, other)| other);
        let near = others.filter(|other| (other.position - robot.position).norm() < range);
        let lines: Vec<Line> = near.map(|other| self.between(robot, *other)).collect();
        self.admit(robot, wanted, &lines, core::iter::empty(), step)
    }

    /// The acceleration nearest to `wanted` found that keeps to all `lines` for a step of `step` (s), and out of the way of what passes as
    /// far as that allows. A robot whose way keeps to all lines can always go on: braking does.
    pub fn admit<'a>(
        &self,
        robot: PointState,
        wanted: Vector2<f64>,
        lines: &[Line],
        passing: impl Iterator<Item = Passing<'a>> + Clone,
        step: f64,
    ) -> Vector2<f64> {
        let most = step * self.capability.acceleration;
        let desired = robot.velocity + step * wanted;
        let mut next = desired;
        for _ in 0..ROUNDS {
            let before = next;
            for obstacle in passing.clone() {
                let approach = obstacle.outline.approach(robot.position - obstacle.since * obstacle.velocity);
                let room = (approach.gap - self.radius).max(0.0);
                let closing = (2.0 * EVADING * self.capability.acceleration * room).sqrt();
                next = limited(next, approach.towards, approach.towards.dot(&obstacle.velocity) + closing);
            }
            for line in lines {
                next = limited(next, line.outward, self.admitted(robot.position, next, line, step));
            }
            if next == before {
                break;
            }
        }
        if next == desired {
            return wanted;
        }
        next = next.cap_magnitude(self.capability.speed);
        next = robot.velocity + (next - robot.velocity).cap_magnitude(most);
        let braked = robot.velocity - robot.velocity.cap_magnitude(most);
        let keeps_to = |line: &Line, next: Vector2<f64>| {
            line.outward.dot(&next) <= self.admitted(robot.position, next, line, step) + 1e-12
        };
        // Braking keeps to all lines of bodies that were apart. Bodies that are not may part: what comes no farther across is no worse.
        let across = |line: &Line, next: Vector2<f64>| {
            line.outward.dot(&next) * (step + next.norm() / (2.0 * self.capability.acceleration))
        };
        let is_no_worse =
            |line: &Line, next: Vector2<f64>| !keeps_to(line, braked) && across(line, next) <= across(line, braked);
        let keeps = |next: Vector2<f64>| lines.iter().all(|line| keeps_to(line, next) || is_no_worse(line, next));
        let blend = |part: f64| braked + part * (next - braked);
        let part = [1.0, 0.75, 0.5, 0.25].into_iter().find(|part| keeps(blend(*part))).unwrap_or(0.0);
        (blend(part) - robot.velocity) / step
    }

    /// How fast the robot may be across a line after a step, at the speed of `next`, m/s.
    fn admitted(&self, position: Vector2<f64>, next: Vector2<f64>, line: &Line, step: f64) -> f64 {
        let room = line.reach - line.outward.dot(&position);
        let limit = room / (step + next.norm() / (2.0 * self.capability.acceleration));
        limit.max(-self.capability.speed)
    }
}

fn limited(velocity: Vector2<f64>, direction: Vector2<f64>, most: f64) -> Vector2<f64> {
    velocity - (direction.dot(&velocity) - most).max(0.0) * direction
}

fn other_side(position: Vector2<f64>, other: Vector2<f64>) -> Vector2<f64> {
    (other - position).try_normalize(0.0).unwrap_or_else(Vector2::x)
}

/// The point of a straight piece that is nearest to `point`.
fn foot(point: Vector2<f64>, [start, end]: [Vector2<f64>; 2]) -> Vector2<f64> {
    let edge = end - start;
    let squared = edge.norm_squared();
    let fraction = if squared > 0.0 { ((point - start).dot(&edge) / squared).clamp(0.0, 1.0) } else { 0.0 };
    start + fraction * edge
}

/// The points of two straight pieces that do not cross where they are nearest to each other.
fn closest(a: [Vector2<f64>; 2], b: [Vector2<f64>; 2]) -> (Vector2<f64>, Vector2<f64>) {
    let pairs = [(a[0], foot(a[0], b)), (a[1], foot(a[1], b)), (foot(b[0], a), b[0]), (foot(b[1], a), b[1])];
    let nearer = |best: (Vector2<f64>, Vector2<f64>), pair: (Vector2<f64>, Vector2<f64>)| {
        if (pair.1 - pair.0).norm_squared() < (best.1 - best.0).norm_squared() { pair } else { best }
    };
    pairs.into_iter().reduce(nearer).unwrap_or((a[0], b[0]))
}
