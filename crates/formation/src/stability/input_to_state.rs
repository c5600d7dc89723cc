//! Input-to-state bounds of a chain, chapter 8 and A.19 as corrected.
//!
//! Robot j of a queue has the error e_j' = F_j e_j + C_j e_{j-1}, F_j = A_j - B_j K_j (8.18), and with V = e^T P e
//!
//! |e_j(t)| <= a_j |e_j(0)| e^(-c_j t) + b_j sup |e_{j-1}|,
//!
//! a = sqrt(lmax P / lmin P), c = (1 - theta) lmin Q / (2 lmax P),
//! b = 2 lmax(P)^(3/2) mu / (theta lmin(Q) lmin(P)^(1/2)), mu = |C_j|.
use super::eigenvalues::{extreme_eigenvalues, spectral_norm};
use super::product::product;
use super::{LyapunovError, solve_lyapunov};
use nalgebra::DMatrix;

/// A robot of a queue, (8.2) with its feedback gain.
#[derive(Debug, Clone, PartialEq)]
pub struct QueueRobot {
    /// A, n x n.
    pub dynamics: DMatrix<f64>,
    /// B, n x m.
    pub input: DMatrix<f64>,
    /// K, m x n.
    pub gain: DMatrix<f64>,
}

/// What a robot's motion does to its follower's error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coupling {
    /// (8.11) as printed: C_j = -F_{j-1}. Needs a beta that exists only if A(..) lies in the range of B.
    Printed,
    /// With beta = 0 and A d = 0: C_j = B K_{j-1}. What a double integrator can do while it moves.
    Realisable,
}

/// The bound of one robot by the norm of its predecessor's error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputToState {
    /// a: how much an initial error may grow.
    pub overshoot: f64,
    /// b: what the largest error of the robot ahead contributes, per unit; 0 for the first.
    pub gain: f64,
    /// c, 1/s.
    pub decay: f64,
}

/// Chains that have no bound.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ChainError {
    /// A robot is not stable, or its matrices do not fit.
    #[error("robot {rank} of the chain: {source}")]
    Robot {
        /// From 1.
        rank: usize,
        /// What is wrong.
        source: LyapunovError,
    },
    /// theta.
    #[error("theta is {0}; it must lie between 0 and 1, both excluded (A.19)")]
    Theta(f64),
}

impl QueueRobot {
    /// A robot on a line that is a double integrator with the closed-loop poles `-first` and `-second` (1/s).
    pub fn double_integrator(first: f64, second: f64) -> Self {
        Self::double_integrator_with(first * second, first + second)
    }

    /// A robot on a line that is a double integrator with K = (`position_gain`, `velocity_gain`), 1/s^2 and 1/s.
    pub fn double_integrator_with(position_gain: f64, velocity_gain: f64) -> Self {
        Self {
            dynamics: DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]),
            input: DMatrix::from_row_slice(2, 1, &[0.0, 1.0]),
            gain: DMatrix::from_row_slice(1, 2, &[position_gain, velocity_gain]),
        }
    }

    /// F = A - B K and B K.
    fn close(&self, states: usize) -> Result<(DMatrix<f64>, DMatrix<f64>), LyapunovError> {
        let inputs = self.input.ncols();
        let fits = self.dynamics.shape() == (states, states)
            && self.input.nrows() == states
            && self.gain.shape() == (inputs, states);
        if !fits {
            return Err(LyapunovError::Shape);
        }
        let feedback = product(&self.input, &self.gain);
        Ok((&self.dynamics - &feedback, feedback))
    }
}

/// A robot with its loop closed.
pub(super) struct Closed {
    /// F_j.
    pub(super) system: DMatrix<f64>,
    /// C of the robot behind.
    pub(super) coupling: DMatrix<f64>,
}

/// The chain with its loops closed; all robots have states of one size.
pub(super) fn close(chain: &[QueueRobot], coupling: Coupling) -> Result<Vec<Closed>, ChainError> {
    let states = chain.first().map_or(0, |robot| robot.dynamics.nrows());
    let closed = chain.iter().enumerate().map(|(index, robot)| {
        let (system, feedback) = robot.close(states).map_err(|source| ChainError::Robot { rank: index + 1, source })?;
        let coupling = match coupling {
            Coupling::Printed => -&system,
            Coupling::Realisable => feedback,
        };
        Ok(Closed { system, coupling })
    });
    closed.collect()
}

