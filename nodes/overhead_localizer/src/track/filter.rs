//! A Kalman filter on the pose and the velocities of a unicycle.
//!
//! | symbol | field |
//! |---|---|
//! | x, y, theta | `pose` |
//! | v, omega | forward and turning speed |
//! | P | `covariance`, over (x, y, theta, v, omega) |
//!
//! Speeds change by white accelerations ([`Motion`]), so the filter is honest about what it cannot know between frames.

use nalgebra::{Matrix2, Matrix3, Point2, SMatrix, SVector, Vector2, Vector3};
use trench_optics::Pose2;

type Matrix5 = SMatrix<f64, 5, 5>;
type Vector5 = SVector<f64, 5>;

/// How freely robots move: white noise on their accelerations and on their sideways slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// How much the forward speed changes in a second, standard deviation, m/s/sqrt(s).
    pub acceleration: f64,
    /// How much the turning speed changes in a second, standard deviation, rad/s/sqrt(s).
    pub turning: f64,
    /// How far a robot slips sideways in a second, standard deviation, m/sqrt(s).
    pub slip: f64,
}

impl Default for Motion {
    /// Small stepper robots: with these the covariances are as large as the errors on the honest test bed (docs/nodes). A
    /// start or stop from full speed is no noise; the tracker knows it by its size.
    fn default() -> Self {
        Self { acceleration: 0.04, turning: 0.4, slip: 0.0003 }
    }
}

/// What the filter knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// m, m, rad in (-pi, pi]
    pub pose: Pose2,
    /// Forward speed, m/s.
    pub v: f64,
    /// Turning speed, rad/s.
    pub omega: f64,
    /// Of (x, y, theta, v, omega).
    pub covariance: Matrix5,
}

/// One robot's filter.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    state: State,
}

/// What is known of the speeds of a robot seen for the first time, m/s and rad/s.
const FIRST_SPEED: f64 = 0.2;
const FIRST_TURN: f64 = 2.0;
/// A robot nobody sees is taken to wander like this, m/sqrt(s) and rad/sqrt(s), within these limits, m and rad.
const WANDER: [f64; 2] = [0.1, 1.0];
pub(super) const FARTHEST: [f64; 2] = [1.0, 3.2];

impl Filter {
    /// A filter that starts at `pose` with these standard deviations (m, m, rad), speeds unknown.
    #[must_use]
    pub fn new(pose: Pose2, sigma: [f64; 3]) -> Self {
        let sigmas = Vector5::new(sigma[0], sigma[1], sigma[2], FIRST_SPEED, FIRST_TURN);
        let covariance = Matrix5::from_diagonal(&sigmas.component_mul(&sigmas));
        Self { state: State { pose, v: 0.0, omega: 0.0, covariance } }
    }

    /// The estimate.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Puts the estimate elsewhere; what is known of its speeds, and how well, stays.
    pub fn place(&mut self, pose: Pose2) {
        self.state.pose = pose;
    }

    /// Moves the estimate `dt` (s) forward.
    pub fn predict(&mut self, dt: f64, motion: &Motion) {
        let State { pose, v, omega, covariance } = self.state;
        // Second order in dt: the heading in the middle of the step.
        let heading = pose.theta + 0.5 * omega * dt;
        let (sine, cosine) = (libm::sin(heading), libm::cos(heading));
        let mut transition = Matrix5::identity();
        transition[(0, 2)] = -v * dt * sine;
        transition[(1, 2)] = v * dt * cosine;
        transition[(0, 3)] = dt * cosine;
        transition[(1, 3)] = dt * sine;
        transition[(0, 4)] = -0.5 * v * dt * dt * sine;
        transition[(1, 4)] = 0.5 * v * dt * dt * cosine;
        transition[(2, 4)] = dt;
        self.state.pose =
            Pose2 { x: pose.x + v * dt * cosine, y: pose.y + v * dt * sine, theta: wrap(pose.theta + omega * dt) };
        self.state.covariance = transition * covariance * transition.transpose();
        self.disturb(dt, heading, motion);
    }

    /// Adds the doubt that `motion` brings in `dt` (s) to an estimate that has headed along `heading` (rad).
    ///
    /// White noise of density q on an acceleration adds q dt^3/3, q dt^2/2 and q dt to the (co)variances of place and speed.
    /// (An acceleration held constant over each frame would not do: with exact measurements the estimated speed then
    /// swings from frame to frame, undamped.)
    pub fn disturb(&mut self, dt: f64, heading: f64, motion: &Motion) {
        let (sine, cosine) = (libm::sin(heading), libm::cos(heading));
        let forward = Vector5::new(cosine, sine, 0.0, 0.0, 0.0);
        let sideways = Vector5::new(-sine, cosine, 0.0, 0.0, 0.0);
        let [speed, theta, turn] = [3, 2, 4].map(|axis| Vector5::ith(axis, 1.0));
        let mut add = |density: f64, place: Vector5, rate: Vector5| {
            let mixed = place * rate.transpose();
            self.state.covariance += density
                * (place * place.transpose() * (dt * dt * dt / 3.0)
                    + (mixed + mixed.transpose()) * (dt * dt / 2.0)
                    + rate * rate.transpose() * dt);
        };
        add(motion.acceleration * motion.acceleration, forward, speed);
        add(motion.turning * motion.turning, theta, turn);
        self.state.covariance += sideways * sideways.transpose() * (motion.slip * motion.slip * dt);
    }

