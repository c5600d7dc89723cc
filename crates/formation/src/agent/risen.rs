//! Hulls that spring up. Obstacles that move, or of which more is seen, combine from one tick to the next (7.4), and a robot beside them is
//! deep in the potential of the hull, which would throw it away. So the hull comes up to it as fast as something that moves.
use super::Surroundings;
use crate::Vector2;
use crate::hull::Approach;
use crate::kinematics::PointState;

/// How near apparent obstacles are to one robot, as its law sees them.
#[derive(Debug, Clone, Default)]
pub(super) struct Risen {
    /// Those within the reach of the potential.
    hulls: Vec<Hull>,
    before: Vec<Hull>,
}

/// As the law sees an apparent obstacle.
#[derive(Debug, Clone, Copy)]
struct Hull {
    id: u32,
    /// m.
    gap: f64,
    /// How fast it rises, m/s: what that brings into V is the obstacle's work.
    rising: f64,
}

/// How far potentials reach (m), how fast hulls rise (m/s), and the time since the last look (s); none at the first.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    pub(super) cut: f64,
    pub(super) rising: f64,
    pub(super) step: Option<f64>,
}

impl Risen {
    /// Looks at what is near the robot now: no gap has closed faster than robot and obstacle move, and `pace.rising` besides. What a remedy
    /// saw instead of an obstacle (by its index) is `seen` (m): once the remedy is over that rises, too. Whether anything is near.
    pub(super) fn follow(
        &mut self,
        around: &Surroundings<'_>,
        (since, robot): (f64, PointState),
        pace: Pace,
        seen: impl Fn(usize) -> Option<f64>,
    ) -> bool {
        core::mem::swap(&mut self.hulls, &mut self.before);
        self.hulls.clear();
        for (index, obstacle) in around.apparent.iter().enumerate() {
            if obstacle.shape.is_beyond(robot.position - around.displacement(index, since), pace.cut) {
                continue;
            }
            let Approach { gap, towards } = around.approach(index, since, robot.position);
            let before = self.before.iter().find(|hull| hull.id == obstacle.id).map_or(pace.cut, |hull| hull.gap);
            // Who flees does not make the hull rise faster.
            let closing = (robot.velocity - around.velocity(index)).dot(&towards);
            let closed = |step: f64| step * (closing + pace.rising);
            let least = pace.step.map_or(gap, |step| before - closed(step));
            // Who is beyond reach of it meets all of it.
            let risen = seen(index).unwrap_or(least).min(pace.cut).max(gap);
            let rising = pace.step.filter(|step| *step > 0.0).map_or(0.0, |step| pace.rising.min((risen - gap) / step));
            self.hulls.push(Hull { id: obstacle.id, gap: risen, rising });
        }
        !self.hulls.is_empty()
    }

    /// How an apparent obstacle that lies at `approach` to a robot is seen: the hull as far as it has risen, or what is in it, whichever is
    /// nearer; and the velocity at which it rises towards the robot, m/s.
    pub(super) fn approach(
        &self,
        around: &Surroundings<'_>,
        (index, since): (usize, f64),
        robot: PointState,
        approach: Approach,
    ) -> (Approach, Vector2<f64>) {
        let obstacle = &around.apparent[index];
        let Some(hull) = self.hulls.iter().find(|hull| hull.id == obstacle.id && hull.gap > approach.gap) else {
            return (approach, Vector2::zeros());
        };
        let seen = robot.position - around.displacement(index, since);
        let members = around.real.iter().filter(|real| obstacle.members.contains(&real.id));
        let nearest = members.map(|real| real.shape.outline().approach(seen)).min_by(|a, b| a.gap.total_cmp(&b.gap));
        match nearest.filter(|nearest| nearest.gap < hull.gap) {
            Some(nearest) => (nearest, Vector2::zeros()),
            None => (Approach { gap: hull.gap, ..approach }, -hull.rising * approach.towards),
        }
    }
}
