//! Messages that robots are driven by: whether their numbers are numbers.

use crate::msg::{Goal, Goals, Point2, RobotState, TeamState};

impl TeamState {
    /// Whether pose and speed of every robot are finite; pads that are no robot's are judged one by one.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let numbers = |robot: &RobotState| [robot.x, robot.y, robot.theta, robot.v, robot.omega];
        self.robots.iter().flat_map(numbers).all(f64::is_finite)
    }
}

impl Goals {
    /// Whether the motion of the frame and of every goal is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let finite = |points: [&Point2; 3]| points.iter().all(|point| point.x.is_finite() && point.y.is_finite());
        let frame = &self.frame;
        frame.theta.is_finite()
            && frame.turn_rate.is_finite()
            && finite([&frame.position, &frame.velocity, &frame.acceleration])
            && self.goals.iter().all(|Goal { position, velocity, acceleration, remaining, .. }| {
                remaining.is_finite() && finite([position, velocity, acceleration])
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bad_number_spoils_a_message() {
        let team = TeamState { robots: vec![RobotState::default(); 2], ..TeamState::default() };
        let goals = Goals { goals: vec![Goal::default(); 2], ..Goals::default() };
        assert!(team.is_finite() && goals.is_finite());
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for field in 0..5 {
                let mut spoilt = team.clone();
                let robot = &mut spoilt.robots[1];
                *[&mut robot.x, &mut robot.y, &mut robot.theta, &mut robot.v, &mut robot.omega][field] = bad;
                assert!(!spoilt.is_finite(), "{bad} in field {field} of a robot");
                let mut spoilt = goals.clone();
                let goal = &mut spoilt.goals[1];
                *[
                    &mut goal.position.x,
                    &mut goal.velocity.y,
                    &mut goal.acceleration.x,
                    &mut goal.remaining,
                    &mut spoilt.frame.turn_rate,
                ][field] = bad;
                assert!(!spoilt.is_finite(), "{bad} in field {field} of goals");
            }
        }
    }
}
