//! Laws (7.3), (7.4) and (7.13): towards the nearest point of the segment.
use super::goal_tracking::pull;
use super::{GoalMotion, Push, Steered};
use crate::Vector2;
use crate::kinematics::PointState;
use crate::lanes::{Number, Plane};
use crate::trench::Trench;

/// u = r_ns'' + k (r_ns' - r') + Phi'(d) d_hat + sum of the forces of (7.12), with r_ns taken as *fixed in the segment's frame*.
///
/// The print lets r_ns slide along the segment with the robot, so that k d_ns' damps nothing along the segment and r_ns'' makes
/// the equation singular there. Taken as fixed, the derivative of V = |r' - r_ns'|^2/2 + Phi_total along the motion is
/// -k |r' - r_ns'|^2: the distance to a curve changes with the motion of its nearest point as a point of the curve, whichever
/// point is nearest next. That holds for segments that translate; on a segment that turns with omega, r_ns' changes besides by
/// omega times the sliding of the nearest point.
///
/// | thesis | here |
/// |---|---|
/// | k_i | [`Self::damping`] |
/// | Phi_{i,ns} | [`Self::trench`] |
/// | r_{i,ns} and its derivatives | [`Attracting::foot`] |
/// | Psi_check, Psi_hat, Psi_hat^ob of (7.12) | [`Push`] |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestAttraction<T> {
    /// Phi.
    pub trench: T,
    /// k, 1/s. 2 or more in chains, 5 among obstacles (ERRATA).
    pub damping: f64,
    /// c of an additional damping c (v_leader - v), 1/s; 0 is the thesis's law.
    pub leader_damping: f64,
}

/// The nearest point, and whether it draws the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attracting {
    /// The nearest point as a point of the moving segment: [`RigidMotion::at`](super::RigidMotion::at).
    pub foot: GoalMotion,
    /// Steps (5) of 7.5.2 and the recovery of 7.7 and Remark 6.4.1 suspend the attraction; damping goes on.
    pub draws: bool,
}

impl<T: Trench> NearestAttraction<T> {
    /// The acceleration of a robot. (7.4) is this without pushes, and the chain leader's law with its goal point as foot.
    #[inline]
    pub fn steer(
        &self,
        robot: PointState,
        attracting: Attracting,
        leader_velocity: Option<Vector2<f64>>,
        pushes: impl IntoIterator<Item = Push>,
    ) -> Steered {
        let Attracting { foot, draws } = attracting;
        let Unpushed { acceleration, lyapunov, lyapunov_rate, .. } =
            self.unpushed(&Seen { robot: (robot.position, robot.velocity), foot: foot.into(), draws, leader_velocity });
        let mut steered = Steered { acceleration, lyapunov, lyapunov_rate };
        for push in pushes {
            steered.acceleration += push.force;
            steered.lyapunov += push.value;
        }
        steered
    }

    /// [`Self::steer`] without pushes, for one robot or several side by side.
    #[inline(always)]
    pub(crate) fn unpushed<V: Plane>(&self, seen: &Seen<V>) -> Unpushed<V> {
        let (number, none) = (V::Number::splat, V::splat(Vector2::zeros()));
        let ((position, velocity), [foot, foot_velocity, foot_acceleration]) = (seen.robot, seen.foot);
        let (sliding, offset) = (velocity - foot_velocity, foot - position);
        let relative = seen.leader_velocity.map_or(none, |leader| number(self.leader_damping) * (leader - velocity));
        let mut acceleration = foot_acceleration - number(self.damping) * sliding + relative;
        let mut lyapunov = number(0.5) * sliding.norm_squared();
        let mut trench = none;
        if seen.draws {
            trench = pull(&self.trench, offset);
            acceleration = acceleration + trench;
            lyapunov = lyapunov + offset.norm().each(|distance| self.trench.value(distance));
        }
        let lyapunov_rate = relative.dot(&sliding) - number(self.damping) * sliding.norm_squared();
        Unpushed { acceleration, trench, lyapunov, lyapunov_rate }
    }
}

/// What the law looks at, of one robot or of several side by side; m, m/s, m/s^2.
pub(crate) struct Seen<V> {
    /// Position and velocity.
    pub(crate) robot: (V, V),
    /// See [`Attracting::foot`]: position, velocity and acceleration.
    pub(crate) foot: [V; 3],
    /// See [`Attracting::draws`].
    pub(crate) draws: bool,
    pub(crate) leader_velocity: Option<V>,
}

/// What it says.
pub(crate) struct Unpushed<V: Plane> {
    pub(crate) acceleration: V,
    /// Phi' d_hat, which the acceleration holds.
    pub(crate) trench: V,
    pub(crate) lyapunov: V::Number,
    pub(crate) lyapunov_rate: V::Number,
}

impl From<GoalMotion> for [Vector2<f64>; 3] {
    #[inline(always)]
    fn from(GoalMotion { position, velocity, acceleration }: GoalMotion) -> Self {
        [position, velocity, acceleration]
    }
}
