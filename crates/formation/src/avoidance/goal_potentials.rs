//! The attractive potentials that 5.5 compares trenches with.
use crate::Vector2;
use crate::kinematics::PointState;
use crate::laws::{GoalMotion, Steered};

/// (5.4) with m = 2, U = xi rho^2/2, of a robot damped by k: position alone, so that a goal point under way is followed with a lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalPotential {
    /// xi, 1/s^2.
    pub strength: f64,
    /// k, 1/s.
    pub damping: f64,
}

/// (5.5) with m = n = 2, U = alpha_p |q_targ - q|^2 + alpha_v |v_targ - v|^2: the force is minus its gradients by q and by v. It
/// follows a goal point of constant velocity exactly, and lags behind one that accelerates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityPotential {
    /// alpha_p, 1/s^2.
    pub position: f64,
    /// alpha_v, 1/s.
    pub velocity: f64,
}

impl GoalPotential {
    /// The acceleration of a robot at `goal`'s distance; V counts as if the goal point rested.
    pub fn steer(&self, robot: PointState, goal: GoalMotion) -> Steered {
        let offset = goal.position - robot.position;
        let value = 0.5 * (robot.velocity.norm_squared() + self.strength * offset.norm_squared());
        let driven = self.strength * offset.dot(&goal.velocity);
        steered(
            self.strength * offset - self.damping * robot.velocity,
            value,
            driven - self.damping * robot.velocity.norm_squared(),
        )
    }
}

impl VelocityPotential {
    /// The acceleration of a robot; V = |d'|^2/2 + alpha_p |d|^2.
    pub fn steer(&self, robot: PointState, goal: GoalMotion) -> Steered {
        let (offset, closing) = (goal.position - robot.position, goal.velocity - robot.velocity);
        let value = 0.5 * closing.norm_squared() + self.position * offset.norm_squared();
        let rate = closing.dot(&goal.acceleration) - 2.0 * self.velocity * closing.norm_squared();
        steered(2.0 * (self.position * offset + self.velocity * closing), value, rate)
    }
}

fn steered(acceleration: Vector2<f64>, lyapunov: f64, lyapunov_rate: f64) -> Steered {
    Steered { acceleration, lyapunov, lyapunov_rate }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error after 40 s behind a goal point that moves at 1 m/s and, perhaps, accelerates by 0.1 m/s^2.
    fn error(law: impl Fn(PointState, GoalMotion) -> Steered, acceleration: f64) -> f64 {
        let along = |time: f64| GoalMotion {
            position: Vector2::new(time + 0.5 * acceleration * time * time, 0.0),
            velocity: Vector2::new(1.0 + acceleration * time, 0.0),
            acceleration: Vector2::new(acceleration, 0.0),
        };
        let mut robot = PointState::at_rest(Vector2::new(-1.0, 0.5));
        for step in 0..40_000 {
            robot = robot.advanced(law(robot, along(f64::from(step) * 1e-3)).acceleration, 1e-3);
        }
        (robot.position - along(40.0).position).norm()
    }

    /// 5.5: (5.4) lags by k v/xi, (5.5) by a/(2 alpha_p).
    #[test]
    fn lags_of_5_5() {
        let conventional = GoalPotential { strength: 4.0, damping: 2.0 };
        assert!((error(|r, g| conventional.steer(r, g), 0.0) - 0.5).abs() < 2e-3);
        let velocity = VelocityPotential { position: 2.0, velocity: 1.0 };
        assert!(error(|r, g| velocity.steer(r, g), 0.0) < 2e-3);
        assert!((error(|r, g| velocity.steer(r, g), 0.1) - 0.025).abs() < 2e-3);
    }

    /// The rates are the derivatives of V along the motion.
    #[test]
    fn rates() {
        let goal = |time: f64| GoalMotion {
            position: Vector2::new(time, 0.0),
            velocity: Vector2::new(1.0 + 0.3 * time, 0.0),
            acceleration: Vector2::new(0.3, 0.0),
        };
        let start = PointState { position: Vector2::new(-0.7, 0.4), velocity: Vector2::new(0.2, -0.1) };
        let laws: [&dyn Fn(PointState, GoalMotion) -> Steered; 2] =
            [&|r, g| GoalPotential { strength: 3.0, damping: 1.5 }.steer(r, g), &|r, g| {
                VelocityPotential { position: 2.0, velocity: 0.7 }.steer(r, g)
            }];
        for law in laws {
            let now = law(start, goal(0.0));
            let at = |time: f64| law(start.advanced(now.acceleration, time), goal(time)).lyapunov;
            assert!(((at(1e-5) - at(-1e-5)) / 2e-5 - now.lyapunov_rate).abs() < 1e-6);
        }
    }
}
