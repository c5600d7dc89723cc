//! Robots that track goal points within what they can do (9.2), each ended by the safety filter: they are bodies that do not touch.
use super::Integration;
use crate::kinematics::PointState;
use crate::laws::{Capability, GoalMotion, GoalTracking};
use crate::safety::Stopping;
use crate::trench::{Damping, Trench};

/// A team under way: each robot with the goal point of its index, all under one law.
#[derive(Debug, Clone)]
pub struct BoundedTeam<T, D> {
    robots: Vec<PointState>,
    /// What they were at the beginning of the step: what each knows of the others.
    seen: Vec<PointState>,
    law: GoalTracking<T, D>,
    limits: Capability,
    safety: Option<Stopping>,
    integration: Integration,
    step: f64,
    steps: u64,
}

impl<T: Trench, D: Damping> BoundedTeam<T, D> {
    /// Robots at their start. `limits` are relative to the goal point of each, as those of a chain are to its segment; bodies of
    /// `radius` (m, with what is to be left between them), if there are any, move at up to `fastest` (m/s) beside that: the largest speed
    /// of the goal points.
    pub fn new(
        robots: Vec<PointState>,
        law: GoalTracking<T, D>,
        limits: Capability,
        (radius, fastest): (Option<f64>, f64),
        (integration, step): (Integration, f64),
    ) -> Self {
        let capability = Capability { speed: limits.speed + fastest, ..limits };
        let safety = radius.map(|radius| Stopping { radius, capability });
        Self { seen: robots.clone(), robots, law, limits, safety, integration, step, steps: 0 }
    }

    /// Advances by one step. `goal` moves the goal point of a robot.
    ///
    /// The acceleration of the step's beginning is held for it, whatever the method: limits and filter say what it is for a whole step.
    /// Under [`Integration::RungeKutta`] the motion is that of [`Integration::Exact`], so scenario files may not ask for it.
    pub fn step(&mut self, goal: impl Fn(usize, f64) -> GoalMotion) {
        let (time, step) = (self.time(), self.step);
        self.seen.clone_from(&self.robots);
        for (index, robot) in self.robots.iter_mut().enumerate() {
            let goal = goal(index, time);
            let within = self.limits.saturate(robot.velocity - goal.velocity, self.law.terms(*robot, goal), step);
            let mut acceleration = goal.acceleration + within;
            if let Some(safety) = &self.safety {
                acceleration = safety.admit_among(&self.seen, index, acceleration, step);
            }
            *robot = self.integration.held(*robot, acceleration, step);
        }
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
