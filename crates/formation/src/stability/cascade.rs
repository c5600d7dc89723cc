//! A far tighter bound than (8.26): the chain as one linear system.
//!
//! With the block matrix W of (8.28), e_j(t) = sum over k of [exp(W t)]_jk e_k(0), so
//!
//! |e_j(t)| <= n_j(t) = sum over k of |[exp(W t)]_jk| |e_k(0)|,
//!
//! each addend of which some initial error attains. (8.26) multiplies worst cases that never meet: for poles (-1, -2) it is
//! larger by a factor above 10^5 at rank 4.
//!
//! The supremum over t is bounded, not sampled. Within a step, n(t + s) <= exp(s N) n(t) element by element, N the matrix of
//! the norms of the blocks of W. As to what follows the last moment T: let S be the largest norm a block of exp(W t) ever has,
//! and q the largest column sum of |exp(W T)|. After T a block has at most S q, so with q < 1 the largest lies before T, and
//! n_j(t) <= S (n_1(T) + ... + n_j(T)) from T on.
use super::eigenvalues::spectral_norm;
use super::input_to_state::{ChainError, Closed, Coupling, QueueRobot, close, input_to_state, recursive_bounds};
use super::product::product;
use nalgebra::{DMatrix, DVector};

/// Step of the sampling in units of 1/|N|: the bound is too large by about this share.
pub(super) const STEP: f64 = 0.01;
/// Ends a chain that decays too slowly to be followed; the recursion (8.26), valid from any moment on, then takes over.
pub(super) const MOST_STEPS: usize = 200_000;

/// For each robot of `chain`, what its error never exceeds when the chain starts with errors of the norms `initial_errors`
/// (0 for robots beyond its end).
///
/// # Errors
/// When matrices do not fit, or a robot's closed loop is not Hurwitz.
pub fn cascade_bounds(
    chain: &[QueueRobot],
    coupling: Coupling,
    initial_errors: &[f64],
) -> Result<Vec<f64>, ChainError> {
    let recursion = input_to_state(chain, coupling, 0.5)?;
    let system = assemble(&close(chain, coupling)?);
    let norms = block_norms(&system, chain.len());
    let step = STEP / norms.row_sum().amax().max(f64::MIN_POSITIVE);
    let (advance, growth) = (exponential(&(&system * step)), exponential(&(norms * step)));
    let initial = DVector::from_fn(chain.len(), |row, _| initial_errors.get(row).copied().unwrap_or(0.0));
    let mut flow = DMatrix::identity(system.nrows(), system.nrows());
    let (mut bounds, mut peak) = (DVector::zeros(chain.len()), 0.0_f64);
    for _ in 0..MOST_STEPS {
        let now = block_norms(&flow, chain.len());
        let errors = &now * &initial;
        bounds = bounds.sup(&(&growth * &errors));
        peak = peak.max(product(&growth, &now).amax());
        let largest_column_sum = now.row_sum().amax();
        let mut ahead = 0.0;
        let is_over = errors.iter().zip(&bounds).all(|(error, bound)| {
            ahead += error;
            peak * ahead <= *bound
        });
        if is_over && largest_column_sum < 1.0 {
            return Ok(bounds.as_slice().to_vec());
        }
        flow = product(&advance, &flow);
    }
    let rest = recursive_bounds(&recursion, (block_norms(&flow, chain.len()) * &initial).as_slice());
    Ok(rest.into_iter().zip(&bounds).map(|(rest, bound)| rest.max(*bound)).collect())
}

/// W of (8.28).
fn assemble(chain: &[Closed]) -> DMatrix<f64> {
    let states = chain.first().map_or(0, |robot| robot.system.nrows());
    let mut system = DMatrix::zeros(states * chain.len(), states * chain.len());
    for (index, robot) in chain.iter().enumerate() {
        let begin = states * index;
        system.view_mut((begin, begin), (states, states)).copy_from(&robot.system);
        if index + 1 < chain.len() {
            system.view_mut((begin + states, begin), (states, states)).copy_from(&robot.coupling);
        }
    }
    system
}

/// The spectral norms of the `count` x `count` blocks of a block triangular matrix: errors go to the robots behind alone.
fn block_norms(matrix: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let states = matrix.nrows().checked_div(count).unwrap_or(0);
    DMatrix::from_fn(count, count, |row, column| {
        if row < column {
            return 0.0;
        }
        spectral_norm(&matrix.view((states * row, states * column), (states, states)).into_owned())
    })
}

/// exp of a matrix of norm well below 1, by its power series.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let identity = DMatrix::identity(matrix.nrows(), matrix.nrows());
    // Horner; the first term left out is below 1e-26 of the norms used here.
    (1..=10).rev().fold(identity.clone(), |sum, order| &identity + product(matrix, &sum) / f64::from(order))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(length: usize) -> Vec<QueueRobot> {
        vec![QueueRobot::double_integrator(1.0, 2.0); length]
    }

    /// No run of the chain leaves its bound, and the worst run found comes near it.
    #[test]
    fn bounds_every_run_and_little_more() {
        for coupling in [Coupling::Printed, Coupling::Realisable] {
            let bounds = cascade_bounds(&chain(4), coupling, &[1.0; 4]).unwrap();
            let system = assemble(&close(&chain(4), coupling).unwrap());
            let advance = exponential(&(system * 0.01));
            let mut worst = [0.0_f64; 4];
            for case in 0..16_u32.pow(2) {
                let directions = [case % 4, case / 4 % 4, case / 16 % 4, case / 64];
                let mut errors = DVector::zeros(8);
                for (robot, quarter) in directions.into_iter().enumerate() {
                    let (sin, cos) = libm::sincos(0.4 + f64::from(quarter) * core::f64::consts::FRAC_PI_2);
                    errors[2 * robot] = cos;
                    errors[2 * robot + 1] = sin;
                }
                for _ in 0..1500 {
                    for (robot, worst) in worst.iter_mut().enumerate() {
                        *worst = worst.max(errors.rows(2 * robot, 2).norm());
                    }
                    errors = &advance * errors;
                }
            }
            for (worst, bound) in worst.iter().zip(&bounds) {
                assert!(worst <= bound && *worst > 0.4 * bound, "{coupling:?}: {worst} {bound}");
            }
        }
    }

    /// The printed recursion is loose by five orders of magnitude at rank 4; the true bound hardly grows with the rank.
    #[test]
    fn recursion_is_loose() {
        let recursion = input_to_state(&chain(4), Coupling::Printed, 0.5).unwrap();
        let loose = recursive_bounds(&recursion, &[1.0; 4])[3];
        let tight = cascade_bounds(&chain(10), Coupling::Printed, &[1.0; 10]).unwrap();
        assert!(loose / tight[3] > 1e5, "{loose} {tight:?}");
        assert!((tight[3] - 2.126).abs() < 1e-3 && (tight[9] - 3.395).abs() < 1e-3, "{tight:?}");
    }

    #[test]
    fn empty_and_partly_resting_chains() {
        assert_eq!(cascade_bounds(&[], Coupling::Printed, &[]), Ok(Vec::new()));
        let bounds = cascade_bounds(&chain(3), Coupling::Printed, &[0.0, 1.0]).unwrap();
        assert!(bounds[0] == 0.0 && bounds[1] >= 1.0 && bounds[2] > 0.0);
    }
}
