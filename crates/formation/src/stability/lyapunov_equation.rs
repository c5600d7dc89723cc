//! F^T P + P F = -Q, (51) and (76).
use super::eigenvalues::extreme_eigenvalues;
use nalgebra::DMatrix;

/// Why a Lyapunov equation has no solution of use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LyapunovError {
    /// Sizes do not fit.
    #[error("the Lyapunov equation needs square matrices of one size")]
    Shape,
    /// Q.
    #[error("Q of the Lyapunov equation must be symmetric and positive definite")]
    Weight,
    /// The matrix has an eigenvalue that does not decay.
    #[error(
        "the closed loop A - B K is not Hurwitz: its error does not decay (Theorem 8.2.1 needs a gain K that makes it so)"
    )]
    NotHurwitz,
}

/// P = P^T > 0 for a Hurwitz `system` F and `weight` Q = Q^T > 0.
///
/// # Errors
/// When F is not Hurwitz (there is no such P, and only then), Q no weight, or the sizes differ.
pub fn solve_lyapunov(system: &DMatrix<f64>, weight: &DMatrix<f64>) -> Result<DMatrix<f64>, LyapunovError> {
    let size = system.nrows();
    if size == 0 || system.shape() != (size, size) || weight.shape() != (size, size) {
        return Err(LyapunovError::Shape);
    }
    // Written so that not-a-number fails.
    let symmetric = (weight - weight.transpose()).amax() <= 1e-12 * weight.amax();
    if !(symmetric && extreme_eigenvalues(weight).0 > 0.0) {
        return Err(LyapunovError::Weight);
    }
    let (identity, transposed) = (DMatrix::identity(size, size), system.transpose());
    // Column by column, vec(F^T P) = (I x F^T) vec P and vec(P F) = (F^T x I) vec P.
    let operator = identity.kronecker(&transposed) + transposed.kronecker(&identity);
    let right = DMatrix::from_column_slice(size * size, 1, weight.as_slice()) * -1.0;
    let solution = operator.lu().solve(&right).ok_or(LyapunovError::NotHurwitz)?;
    let full = DMatrix::from_column_slice(size, size, solution.as_slice());
    let symmetric = (&full + full.transpose()) * 0.5;
    if extreme_eigenvalues(&symmetric).0 > 0.0 { Ok(symmetric) } else { Err(LyapunovError::NotHurwitz) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn double_integrator_with_poles_at_1_and_2() {
        let system = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -2.0, -3.0]);
        let solution = solve_lyapunov(&system, &DMatrix::identity(2, 2)).unwrap();
        let expected = DMatrix::from_row_slice(2, 2, &[1.25, 0.25, 0.25, 0.25]);
        assert!((solution - expected).amax() < 1e-14);
    }

    #[test]
    fn what_is_refused() {
        let identity = DMatrix::<f64>::identity(2, 2);
        let check = |system: &[f64], weight: &DMatrix<f64>, error| {
            let system = DMatrix::from_row_slice(2, 2, system);
            assert_eq!(solve_lyapunov(&system, weight), Err(error));
        };
        check(&[0.0, 1.0, 2.0, -3.0], &identity, LyapunovError::NotHurwitz);
        check(&[0.0, 1.0, -1.0, 0.0], &identity, LyapunovError::NotHurwitz);
        check(&[0.0, f64::NAN, -1.0, 0.0], &identity, LyapunovError::NotHurwitz);
        check(&[0.0, 1.0, -2.0, -3.0], &(&identity * -1.0), LyapunovError::Weight);
        check(&[0.0, 1.0, -2.0, -3.0], &DMatrix::identity(3, 3), LyapunovError::Shape);
    }

    proptest! {
        #[test]
        fn solves_the_equation(entries in proptest::collection::vec(-1.0..1.0_f64, 9)) {
            let system = DMatrix::from_vec(3, 3, entries) - DMatrix::identity(3, 3) * 4.0;
            let weight = DMatrix::identity(3, 3);
            let p = solve_lyapunov(&system, &weight).unwrap();
            prop_assert!((system.transpose() * &p + &p * &system + weight).amax() < 1e-12);
        }
    }
}
