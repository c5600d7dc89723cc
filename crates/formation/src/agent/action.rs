//! What a controller says, and what people want to see of it.
use crate::Vector2;
use crate::kinematics::PointState;
use crate::laws::Steered;
use crate::zoning::Zone;

/// What a robot does now; by default nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Action {
    /// What the law says, before limits.
    pub steered: Steered,
    /// What is applied, m/s^2: the law's acceleration within the limits.
    pub acceleration: Vector2<f64>,
    /// Whether limits cut it.
    pub cut: bool,
    /// Power that the cut adds to the Lyapunov function besides the law's own rate, m^2/s^3.
    pub cut_power: f64,
    /// Power that what moves around the robot adds besides.
    pub powers: Powers,
    /// What of the Lyapunov function is theirs.
    pub values: Values,
    /// The point that draws the robot, m; none while its attraction is suspended.
    pub attraction: Option<Vector2<f64>>,
    /// The place that the robot has chosen on the segment, or its goal point, whether it draws or not, m.
    pub place: Option<Vector2<f64>>,
    /// Distance from the nearest or goal point, whether it draws or not, m; infinite where there is none.
    pub deviation: f64,
    /// The terms of the law.
    pub forces: Forces,
    /// Where the leader is; none for chain leaders.
    pub zone: Option<Zone>,
    /// What is done about a local minimum.
    pub remedy: RemedyState,
}

/// The terms of the law, m/s^2. They add up to its acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forces {
    /// Phi' d_hat.
    pub trench: Vector2<f64>,
    /// What the sliding of the point of attraction adds to it in (6.1), see [`Attraction::sliding`](crate::laws::Attraction::sliding).
    pub sliding: Vector2<f64>,
    /// Psi' of the leader.
    pub zoning: Vector2<f64>,
    /// Psi_hat' of the other robots.
    pub robots: Vector2<f64>,
    /// Psi_hat^ob' of the obstacles.
    pub obstacles: Vector2<f64>,
    /// Damping, feedforward, and what delta of (6.1) does besides: it deflects the robot, without work.
    pub damping: Vector2<f64>,
}

impl Forces {
    /// What potentials exert: minus the gradient of the Lyapunov function by the robot's position, m/s^2.
    pub fn of_potentials(&self) -> Vector2<f64> {
        self.of_trench() + self.walls()
    }

    /// Minus the gradient of Phi, m/s^2: trench and sliding.
    pub fn of_trench(&self) -> Vector2<f64> {
        self.trench + self.sliding
    }

    /// What keeps robots apart, together and off obstacles, m/s^2.
    pub fn walls(&self) -> Vector2<f64> {
        self.zoning + self.robots + self.obstacles
    }
}

/// What moving things bring into the Lyapunov function, m^2/s^3, where the proofs (A.12, A.18) have them at rest in the segment's
/// frame: Psi' d_hat . v for each, v its velocity relative to the segment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Powers {
    /// The leader.
    pub leader: f64,
    /// The other robots ahead.
    pub robots: f64,
    /// Obstacles.
    pub obstacles: f64,
}

impl Powers {
    /// Of all of them.
    #[inline]
    pub fn sum(&self) -> f64 {
        self.leader + self.robots + self.obstacles
    }
}

/// What the potentials of other things hold of the Lyapunov function, m^2/s^2: Psi of each.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Values {
    /// Psi of the leader's zones.
    pub leader: f64,
    /// Psi_hat of the other robots ahead.
    pub robots: f64,
    /// Psi_hat^ob of the obstacles.
    pub obstacles: f64,
}

impl Values {
    /// Of all of them.
    pub fn sum(&self) -> f64 {
        self.leader + self.robots + self.obstacles
    }
}

/// What each input brought into the Lyapunov function from one tick to the next, m^2/s^2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    /// The law itself: -k |r'|^2 and what it says besides.
    pub law: f64,
    /// See [`Powers`].
    pub leader: f64,
    /// See [`Powers`].
    pub robots: f64,
    /// See [`Powers`].
    pub obstacles: f64,
    /// Limits of speed and acceleration.
    pub limits: f64,
}

impl Work {
    /// Adds a step of `step` (s).
    pub(super) fn add(&mut self, action: &Action, step: f64) {
        self.law += step * action.steered.lyapunov_rate;
        self.leader += step * action.powers.leader;
        self.robots += step * action.powers.robots;
        self.obstacles += step * action.powers.obstacles;
        self.limits += step * action.cut_power;
    }
}

/// What a remedy does (7.6, 7.7, Remark 6.4.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RemedyState {
    /// Nothing.
    #[default]
    None,
    /// A guard stands before the apparent obstacle of this id.
    Guarded(u32),
    /// The attraction is off for a while.
    Suspended,
    /// On the way out of the hull of this id.
    Escaping(u32),
    /// On a way round teammates ahead, or what no guard helps against.
    Led,
}

/// What a robot does until the next tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Driven {
    /// The reference at the next tick.
    pub end: PointState,
    /// Mean velocity until then, m/s.
    pub mean_velocity: Vector2<f64>,
    /// Mean acceleration, m/s^2.
    pub mean_acceleration: Vector2<f64>,
    /// The action at the beginning.
    pub first: Action,
    /// Whether limits ever cut.
    pub cut: bool,
    /// Whether obstacles ever pushed.
    pub pushed: bool,
    /// What each input brings into the Lyapunov function.
    pub work: Work,
}