    /// Lets an unseen robot stand for `dt` (s): the pose stays, the doubt about it grows.
    pub fn rest(&mut self, dt: f64) {
        self.state.v = 0.0;
        self.state.omega = 0.0;
        let before = self.state.covariance;
        let mut diagonal = Vector5::new(0.0, 0.0, 0.0, FIRST_SPEED * FIRST_SPEED, FIRST_TURN * FIRST_TURN);
        for axis in 0..3 {
            let [wander, farthest] = [WANDER[axis / 2], FARTHEST[axis / 2]];
            diagonal[axis] = (before[(axis, axis)] + wander * wander * dt).min(farthest * farthest);
        }
        self.state.covariance = Matrix5::from_diagonal(&diagonal);
    }

    /// The difference of a measured pose from the estimate and its covariance, `noise` being that of the measurement.
    #[must_use]
    pub fn innovation(&self, measured: Pose2, noise: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let pose = self.state.pose;
        let difference = Vector3::new(measured.x - pose.x, measured.y - pose.y, wrap(measured.theta - pose.theta));
        (difference, self.state.covariance.fixed_view::<3, 3>(0, 0) + noise)
    }

    /// The squared Mahalanobis distance of a measured pose from the estimate.
    #[must_use]
    pub fn distance2(&self, measured: Pose2, noise: &Matrix3<f64>) -> f64 {
        let (difference, spread) = self.innovation(measured, noise);
        spread.try_inverse().map_or(f64::MAX, |inverse| difference.dot(&(inverse * difference)))
    }

    /// Takes a measured pose with covariance `noise` into the estimate.
    pub fn update(&mut self, measured: Pose2, noise: &Matrix3<f64>) {
        let (difference, spread) = self.innovation(measured, noise);
        let Some(inverse) = spread.try_inverse() else { return };
        let covariance = self.state.covariance;
        let gain = covariance.fixed_view::<5, 3>(0, 0) * inverse;
        // Joseph's form keeps the covariance symmetric and positive.
        let mut keep = Matrix5::identity();
        for column in 0..3 {
            for row in 0..5 {
                keep[(row, column)] -= gain[(row, column)];
            }
        }
        self.correct(gain * difference, keep * covariance * keep.transpose() + gain * noise * gain.transpose());
    }

    /// Takes the measured place of a point `along` (m) the robot's heading from its middle into the estimate; `sigma` (m)
    /// is the standard deviation along each axis.
    pub fn update_point(&mut self, along: f64, measured: Point2<f64>, sigma: f64) {
        let State { pose, covariance, .. } = self.state;
        let (sine, cosine) = libm::sincos(pose.theta);
        let difference = Vector2::new(measured.x - pose.x - along * cosine, measured.y - pose.y - along * sine);
        let mut slope = SMatrix::<f64, 2, 5>::zeros();
        (slope[(0, 0)], slope[(1, 1)]) = (1.0, 1.0);
        (slope[(0, 2)], slope[(1, 2)]) = (-along * sine, along * cosine);
        let noise = Matrix2::identity() * (sigma * sigma);
        let Some(inverse) = (slope * covariance * slope.transpose() + noise).try_inverse() else { return };
        let gain = covariance * slope.transpose() * inverse;
        let keep = Matrix5::identity() - gain * slope;
        self.correct(gain * difference, keep * covariance * keep.transpose() + gain * noise * gain.transpose());
    }

    fn correct(&mut self, step: Vector5, covariance: Matrix5) {
        let State { pose, v, omega, .. } = self.state;
        self.state = State {
            pose: Pose2 { x: pose.x + step[0], y: pose.y + step[1], theta: wrap(pose.theta + step[2]) },
            v: v + step[3],
            omega: omega + step[4],
            covariance,
        };
    }
}

/// The same angle in (-pi, pi], rad.
#[must_use]
pub fn wrap(angle: f64) -> f64 {
    let wrapped = libm::remainder(angle, std::f64::consts::TAU);
    if wrapped <= -std::f64::consts::PI { wrapped + std::f64::consts::TAU } else { wrapped }
}

#[cfg(test)]
mod tests;
