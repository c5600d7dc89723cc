//! Hilare robots (3.1.1) that track goal points: a law for double integrators acts on them through T1 and T2.
use super::Integration;
use crate::kinematics::{HandState, Hilare, HilareState, PointState, Pose, Twist, WheelDrive, Wheels};
use crate::laws::{GoalMotion, Steered};
use crate::stability::rk4;
use nalgebra::SVector;

/// What the motors of a robot were asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelEffort {
    /// The largest torque, N m, of either wheel at the beginning of any step.
    pub greatest: f64,
    /// How long it was more than they have, s.
    pub saturated: f64,
}

/// A team under way, all of one body: the hand of each goes to the goal point of its index, by one law.
#[derive(Debug, Clone)]
pub struct HilareTeam {
    body: Hilare,
    /// The motors that force and torque go through; none: the body has whatever the feedback asks for.
    drive: Option<WheelDrive>,
    /// Whether robots take the wheel speeds that the torques would bring about, and not the torques.
    commanded: bool,
    robots: Vec<HilareState>,
    efforts: Vec<WheelEffort>,
    method: Integration,
    step: f64,
    steps: u64,
}

impl HilareTeam {
    /// Robots at their start, by where their hands are and how these move.
    ///
    /// [`Integration::RungeKutta`] asks law and feedback again at each of its stages; otherwise forces are held for a step, as of a robot
    /// that is commanded once a step, and the body moves under them by RK4.
    pub fn new(body: Hilare, hands: &[HandState], method: Integration, step: f64) -> Self {
        let robots = hands.iter().map(|hand| body.from_hand(*hand)).collect();
        Self { body, drive: None, commanded: false, robots, efforts: Vec::new(), method, step, steps: 0 }
    }

    /// Has the feedback drive the robots by the torques of their wheels.
    #[must_use]
    pub fn driven_by(self, drive: WheelDrive) -> Self {
        Self { drive: Some(drive), efforts: vec![WheelEffort::default(); self.robots.len()], ..self }
    }

    /// Has robots take velocities: each step they are given the wheel speeds that the torques, held for the step, would bring about
    /// ([`WheelDrive::speeds_after`]), and ramp to them. Of robots that are driven by their wheels.
    #[must_use]
    pub fn commanded(self) -> Self {
        Self { commanded: true, ..self }
    }

    /// Advances by one step. `goal` moves the goal point of a robot, `law` steers its hand to it.
    pub fn step(&mut self, goal: impl Fn(usize, f64) -> GoalMotion, law: impl Fn(PointState, GoalMotion) -> Steered) {
        let (time, body, drive, step) = (self.time(), self.body, self.drive, self.step);
        for (index, robot) in self.robots.iter_mut().enumerate() {
            let wanted = |state: HilareState, time: f64| {
                body.feedback(state, law(body.to_hand(state).hand, goal(index, time)).acceleration)
            };
            let input = |state: HilareState, time: f64| {
                let wanted = wanted(state, time);
                drive.map_or(wanted, |drive| drive.through(wanted))
            };
            if let Some((drive, effort)) = drive.zip(self.efforts.get_mut(index)) {
                let torque = drive.torques(wanted(*robot, time)).peak();
                effort.greatest = effort.greatest.max(torque);
                effort.saturated += if torque > drive.most { step } else { 0.0 };
            }
            if let Some(drive) = drive.filter(|_| self.commanded) {
                let torques = drive.given(drive.torques(wanted(*robot, time)));
                *robot = ramped(*robot, drive, drive.speeds_after(body, *robot, torques, step), step);
                continue;
            }
            *robot = match self.method {
                Integration::RungeKutta => of_vector(&rk4(time, to_vector(*robot), step, |time, now| {
                    let state = of_vector(now);
                    let (sin, cos) = libm::sincos(state.pose.theta);
                    let (Twist { v, omega }, rates) = (state.twist, body.rates(state.twist, input(state, time)));
                    SVector::<f64, 5>::new(v * cos, v * sin, omega, rates.v, rates.omega)
                })),
                Integration::Exact | Integration::SemiImplicitEuler => body.advanced(*robot, input(*robot, time), step),
            };
        }
        self.steps += 1;
    }

    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// The robots, in order.
    pub fn robots(&self) -> &[HilareState] {
        &self.robots
    }

    /// What their motors were asked for, in order; nothing without motors.
    pub fn efforts(&self) -> &[WheelEffort] {
        &self.efforts
    }

    /// Their hands, which move as double integrators do (3.4).
    pub fn hands(&self) -> impl Iterator<Item = PointState> {
        self.robots.iter().map(|robot| self.body.to_hand(*robot).hand)
    }
}

/// A robot whose wheels go from their speeds to those that it is given, evenly over a step: their mean drives it.
fn ramped(robot: HilareState, drive: WheelDrive, given: Wheels, step: f64) -> HilareState {
    let now = drive.axle.wheels(robot.twist);
    let mean = Wheels { left: 0.5 * (now.left + given.left), right: 0.5 * (now.right + given.right) };
    HilareState { pose: robot.pose.advanced(drive.axle.twist(mean), step), twist: drive.axle.twist(given) }
}

fn to_vector(HilareState { pose, twist }: HilareState) -> SVector<f64, 5> {
    SVector::<f64, 5>::new(pose.x, pose.y, pose.theta, twist.v, twist.omega)
}

fn of_vector(q: &SVector<f64, 5>) -> HilareState {
    HilareState { pose: Pose::new(q[0], q[1], q[2]), twist: Twist { v: q[3], omega: q[4] } }
}
