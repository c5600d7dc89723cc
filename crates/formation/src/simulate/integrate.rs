//! From accelerations to motion, for a team of double integrators (3.4).
use crate::Vector2;
use crate::kinematics::PointState;

/// How the equations of motion are integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Integration {
    /// The acceleration of the step's beginning is held; its motion is exact, as of a robot that is commanded once a step.
    Exact,
    /// Runge-Kutta of order 4: nearest to the differential equation wherever the law is smooth.
    RungeKutta,
    /// New velocity first, position with it: keeps the energy of stiff walls bounded, which obstacles need.
    #[default]
    SemiImplicitEuler,
}

impl Integration {
    /// A robot's state after `step` (s) of the acceleration that it had at the step's beginning; by the exact solution
    /// under [`RungeKutta`](Self::RungeKutta), too, which does not hold it.
    #[inline]
    pub(super) fn held(self, robot: PointState, acceleration: Vector2<f64>, step: f64) -> PointState {
        match self {
            Self::SemiImplicitEuler => robot.advanced_semi_implicit(acceleration, step),
            Self::Exact | Self::RungeKutta => robot.advanced(acceleration, step),
        }
    }
}

/// What integrates one team; it keeps its buffers, so that steps allocate nothing.
#[derive(Debug, Clone)]
pub(super) struct Integrator {
    method: Integration,
    step: f64,
    rates: [Vec<Vector2<f64>>; 4],
    stage: Vec<PointState>,
}

impl Integrator {
    /// For a team of `count` robots and steps of `step` s.
    pub(super) fn new(method: Integration, step: f64, count: usize) -> Self {
        let zeros = vec![Vector2::zeros(); count];
        Self { method, step, rates: [zeros.clone(), zeros.clone(), zeros.clone(), zeros], stage: Vec::new() }
    }

    /// One step from `time` (s). `law` writes all accelerations for the states that it is given.
    pub(super) fn advance(
        &mut self,
        robots: &mut [PointState],
        time: f64,
        mut law: impl FnMut(f64, &[PointState], &mut [Vector2<f64>]),
    ) {
        let (step, [a, b, c, d]) = (self.step, &mut self.rates);
        law(time, robots, a);
        match self.method {
            held @ (Integration::Exact | Integration::SemiImplicitEuler) => {
                robots.iter_mut().zip(a).for_each(|(robot, a)| *robot = held.held(*robot, *a, step));
            }
            Integration::RungeKutta => {
                let half = 0.5 * step;
                self.stage.clear();
                self.stage.extend_from_slice(robots);
                // Velocities at the four stages: v, v + h/2 a, v + h/2 b, v + h c.
                let stage = &mut self.stage;
                for (index, robot) in robots.iter().enumerate() {
                    stage[index].position = robot.position + half * robot.velocity;
                    stage[index].velocity = robot.velocity + half * a[index];
                }
                law(time + half, stage, b);
                for (index, robot) in robots.iter().enumerate() {
                    stage[index].position = robot.position + half * (robot.velocity + half * a[index]);
                    stage[index].velocity = robot.velocity + half * b[index];
                }
                law(time + half, stage, c);
                for (index, robot) in robots.iter().enumerate() {
                    stage[index].position = robot.position + step * (robot.velocity + half * b[index]);
                    stage[index].velocity = robot.velocity + step * c[index];
                }
                law(time + step, stage, d);
                for (index, robot) in robots.iter_mut().enumerate() {
                    let (a, b, c, d) = (a[index], b[index], c[index], d[index]);
                    robot.position += step * (robot.velocity + (a + b + c) * (step / 6.0));
                    robot.velocity += (a + (b + c) * 2.0 + d) * (step / 6.0);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of an oscillator's position after 1 s.
    fn error(method: Integration, steps: u32) -> f64 {
        let mut robots = [PointState::at_rest(Vector2::new(1.0, -2.0))];
        let mut integrator = Integrator::new(method, 1.0 / f64::from(steps), 1);
        for _ in 0..steps {
            integrator.advance(&mut robots, 0.0, |_, robots, rates| rates[0] = -robots[0].position);
        }
        (robots[0].position - libm::cos(1.0) * Vector2::new(1.0, -2.0)).norm()
    }

    #[test]
    fn orders_of_the_methods() {
        for (method, expected) in
            [(Integration::Exact, 2.0), (Integration::SemiImplicitEuler, 2.0), (Integration::RungeKutta, 16.0)]
        {
            let ratio = error(method, 40) / error(method, 80);
            assert!((ratio / expected - 1.0).abs() < 0.1, "{method:?}: {ratio}");
        }
    }
}
