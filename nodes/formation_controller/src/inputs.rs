//! The newest of everything the controller hears, with when it came.

use std::collections::BTreeMap;
use trench_core::{RosTime, Steady};
use trench_formation::Vector2;
use trench_formation::laws::GoalMotion;
use trench_msgs::msg::{
    ApparentObstacle, ApparentObstacleArray, Assignment, Formation, Goal, Goals, LeaderState, Point2, RobotState,
    RunState, TeamState,
};

/// A message and the monotonic time of its receipt: ages that stop robots are measured by it.
#[derive(Debug, Clone)]
pub(crate) struct Heard<T> {
    pub(crate) at: Steady,
    pub(crate) message: T,
}

/// What was heard last on each topic.
#[derive(Debug, Clone, Default)]
pub(crate) struct Inputs {
    pub(crate) team: Option<Heard<TeamState>>,
    pub(crate) goals: Option<Heard<Goals>>,
    pub(crate) run: Option<RunState>,
    pub(crate) assignment: Option<Assignment>,
    pub(crate) formation: Option<Formation>,
    pub(crate) obstacles: Option<Heard<ApparentObstacleArray>>,
    pub(crate) others: BTreeMap<String, Heard<LeaderState>>,
    pub(crate) emergency_stop: bool,
}

/// An apparent obstacle as the safety filter wants it.
#[derive(Debug, Clone)]
pub(crate) struct Hull {
    pub(crate) points: Vec<Vector2<f64>>,
    pub(crate) radius: f64,
    pub(crate) velocity: Vector2<f64>,
}

impl Inputs {
    /// The apparent obstacles heard last.
    pub(crate) fn hulls(&self) -> Vec<Hull> {
        let hull = |obstacle: &ApparentObstacle| Hull {
            points: obstacle.hull.iter().map(vector).collect(),
            radius: obstacle.radius,
            velocity: vector(&obstacle.velocity),
        };
        self.obstacles.iter().flat_map(|heard| &heard.message.obstacles).map(hull).collect()
    }

    /// The state of `robot` in the newest team state.
    pub(crate) fn robot(&self, robot: &str) -> Option<&RobotState> {
        self.team.as_ref()?.message.robots.iter().find(|state| state.name == robot)
    }

    /// The goal of `robot` at `time`, if the goals are not older than `age_limit` seconds.
    pub(crate) fn goal(&self, robot: &str, time: RosTime, now: Steady, age_limit: f64) -> Option<(GoalMotion, u8)> {
        let heard = self.goals.as_ref().filter(|goals| now.seconds_since(goals.at) <= age_limit)?;
        let goal = heard.message.goals.iter().find(|goal| goal.robot == robot)?;
        let ahead = time.seconds_since(RosTime::from(&heard.message.header.stamp));
        Some((extrapolate(goal, ahead), goal.phase))
    }
}

/// The goal point `ahead` seconds after its stamp: it moves for `remaining` seconds and rests then.
fn extrapolate(goal: &Goal, ahead: f64) -> GoalMotion {
    let (velocity, acceleration) = (vector(&goal.velocity), vector(&goal.acceleration));
    let remaining = goal.remaining.max(0.0);
    let moved = ahead.min(remaining);
    let position = vector(&goal.position) + moved * velocity + 0.5 * moved * moved * acceleration;
    if ahead < remaining {
        GoalMotion { position, velocity: velocity + moved * acceleration, acceleration }
    } else {
        GoalMotion::at_rest(position)
    }
}

/// A point of a message as a vector.
pub(crate) fn vector(point: &Point2) -> Vector2<f64> {
    Vector2::new(point.x, point.y)
}

/// A vector as a point of a message.
pub(crate) fn point(vector: Vector2<f64>) -> Point2 {
    Point2 { x: vector.x, y: vector.y }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_move_as_long_as_they_are_said_to() {
        let goal = Goal {
            position: Point2 { x: 1.0, y: 0.0 },
            velocity: Point2 { x: 0.1, y: 0.0 },
            remaining: 2.0,
            ..Default::default()
        };
        let check = |ahead, x: f64, speed: f64| {
            let motion = extrapolate(&goal, ahead);
            assert!((motion.position.x - x).abs() < 1e-12 && (motion.velocity.x - speed).abs() < 1e-12, "{motion:?}");
        };
        check(0.0, 1.0, 0.1);
        check(1.0, 1.1, 0.1);
        check(3.0, 1.2, 0.0);
    }

    #[test]
    fn old_goals_are_no_goals() {
        let goals = Goals { goals: vec![Goal { robot: "r".to_owned(), ..Default::default() }], ..Default::default() };
        let inputs = Inputs { goals: Some(Heard { at: Steady(0), message: goals }), ..Default::default() };
        assert!(inputs.goal("r", RosTime(0), Steady(400_000_000), 0.5).is_some());
        assert!(inputs.goal("r", RosTime(0), Steady(600_000_000), 0.5).is_none());
        assert!(inputs.goal("s", RosTime(0), Steady(0), 0.5).is_none());
    }
}
