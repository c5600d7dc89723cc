//! The repulsive potentials that 7.8 compares with.
use crate::Vector2;
use crate::hull::Approach;
use crate::laws::Push;

/// U = eta/2 (1/gap - 1/reach)^2 rho_goal^n below the reach, 0 from there on: the conventional potential for n = 0, that
/// of Ge and Cui (reference 26 of the thesis) for n of 1 or more, which is 0 at the goal so that obstacles near the goal
/// do not keep the robot from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComparedRepulsion {
    /// eta, positive.
    pub strength: f64,
    /// rho_0, m.
    pub reach: f64,
    /// n.
    pub goal_exponent: i32,
}

impl ComparedRepulsion {
    /// Force and potential at a gap from an obstacle; `to_goal` (m) is the vector from the robot to its goal point. Where the gap is not
    /// positive the potential is infinite and there is no force: the robot has touched the obstacle.
    pub fn push(&self, approach: Approach, to_goal: Vector2<f64>) -> Push {
        let Approach { gap, towards } = approach;
        if gap >= self.reach {
            return Push { force: Vector2::zeros(), value: 0.0 };
        }
        if gap <= 0.0 {
            return Push { force: Vector2::zeros(), value: f64::INFINITY };
        }
        let excess = 1.0 / gap - 1.0 / self.reach;
        let distance = to_goal.norm();
        let weight = power(distance, self.goal_exponent);
        let away = -towards * (self.strength * excess * weight / (gap * gap));
        let half = 0.5 * self.strength * excess * excess;
        let to_goal = if distance > 0.0 && self.goal_exponent > 0 {
            to_goal / distance * (half * f64::from(self.goal_exponent) * power(distance, self.goal_exponent - 1))
        } else {
            Vector2::zeros()
        };
        Push { force: away + to_goal, value: half * weight }
    }
}

fn power(base: f64, exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hull::Outline;
    use proptest::prelude::*;

    const GOAL: Vector2<f64> = Vector2::new(0.0, 0.0);

    fn push(goal_exponent: i32, robot: Vector2<f64>) -> Push {
        let obstacle = [Vector2::new(1.5, 0.0)];
        let approach = Outline { points: &obstacle, radius: 0.5 }.approach(robot);
        ComparedRepulsion { strength: 2.0, reach: 2.0, goal_exponent }.push(approach, GOAL - robot)
    }

    proptest! {
        /// The force is minus the gradient.
        #[test]
        fn force_and_value(x in -2.0..0.8_f64, y in -2.0..2.0_f64, goal_exponent in 0..4_i32) {
            let robot = Vector2::new(x, y);
            prop_assume!((robot - Vector2::new(1.5, 0.0)).norm() < 2.4 && robot.norm() > 0.1);
            let slope = |step: Vector2<f64>| {
                (push(goal_exponent, robot - step).value - push(goal_exponent, robot + step).value) / 2e-6
            };
            let expected = Vector2::new(slope(Vector2::new(1e-6, 0.0)), slope(Vector2::new(0.0, 1e-6)));
            let force = push(goal_exponent, robot).force;
            prop_assert!((force - expected).norm() < 1e-5 * (1.0 + force.norm()), "{force} {expected}");
        }
    }

    /// A goal within reach of an obstacle: the conventional potential keeps the robot from it, Ge and Cui's does not.
    #[test]
    fn goals_near_obstacles() {
        for (goal_exponent, arrives) in [(0, false), (2, true)] {
            let (mut robot, mut velocity) = (Vector2::new(-3.0, 0.4), Vector2::zeros());
            for _ in 0..40_000 {
                let attraction = GOAL - robot;
                velocity += 1e-3 * (attraction + push(goal_exponent, robot).force - 3.0 * velocity);
                robot += 1e-3 * velocity;
            }
            assert_eq!((robot - GOAL).norm() < 1e-3, arrives, "n = {goal_exponent}: {robot}");
        }
    }
}
