//! Which robots of a chain hear their leaders, and where those go that do not (Remarks 6.2.1 and 8.4.1).
use super::{BrokenLink, QueueChange, QueueEvent};
use crate::Vector2;
use crate::avoidance::behind_obstacles;
use crate::curve::Placed;
use crate::hull::ApparentObstacle;
use crate::kinematics::PointState;
use crate::laws::{GoalMotion, RigidMotion};

/// Nearer to the team goal than this, along the segment, a robot on its way there slows down, m.
const SLOWING: f64 = 0.5;

/// Which followers do not hear their leaders now, and what befell links so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Links {
    /// Indices, in order: mostly none.
    unheard: Vec<usize>,
    now: Vec<usize>,
    /// Those of them whose leaders are too far off.
    beyond: Vec<usize>,
    changes: Vec<QueueChange>,
}

impl Links {
    /// Looks at the links at `time` (s): they reach `reach` (m), and some are `broken` for a time. Whose leader was too far off follows it
    /// again from `back` (m) on, whose link was broken as soon as it is whole.
    pub(super) fn look(&mut self, time: f64, robots: &[PointState], (reach, back): (f64, f64), broken: &[BrokenLink]) {
        let is_broken = |index: usize| broken.iter().any(|link| link.robot == index && link.holds(time));
        let far =
            |pair: &[PointState], reach: f64| (pair[0].position - pair[1].position).norm_squared() > reach * reach;
        self.now.clear();
        // Mostly all hear: without asking one by one.
        let parted = || robots.windows(2).fold(false, |parted, pair| parted | far(pair, reach));
        if self.unheard.is_empty() && broken.is_empty() && !parted() {
            return;
        }
        let before = core::mem::take(&mut self.beyond);
        for (pair, index) in robots.windows(2).zip(1..) {
            let is_far = far(pair, if before.binary_search(&index).is_ok() { back } else { reach });
            if is_far {
                self.beyond.push(index);
            }
            if is_far || (!broken.is_empty() && is_broken(index)) {
                self.now.push(index);
            }
        }
        if self.now == self.unheard {
            return;
        }
        let new = self.now.iter().filter(|index| self.unheard.binary_search(index).is_err());
        let lost = new.map(|&robot| {
            let event = if far(&robots[robot - 1..=robot], reach) { QueueEvent::Lost } else { QueueEvent::Retargets };
            QueueChange { time, robot, event }
        });
        let whole = self.unheard.iter().filter(|index| self.now.binary_search(index).is_err());
        let whole = whole.map(|&robot| QueueChange { time, robot, event: QueueEvent::Follows });
        self.changes.extend(lost.chain(whole));
        core::mem::swap(&mut self.now, &mut self.unheard);
    }

    /// Whether the robot of an index hears its leader; the first has none to hear.
    #[inline]
    pub(super) fn hears(&self, index: usize) -> bool {
        self.unheard.is_empty() || self.unheard.binary_search(&index).is_err()
    }

    /// What befell links, in time.
    pub(super) fn changes(&self) -> &[QueueChange] {
        &self.changes
    }
}

/// The goal point of a robot at `robot` (m) that goes to the segment and along it to `goal` (m, frame of the segment), at `speed` (m/s): where
/// it is nearest to the segment, moving on as long as none of the robots `ahead` is on its way within `apart` (m): their repulsion is bounded, and who
/// is drawn along would come through it. Where apparent obstacles that repel within `reach` (m) are on the segment, a point that rests behind them.
pub(super) fn towards_goal(
    segment: &Placed<'_>,
    motion: &RigidMotion,
    robot: Vector2<f64>,
    (goal, speed): (Vector2<f64>, f64),
    (ahead, apart): (&[PointState], f64),
    (apparent, reach): (&[ApparentObstacle], f64),
) -> GoalMotion {
    let (foot, curve) = (segment.nearest(robot), segment.curve());
    let left = curve.way(foot.arc_length, curve.nearest(goal).arc_length);
    let still = motion.at(foot.point);
    if let Some(behind) = behind_obstacles(segment, apparent, reach, (foot.arc_length, left)) {
        return motion.at(segment.at(behind).point);
    }
    let on = speed * (left / SLOWING).clamp(-1.0, 1.0) * segment.at(curve.ahead(foot.arc_length, left)).tangent;
    let is_before = |other: &PointState| {
        let way = other.position - robot;
        way.norm_squared() < apart * apart && way.dot(&on) > 0.0
    };
    if ahead.iter().any(is_before) { still } else { GoalMotion { velocity: still.velocity + on, ..still } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64) -> PointState {
        PointState::at_rest(Vector2::new(x, 0.0))
    }

    #[test]
    fn links_end_beyond_their_reach_and_break_for_a_time() {
        let (mut links, broken) = (Links::default(), [BrokenLink { robot: 1, from: 2.0, to: 3.0 }]);
        let mut look = |time: f64, last: f64| {
            links.look(time, &[at(0.0), at(-5.0), at(last)], (6.0, 5.5), &broken);
            [0, 1, 2].map(|index| links.hears(index))
        };
        assert_eq!(look(0.0, -11.0), [true, true, true]);
        assert_eq!(look(1.0, -11.1), [true, true, false]);
        assert_eq!(look(2.0, -12.0), [true, false, false]);
        // Between where it ends and where it begins again: the broken one hears, the lost one does not.
        assert_eq!(look(3.0, -11.0), [true, true, false]);
        assert_eq!(look(4.0, -10.5), [true, true, true]);
        let told: Vec<_> = links.changes().iter().map(|change| (change.time, change.robot, change.event)).collect();
        let expected = [
            (1.0, 2, QueueEvent::Lost),
            (2.0, 1, QueueEvent::Retargets),
            (3.0, 1, QueueEvent::Follows),
            (4.0, 2, QueueEvent::Follows),
        ];
        assert_eq!(told, expected);
    }
}
