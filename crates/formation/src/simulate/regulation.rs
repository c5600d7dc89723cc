//! Robots of chapter 4, each driven to a goal point at rest by a law of its own (4.4).
use super::Integration;
use crate::Vector2;
use crate::kinematics::{Polar, Pose, Twist, wrap};
use crate::laws::PointLaw;
use crate::stability::rk4;
use nalgebra::Vector4;

/// One robot on its way to a resting goal point, in the polar coordinates (3.7), which stay exact however near the goal is.
#[derive(Debug, Clone)]
pub struct Regulation<L> {
    law: L,
    goal: Vector2<f64>,
    method: Integration,
    step: f64,
    steps: u64,
    /// r, phi, bearing of the goal from the robot, integral of v^2 + omega^2.
    state: Vector4<f64>,
}

impl<L: PointLaw> Regulation<L> {
    /// A robot at `start` that makes for `goal`, stepped by `step` (s).
    ///
    /// [`Integration::RungeKutta`] integrates (3.8). Otherwise the command is held for a step, and the robot drives an exact arc.
    pub fn new(law: L, start: Pose, goal: Vector2<f64>, method: Integration, step: f64) -> Self {
        let polar = Polar::of(start, goal);
        let state = Vector4::new(polar.distance, polar.misalignment, start.theta - polar.misalignment, 0.0);
        Self { law, goal, method, step, steps: 0, state }
    }

    /// Advances by one step.
    pub fn step(&mut self) {
        let law = &self.law;
        let rate = |state: &Vector4<f64>| {
            let polar = Polar { distance: state.x, misalignment: state.y };
            let twist = law.twist(polar);
            let rates = polar.rates(twist);
            Vector4::new(
                rates.distance,
                rates.misalignment,
                twist.omega - rates.misalignment,
                twist.v * twist.v + twist.omega * twist.omega,
            )
        };
        if self.method == Integration::RungeKutta {
            self.state = rk4(0.0, self.state, self.step, |_, state| rate(state));
        } else {
            let spent = self.step * rate(&self.state).w;
            let before = self.state.y + self.state.z;
            let next = self.pose().advanced(self.twist(), self.step);
            let polar = Polar::of(next, self.goal);
            let heading = before + wrap(next.theta - before);
            self.state =
                Vector4::new(polar.distance, polar.misalignment, heading - polar.misalignment, self.state.w + spent);
        }
        self.steps += 1;
    }

    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// r and phi.
    pub fn polar(&self) -> Polar {
        Polar { distance: self.state.x, misalignment: self.state.y }
    }

    /// Pose, frame `map`.
    pub fn pose(&self) -> Pose {
        let [r, phi, bearing] = [self.state.x, self.state.y, self.state.z];
        let (sine, cosine) = libm::sincos(bearing);
        let position = self.goal - r * Vector2::new(cosine, sine);
        Pose::new(position.x, position.y, phi + bearing)
    }

    /// What the law commands here.
    pub fn twist(&self) -> Twist {
        self.law.twist(self.polar())
    }

    /// Where it goes, m.
    pub fn goal(&self) -> Vector2<f64> {
        self.goal
    }

    /// J_n of Table 4.1: the integral of v^2 + omega^2 so far.
    pub fn effort(&self) -> f64 {
        self.state.w
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Robust;

    /// Both methods come to the same place; held commands of 1 ms differ by their delay.
    #[test]
    fn methods_agree() {
        let run = |method| {
            let law = Robust { k1: 1.0, k2: 1.0, k3: 1.4 };
            let mut robot = Regulation::new(law, Pose::new(1.0, 0.5, 0.3), Vector2::new(-0.5, 1.0), method, 1e-3);
            (0..2000).for_each(|_| robot.step());
            robot
        };
        let (smooth, held) = (run(Integration::RungeKutta), run(Integration::Exact));
        assert!((smooth.pose().position() - held.pose().position()).norm() < 1e-3);
        assert!((smooth.effort() - held.effort()).abs() < 2e-3 * smooth.effort());
        assert!((smooth.time() - 2.0).abs() < 1e-12);
    }

    /// 4.4.3: phi comes to where its rate vanishes (as e^(-0.38 t) in the first case), though r goes to 0.
    #[test]
    fn mismatched_gains_of_4_4_3() {
        for (k3, phi0, expected) in [(18.8, 1.0, 0.513_369_145_7), (24.8, core::f64::consts::PI, 2.393_369_533_0)] {
            let law = Robust { k1: 20.0, k2: 1.0, k3 };
            let start = Pose::new(1.0, 0.0, core::f64::consts::PI + phi0);
            let mut robot = Regulation::new(law, start, Vector2::zeros(), Integration::RungeKutta, 1e-3);
            (0..44_000).for_each(|_| robot.step());
            assert!((robot.polar().misalignment - expected).abs() < 1e-7, "{:?}", robot.polar());
        }
    }
}