/// a, b and c for every robot of a chain, with Q = I and one `theta` for all.
///
/// # Errors
/// When theta is not in (0, 1), matrices do not fit, or a robot's closed loop is not Hurwitz.
pub fn input_to_state(chain: &[QueueRobot], coupling: Coupling, theta: f64) -> Result<Vec<InputToState>, ChainError> {
    if !(theta > 0.0 && theta < 1.0) {
        return Err(ChainError::Theta(theta));
    }
    let mut strength = 0.0;
    let mut bounds = Vec::with_capacity(chain.len());
    for (index, robot) in close(chain, coupling)?.iter().enumerate() {
        let size = robot.system.nrows();
        let p = solve_lyapunov(&robot.system, &DMatrix::identity(size, size))
            .map_err(|source| ChainError::Robot { rank: index + 1, source })?;
        let (low, high) = extreme_eigenvalues(&p);
        bounds.push(InputToState {
            overshoot: (high / low).sqrt(),
            gain: 2.0 * high * high.sqrt() * strength / (theta * low.sqrt()),
            decay: 0.5 * (1.0 - theta) / high,
        });
        strength = spectral_norm(&robot.coupling);
    }
    Ok(bounds)
}

/// M_j = a_j |e_j(0)| + b_j M_{j-1}, the corrected (8.26): no error of robot j ever exceeds M_j.
pub fn recursive_bounds(chain: &[InputToState], initial_errors: &[f64]) -> Vec<f64> {
    let mut ahead = 0.0;
    let steps = chain.iter().zip(initial_errors).map(|(robot, error)| {
        ahead = robot.overshoot * error + robot.gain * ahead;
        ahead
    });
    steps.collect()
}

/// How many robots from the first on have a bound within `tolerance`: the longest chain that may be promised it.
pub fn longest_within(bounds: &[f64], tolerance: f64) -> usize {
    bounds.iter().take_while(|bound| **bound <= tolerance).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_the_recursion() {
        let chain = vec![QueueRobot::double_integrator(1.0, 2.0); 3];
        let found = input_to_state(&chain, Coupling::Printed, 0.5).unwrap();
        assert!((found[0].overshoot - 2.618_034).abs() < 1e-6 && found[0].gain == 0.0);
        let mu = spectral_norm(&close(&chain, Coupling::Printed).unwrap()[0].coupling);
        assert!((mu - 3.702_459_17).abs() < 1e-8);
        // With Q = I, P has the eigenvalues 3/4 -+ sqrt(5/16), and mu^2 = 7 + sqrt(45).
        let (low, high, mu) = (0.75 - 0.3125_f64.sqrt(), 0.75 + 0.3125_f64.sqrt(), (7.0 + 45.0_f64.sqrt()).sqrt());
        let exact = 2.0 * high * high.sqrt() * mu / (0.5 * low.sqrt());
        assert!((found[1].gain - exact).abs() < 1e-10 && (exact / 50.7541 - 1.0).abs() < 1e-6, "{}", found[1].gain);
        assert!((found[1].decay - 0.25 / (0.75 + 0.3125_f64.sqrt())).abs() < 1e-12);
        let bounds = recursive_bounds(&found, &[0.1, 0.2, 0.0]);
        let (first, gain) = (found[0].overshoot, found[1].gain);
        assert!((bounds[1] - (0.2 * first + gain * 0.1 * first)).abs() < 1e-9);
        assert!((bounds[2] - gain * bounds[1]).abs() < 1e-6);
        assert_eq!(longest_within(&bounds, 1.0), 1);
    }

    #[test]
    fn chains_without_a_bound() {
        let sound = QueueRobot::double_integrator(1.0, 2.0);
        assert_eq!(input_to_state(std::slice::from_ref(&sound), Coupling::Printed, 1.0), Err(ChainError::Theta(1.0)));
        let unstable = QueueRobot::double_integrator(1.0, -2.0);
        let error = input_to_state(&[sound.clone(), unstable], Coupling::Printed, 0.5).unwrap_err();
        assert_eq!(error, ChainError::Robot { rank: 2, source: LyapunovError::NotHurwitz });
        let misfit = QueueRobot { gain: DMatrix::zeros(1, 3), ..sound };
        let error = input_to_state(&[misfit], Coupling::Printed, 0.5).unwrap_err();
        assert_eq!(error, ChainError::Robot { rank: 1, source: LyapunovError::Shape });
    }
}
