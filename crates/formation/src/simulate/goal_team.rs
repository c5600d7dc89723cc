//! Robots that track goal points of their own, without regard to one another (5.4, 5.6).
use super::Integration;
use super::integrate::Integrator;
use crate::Vector2;
use crate::kinematics::PointState;
use crate::laws::{GoalMotion, Steered};

/// A team under way: each robot with the goal point of its index, all under one law.
#[derive(Debug, Clone)]
pub struct GoalTeam {
    robots: Vec<PointState>,
    integrator: Integrator,
    step: f64,
    steps: u64,
}

impl GoalTeam {
    /// Robots at their start.
    pub fn new(robots: Vec<PointState>, method: Integration, step: f64) -> Self {
        let integrator = Integrator::new(method, step, robots.len());
        Self { robots, integrator, step, steps: 0 }
    }

    /// Advances by one step. `goal` moves the goal point of a robot, `law` steers the robot to it.
    pub fn step(&mut self, goal: impl Fn(usize, f64) -> GoalMotion, law: impl Fn(PointState, GoalMotion) -> Steered) {
        let time = self.time();
        self.integrator.advance(&mut self.robots, time, |time, robots, rates| {
            for (index, (robot, rate)) in robots.iter().zip(rates).enumerate() {
                *rate = law(*robot, goal(index, time)).acceleration;
            }
        });
        self.steps += 1;
    }

    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// The robots, in order.
    pub fn robots(&self) -> &[PointState] {
        &self.robots
    }
}

/// Goal points that run along a wave, evenly spaced: that of robot `index` is at x = first - index spacing + speed t,
/// y = amplitude sin(wave_number x + phase).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveGoals {
    /// m, the first robot's x at time 0.
    pub first: f64,
    /// m, along x.
    pub spacing: f64,
    /// m/s, along x.
    pub speed: f64,
    /// m; 0 makes a straight line.
    pub amplitude: f64,
    /// rad/m.
    pub wave_number: f64,
    /// rad.
    pub phase: f64,
}

impl WaveGoals {
    /// The largest speed that a goal point can have, m/s.
    pub fn fastest(&self) -> f64 {
        libm::hypot(self.speed, self.amplitude * self.wave_number * self.speed)
    }

    /// Position, velocity and acceleration of a robot's goal point at `time` (s).
    pub fn at(&self, index: usize, time: f64) -> GoalMotion {
        let x = self.first - index as f64 * self.spacing + self.speed * time;
        let (sine, cosine) = libm::sincos(self.wave_number * x + self.phase);
        let rate = self.wave_number * self.speed;
        GoalMotion {
            position: Vector2::new(x, self.amplitude * sine),
            velocity: Vector2::new(self.speed, self.amplitude * rate * cosine),
            acceleration: Vector2::new(0.0, -self.amplitude * rate * rate * sine),
        }
    }
}
