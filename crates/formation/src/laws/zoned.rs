//! Law (6.1): along a direction of attraction to the segment, in a coordinated chain.
use super::Steered;
use super::goal_tracking::pull;
use crate::Vector2;
use crate::kinematics::PointState;
use crate::trench::Trench;
use crate::zoning::Zoning;

/// u = -k r' + Phi'(d_p) d_p^ + Psi'(d_l) d_l^ + sum of Psi_hat'(d_j) d_j^ + delta, with p the point of attraction, l the
/// leader, j the other robots ahead in the chain.
///
/// delta = Phi'(d_p) |p'|/|r'| (cos phi, sin phi), phi = theta - (gamma_p - varphi_p) - pi, takes out of V' what the moving
/// point of attraction brings in. Where p moves across the direction of attraction (perpendicular directions) that is
/// nothing, and delta only deflects the robot; oblique directions need it. What delta does besides deflecting is [`Attraction::sliding`].
///
/// | thesis | here |
/// |---|---|
/// | k_i | [`Self::damping`] |
/// | Phi_{i,p}, Psi_{i,i-1}, Psi_hat_{i,j} | [`Self::trench`], [`Self::zoning`] |
/// | r_{i,p} and its derivative | [`Attraction`] |
/// | theta_i, varphi_p, gamma_p | directions of r', p' and d_p |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZonedAttraction<T> {
    /// Phi.
    pub trench: T,
    /// Psi and Psi_hat.
    pub zoning: Zoning,
    /// k, 1/s. 2 or more: below, chains whip against their zoning walls (ERRATA).
    pub damping: f64,
    /// c of an additional damping c (v_leader - v), 1/s; 0 is the thesis's law. It calms chains with small k.
    pub leader_damping: f64,
    /// Whether delta is applied.
    pub compensates: bool,
}

/// The point of attraction on the segment, frame `map`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attraction {
    /// Metres.
    pub point: Vector2<f64>,
    /// How it moves because the robot moves, m/s.
    pub velocity: Vector2<f64>,
}

impl Attraction {
    /// On the straight line through `origin` along the unit vector `tangent`, reached from the robot along the unit vector
    /// `direction`; nothing where they are parallel.
    pub fn on_line(
        robot: PointState,
        direction: Vector2<f64>,
        origin: Vector2<f64>,
        tangent: Vector2<f64>,
    ) -> Option<Self> {
        let crossing = direction.perp(&tangent);
        if crossing == 0.0 {
            return None;
        }
        // Components across the direction of attraction agree between the robot and its point.
        let along = |vector: Vector2<f64>| tangent * (direction.perp(&vector) / crossing);
        Some(Self { point: origin + along(robot.position - origin), velocity: along(robot.velocity) })
    }
}

impl Attraction {
    /// s with s . r' = -F . p' for every velocity r' of the robot, where p slides along the unit `tangent` as the robot moves across
    /// `direction`: F + s is minus the gradient of Phi(|p - r|) by the robot's position, and delta - s does no work. m/s^2.
    ///
    /// For F along the direction, which meets the segment at an angle alpha, F + s is perpendicular to the segment and |F| / sin alpha.
    pub fn sliding(force: Vector2<f64>, direction: Vector2<f64>, tangent: Vector2<f64>) -> Vector2<f64> {
        let crossing = direction.perp(&tangent);
        if crossing == 0.0 {
            return Vector2::zeros();
        }
        force.dot(&tangent) / crossing * Vector2::new(direction.y, -direction.x)
    }
}

impl<T: Trench> ZonedAttraction<T> {
    /// The acceleration of a follower; `ahead` are the robots before its leader in the chain. Without a leader, where it does not hear it,
    /// nothing ties the follower to it.
    ///
    /// The derivative of V holds while leader and robots ahead rest, as in A.12.
    pub fn steer(
        &self,
        robot: PointState,
        attraction: Attraction,
        leader: impl Into<Option<PointState>>,
        ahead: &[Vector2<f64>],
    ) -> Steered {
        let offset = attraction.point - robot.position;
        let force = pull(&self.trench, offset);
        let delta =
            if self.compensates { compensation(force, attraction.velocity, robot.velocity) } else { Vector2::zeros() };
        let mut acceleration = force + delta - self.damping * robot.velocity;
        let mut lyapunov = 0.5 * robot.velocity.norm_squared() + self.trench.value(offset.norm());
        let mut lyapunov_rate =
            force.dot(&attraction.velocity) + delta.dot(&robot.velocity) - self.damping * robot.velocity.norm_squared();
        if let Some(leader) = leader.into() {
            let (towards, distance) = direction(leader.position - robot.position);
            let relative = self.leader_damping * (leader.velocity - robot.velocity);
            acceleration += self.zoning.force(distance) * towards + relative;
            lyapunov += self.zoning.value(distance);
            lyapunov_rate += relative.dot(&robot.velocity);
        }
        for other in ahead {
            let (towards, distance) = direction(other - robot.position);
            acceleration += self.zoning.repulsion(distance) * towards;
            lyapunov += self.zoning.repulsive_value(distance);
        }
        Steered { acceleration, lyapunov, lyapunov_rate }
    }

    /// How far the robot still travels across `direction` (a unit vector) if nothing but its damping acts on it, m: a direction
    /// of attraction is proper when the segment, seen along it, reaches that far (6.3).
    pub fn drift_across(&self, direction: Vector2<f64>, robot: PointState) -> f64 {
        direction.perp(&robot.velocity).abs() / self.damping
    }
}

/// delta of (6.1). In complex numbers its direction is -r' conj(d_p) p', so no angle is computed.
fn compensation(force: Vector2<f64>, point_velocity: Vector2<f64>, velocity: Vector2<f64>) -> Vector2<f64> {
    let speed_squared = velocity.norm_squared();
    if speed_squared == 0.0 {
        return Vector2::zeros();
    }
    let (real, imaginary) = (force.dot(&point_velocity), force.perp(&point_velocity));
    let turned = Vector2::new(velocity.x * real - velocity.y * imaginary, velocity.x * imaginary + velocity.y * real);
    -turned / speed_squared
}

/// Unit vector and length of `offset`; robots exactly in one place have no direction, and part along x.
#[inline(always)]
pub(super) fn direction(offset: Vector2<f64>) -> (Vector2<f64>, f64) {
    let distance = offset.norm();
    (if distance == 0.0 { Vector2::new(1.0, 0.0) } else { offset / distance }, distance)
}
