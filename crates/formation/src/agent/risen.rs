//! Hulls that spring up. Obstacles that move, or of which more is seen, combine from one tick to the next (7.4), and a robot beside them is
//! deep in the potential of the hull, which would throw it away. So the hull comes up to it as fast as something that moves.
use super::Surroundings;
use crate::Vector2;
use crate::hull::Approach;
use crate::kinematics::PointState;

/// The apparent obstacles that are near to one robot, as its law sees them.
#[derive(Debug, Clone, Default)]
pub(super) struct Risen {
    hulls: Vec<Hull>,
    before: Vec<Hull>,
}

#[derive(Debug, Clone, Copy)]
struct Hull {
    id: u32,
    /// As far as it has risen, m.
    gap: f64,
    /// Where it lies so, or what is in it, whichever is nearer.
    seen: Approach,
    /// The velocity at which it rises towards the robot, m/s: what that brings into V is the obstacle's work.
    rising: Vector2<f64>,
}

/// How far potentials reach (m), how fast hulls rise (m/s), and the time since the last look (s); none at the first.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    pub(super) cut: f64,
    pub(super) rising: f64,
    pub(super) step: Option<f64>,
}

impl Risen {
    /// Looks at what is near the robot now: no gap has closed faster than robot and obstacle move, and `pace.rising` besides. The gap that a
    /// remedy saw instead of that of an obstacle (by its index) is `instead` (m): once the remedy is over that rises, too.
    pub(super) fn follow(
        &mut self,
        around: &Surroundings<'_>,
        (since, robot): (f64, PointState),
        pace: Pace,
        instead: impl Fn(usize) -> Option<f64>,
    ) {
        core::mem::swap(&mut self.hulls, &mut self.before);
        self.hulls.clear();
        let is_near = |index: &usize| around.is_near(*index, since, robot.position, pace.cut);
        for index in (0..around.apparent.len()).filter(is_near) {
            let (id, whole) = (around.apparent[index].id, around.approach(index, since, robot.position));
            let before = self.before.iter().find(|hull| hull.id == id).map_or(pace.cut, |hull| hull.gap);
            // Who flees does not make the hull rise faster.
            let closing = (robot.velocity - around.velocity(index)).dot(&whole.towards);
            let closed = |step: f64| step * (closing + pace.rising);
            let least = pace.step.map_or(whole.gap, |step| before - closed(step));
            // Who is beyond reach of it meets all of it.
            let gap = instead(index).unwrap_or(least).min(pace.cut).max(whole.gap);
            let below = gap - whole.gap;
            let rising = pace.step.filter(|step| *step > 0.0).map_or(0.0, |step| pace.rising.min(below / step));
            let members = || around.approach_of_members(index, since, robot.position);
            let (seen, rising) = match (below > 0.0).then(members).flatten() {
                Some(member) if member.gap < gap => (member, Vector2::zeros()),
                _ => (Approach { gap, ..whole }, -rising * whole.towards),
            };
            self.hulls.push(Hull { id, gap, seen, rising });
        }
    }

    /// How the apparent obstacle of an id is seen, and the velocity at which it rises towards the robot, m/s; nothing of those that are far.
    pub(super) fn seen(&self, id: u32) -> Option<(Approach, Vector2<f64>)> {
        self.hulls.iter().find(|hull| hull.id == id).map(|hull| (hull.seen, hull.rising))
    }
}
