//! How far the formation is, from what the vision sees.

use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::msg::{Goals, RobotState, TeamState};

/// Distance to the goal of every robot that has one and is seen, in metres, by name.
pub type Distances = BTreeMap<String, f64>;

/// A robot's position and its goal's, at the exposure of the team state.
type Pairs = Vec<([f64; 2], [f64; 2])>;

/// The distance of every robot to its goal point at the team state's exposure.
#[must_use]
pub fn distances(team: &TeamState, goals: &Goals) -> Distances {
    let named = pair(team, goals);
    named.into_iter().map(|(name, (robot, goal))| (name, separation(robot, goal))).collect()
}

/// The shape error: max over pairs of robots of | |p_i - p_j| - |g_i - g_j| |, in metres; 0 with fewer than two robots.
///
/// With goals at rest at the vertices it is the shape error of the experiments of section 4.6.
#[must_use]
pub fn shape_error(team: &TeamState, goals: &Goals) -> f64 {
    let pairs: Pairs = pair(team, goals).into_values().collect();
    let mut worst = 0.0_f64;
    for (index, first) in pairs.iter().enumerate() {
        for second in &pairs[index + 1..] {
            let error = separation(first.0, second.0) - separation(first.1, second.1);
            worst = worst.max(error.abs());
        }
    }
    worst
}

fn pair(team: &TeamState, goals: &Goals) -> BTreeMap<String, ([f64; 2], [f64; 2])> {
    let seen = |robot: &&RobotState| robot.status == RobotState::STATUS_TRACKED;
    let exposure = RosTime::from(&team.header.stamp);
    let age = exposure.seconds_since(RosTime::from(&goals.header.stamp));
    let mut pairs = BTreeMap::new();
    for robot in team.robots.iter().filter(seen) {
        if let Some(goal) = goals.goals.iter().find(|goal| goal.robot == robot.name) {
            let moved = age.clamp(-goal.remaining.abs(), goal.remaining.max(0.0));
            let at = [goal.position.x + goal.velocity.x * moved, goal.position.y + goal.velocity.y * moved];
            pairs.insert(robot.name.clone(), ([robot.x, robot.y], at));
        }
    }
    pairs
}

fn separation(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_msgs::msg::{Goal, Point2};

    fn scene(robots: &[(&str, f64, f64)], goals: &[(&str, f64, f64)]) -> (TeamState, Goals) {
        let robot = |&(name, x, y): &(&str, f64, f64)| RobotState {
            name: name.to_owned(),
            status: RobotState::STATUS_TRACKED,
            x,
            y,
            ..Default::default()
        };
        let goal = |&(name, x, y): &(&str, f64, f64)| Goal {
            robot: name.to_owned(),
            position: Point2 { x, y },
            ..Default::default()
        };
        let team = TeamState { robots: robots.iter().map(robot).collect(), ..Default::default() };
        (team, Goals { goals: goals.iter().map(goal).collect(), ..Default::default() })
    }

    #[test]
    fn a_shifted_team_keeps_its_shape() {
        let (team, goals) = scene(&[("a", 0.0, 0.5), ("b", 3.0, 4.5)], &[("a", 0.0, 0.0), ("b", 3.0, 4.0)]);
        assert_eq!(distances(&team, &goals).into_values().collect::<Vec<_>>(), [0.5, 0.5]);
        assert!(shape_error(&team, &goals) < 1e-15);
    }

    #[test]
    fn a_stretched_team_does_not() {
        let (team, goals) = scene(&[("a", 0.0, 0.0), ("b", 0.9, 0.0)], &[("a", 0.0, 0.0), ("b", 0.8, 0.0)]);
        assert!((shape_error(&team, &goals) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn robots_that_are_not_seen_do_not_count() {
        let (mut team, goals) = scene(&[("a", 0.0, 0.0), ("b", 9.0, 0.0)], &[("a", 0.0, 0.0), ("b", 0.8, 0.0)]);
        team.robots[1].status = RobotState::STATUS_LOST;
        assert_eq!(distances(&team, &goals).len(), 1);
        assert_eq!(shape_error(&team, &goals), 0.0);
    }
}
