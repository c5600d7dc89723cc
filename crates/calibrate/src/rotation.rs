//! Rotations as vectors: their direction is the axis, their length the angle, rad (O. Rodrigues, 1840).

use nalgebra::{Matrix3, Rotation3, Vector3};

/// The rotation about `vector` by its length.
pub(crate) fn matrix(vector: [f64; 3]) -> Matrix3<f64> {
    Rotation3::new(Vector3::from(vector)).into_inner()
}

/// The vector of the rotation nearest to a matrix whose first two columns are known: those of a plane's homography.
pub(crate) fn vector(first: Vector3<f64>, second: Vector3<f64>) -> [f64; 3] {
    let (first, second) = (first.normalize(), second.normalize());
    // As much is taken from both to make them perpendicular.
    let (middle, across) = ((first + second).normalize(), (first - second).normalize());
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (first, second) = (half * (middle + across), half * (middle - across));
    let columns = Matrix3::from_columns(&[first, second, first.cross(&second)]);
    Rotation3::from_matrix_unchecked(columns).scaled_axis().into()
}
