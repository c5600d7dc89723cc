//! What one robot did.

use std::f64::consts::{PI, TAU};

/// A robot's pose and speeds at one time, in the map.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// s since the beginning of the run.
    pub time: f64,
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// rad.
    pub theta: f64,
    /// m/s, forward.
    pub v: f64,
    /// rad/s.
    pub omega: f64,
}

impl Pose {
    /// m.
    #[must_use]
    pub fn position(&self) -> [f64; 2] {
        [self.x, self.y]
    }
}

/// A velocity that holds for longer than this, s, holds until further notice.
const FOR_GOOD: f64 = 1e9;

/// A robot's goal point at one time, in the map.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GoalSample {
    /// s since the beginning of the run.
    pub time: f64,
    /// m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// s for which the velocity holds.
    pub remaining: f64,
}

impl GoalSample {
    /// Whether the goal point moves.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.velocity != [0.0, 0.0] && self.remaining > 0.0
    }

    /// Where the goal point is after it has moved, m; nothing while it is carried along by a target, of which nobody knows where it stops.
    #[must_use]
    pub fn resting_place(&self) -> Option<[f64; 2]> {
        if !self.is_moving() {
            return Some(self.position);
        }
        let [x, y] = self.position;
        (self.remaining < FOR_GOOD)
            .then(|| [x + self.velocity[0] * self.remaining, y + self.velocity[1] * self.remaining])
    }
}

/// All that is known of one robot, ordered by time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// Its poses.
    pub poses: Vec<Pose>,
    /// Its goal points.
    pub goals: Vec<GoalSample>,
    /// Value of its law's Lyapunov function, by time (s); nothing where it says none (tables have none).
    pub lyapunov: Vec<(f64, f64)>,
}

impl Track {
    /// Puts poses and goals in order and keeps the first of several at the same time.
    pub(super) fn sort(&mut self) {
        self.poses.sort_by(|a, b| a.time.total_cmp(&b.time));
        self.poses.dedup_by(|a, b| a.time == b.time);
        self.goals.sort_by(|a, b| a.time.total_cmp(&b.time));
        self.goals.dedup_by(|a, b| a.time == b.time);
        self.lyapunov.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.lyapunov.dedup_by(|a, b| a.0 == b.0);
    }

    /// First and last time of a pose, s.
    #[must_use]
    pub fn span(&self) -> Option<(f64, f64)> {
        Some((self.poses.first()?.time, self.poses.last()?.time))
    }

    /// The pose at `time`, interpolated linearly; outside the span the nearest one.
    #[must_use]
    pub fn pose_at(&self, time: f64) -> Option<Pose> {
        let after = self.poses.partition_point(|pose| pose.time <= time);
        let (Some(earlier), Some(later)) =
            (after.checked_sub(1).and_then(|i| self.poses.get(i)), self.poses.get(after))
        else {
            return self.poses.get(after.min(self.poses.len().saturating_sub(1))).copied();
        };
        let share = (time - earlier.time) / (later.time - earlier.time);
        let between = |from: f64, to: f64| from + share * (to - from);
        let turn = (later.theta - earlier.theta + PI).rem_euclid(TAU) - PI;
        Some(Pose {
            time,
            x: between(earlier.x, later.x),
            y: between(earlier.y, later.y),
            theta: earlier.theta + share * turn,
            v: between(earlier.v, later.v),
            omega: between(earlier.omega, later.omega),
        })
    }

    /// The goal point at `time`, m, moved on from the last one told; before the first one, that.
    #[must_use]
    pub fn goal_at(&self, time: f64) -> Option<[f64; 2]> {
        let after = self.goals.partition_point(|goal| goal.time <= time);
        let goal = self.goals.get(after.saturating_sub(1))?;
        let moved = (time - goal.time).clamp(0.0, goal.remaining.max(0.0));
        Some([goal.position[0] + goal.velocity[0] * moved, goal.position[1] + goal.velocity[1] * moved])
    }
}
