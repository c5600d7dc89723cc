//! Whether the robot does what it is told.

use trench_core::RosTime;
use trench_formation::kinematics::Twist;

/// Notices a robot that has not followed its commands for a while: a stuck wheel, a push, a lost radio.
#[derive(Debug, Clone)]
pub struct Deviation {
    speed_limit: f64,
    turn_limit: f64,
    patience: f64,
    since: Option<RosTime>,
}

impl Deviation {
    /// Deviating means more than `speed_limit` m/s or `turn_limit` rad/s away from the command for `patience` seconds.
    #[must_use]
    pub fn new(speed_limit: f64, turn_limit: f64, patience: f64) -> Self {
        Self { speed_limit, turn_limit, patience, since: None }
    }

    /// Compares what is seen at `stamp` with the commands in force around it (the oldest and the newest that may act at
    /// that moment): being between them, or near one of them, is following.
    pub fn observe(&mut self, stamp: RosTime, seen: Twist, commands: [Twist; 2]) -> bool {
        let beyond = |seen: f64, a: f64, b: f64| (a.min(b) - seen).max(seen - a.max(b)).max(0.0);
        let speed = beyond(seen.v, commands[0].v, commands[1].v);
        let turn = beyond(seen.omega, commands[0].omega, commands[1].omega);
        if speed <= self.speed_limit && turn <= self.turn_limit {
            self.since = None;
            return false;
        }
        let since = *self.since.get_or_insert(stamp);
        stamp.seconds_since(since) >= self.patience
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: Twist = Twist::ZERO;
    const AHEAD: Twist = Twist { v: 0.2, omega: 0.0 };

    #[test]
    fn a_stuck_robot_is_noticed_after_its_patience() {
        let mut deviation = Deviation::new(0.05, 1.0, 0.3);
        let flags: Vec<bool> =
            (0..12).map(|tick| deviation.observe(RosTime(tick * 33_000_000), STILL, [AHEAD, AHEAD])).collect();
        assert_eq!(flags.iter().filter(|flag| **flag).count(), 2, "from 0.33 s on: {flags:?}");
    }

    #[test]
    fn starting_is_not_deviating() {
        let mut deviation = Deviation::new(0.05, 1.0, 0.3);
        for tick in 0..100 {
            let seen = Twist { v: 0.1, omega: 0.0 };
            assert!(!deviation.observe(RosTime(tick * 33_000_000), seen, [STILL, AHEAD]));
        }
    }

    #[test]
    fn a_moment_is_forgiven() {
        let mut deviation = Deviation::new(0.05, 1.0, 0.3);
        for tick in 0..100 {
            let seen = if tick % 5 == 0 { AHEAD } else { STILL };
            assert!(!deviation.observe(RosTime(tick * 33_000_000), seen, [AHEAD, AHEAD]));
        }
    }
}
