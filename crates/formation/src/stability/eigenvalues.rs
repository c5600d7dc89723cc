//! Eigenvalues of small symmetric matrices by Jacobi's rotations: plain arithmetic in a fixed order.
use super::product::product;
use nalgebra::DMatrix;

/// The smallest and the largest eigenvalue of a symmetric matrix (its upper triangle counts).
pub(super) fn extreme_eigenvalues(symmetric: &DMatrix<f64>) -> (f64, f64) {
    let mut matrix = symmetric.clone();
    let size = matrix.nrows();
    let negligible = f64::EPSILON * f64::EPSILON * matrix.norm_squared();
    // Convergence is quadratic: a handful of sweeps; not-a-number matrices end the loop too.
    for _ in 0..50 {
        let row_sum =
            |row: usize| (row + 1..size).map(|column| matrix[(row, column)] * matrix[(row, column)]).sum::<f64>();
        let off: f64 = (0..size).map(row_sum).sum();
        if off <= negligible || off.is_nan() {
            break;
        }
        for row in 0..size {
            for column in row + 1..size {
                rotate(&mut matrix, row, column);
            }
        }
    }
    let diagonal = matrix.diagonal();
    (diagonal.min(), diagonal.max())
}

/// Makes element (p, q) zero.
fn rotate(matrix: &mut DMatrix<f64>, p: usize, q: usize) {
    let off = matrix[(p, q)];
    if off == 0.0 {
        return;
    }
    let ratio = (matrix[(q, q)] - matrix[(p, p)]) / (2.0 * off);
    let tangent = 1.0_f64.copysign(ratio) / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    for index in 0..matrix.nrows() {
        let (a, b) = (matrix[(index, p)], matrix[(index, q)]);
        matrix[(index, p)] = cosine * a - sine * b;
        matrix[(index, q)] = sine * a + cosine * b;
    }
    for index in 0..matrix.nrows() {
        let (a, b) = (matrix[(p, index)], matrix[(q, index)]);
        matrix[(p, index)] = cosine * a - sine * b;
        matrix[(q, index)] = sine * a + cosine * b;
    }
}

/// The spectral norm, sqrt(lambda_max(M^T M)).
pub(super) fn spectral_norm(matrix: &DMatrix<f64>) -> f64 {
    extreme_eigenvalues(&product(&matrix.transpose(), matrix)).1.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_nalgebra(entries in proptest::collection::vec(-3.0..3.0_f64, 16)) {
            let square = DMatrix::from_vec(4, 4, entries);
            let symmetric = &square + square.transpose();
            let expected = symmetric.clone().symmetric_eigenvalues();
            let (low, high) = extreme_eigenvalues(&symmetric);
            prop_assert!((low - expected.min()).abs() < 1e-11 && (high - expected.max()).abs() < 1e-11);
            prop_assert!((spectral_norm(&square) - square.singular_values().max()).abs() < 1e-11);
        }
    }
}
