//! The projective map from a plane to a picture (R. Hartley's normalised eight-point method, for planes).

use nalgebra::{DMatrix, Matrix3};

/// The map with the least algebraic error from `plane` to `picture`, as many points in each; None where four of them in
/// general position are missing.
pub(crate) fn fit(plane: &[[f64; 2]], picture: &[[f64; 2]]) -> Option<Matrix3<f64>> {
    if plane.len() < 4 || plane.len() != picture.len() {
        return None;
    }
    let (from, into) = (normaliser(plane)?, normaliser(picture)?);
    let apply = |map: &Matrix3<f64>, point: &[f64; 2]| [map.m11 * point[0] + map.m13, map.m22 * point[1] + map.m23];
    let mut rows = DMatrix::zeros(2 * plane.len().max(5), 9);
    for (index, (source, target)) in plane.iter().zip(picture).enumerate() {
        let ([x, y], [u, v]) = (apply(&from, source), apply(&into, target));
        let row = [x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u];
        let other = [0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, -v];
        for column in 0..9 {
            (rows[(2 * index, column)], rows[(2 * index + 1, column)]) = (row[column], other[column]);
        }
    }
    let decomposed = rows.svd(false, true);
    let values = &decomposed.singular_values;
    let smallest = values.imin();
    let next = (0..9).filter(|index| *index != smallest).map(|index| values[index]).fold(f64::INFINITY, f64::min);
    if next < 1e-6 * values.max() {
        return None;
    }
    let row = decomposed.v_t?.row(smallest).clone_owned();
    let map = Matrix3::from_fn(|i, j| row[3 * i + j]);
    let map = into.try_inverse()? * map * from;
    let scale = map.m33;
    (scale.abs() > 1e-12).then(|| map / scale)
}

/// Moves the points' middle to zero and makes them two long.
fn normaliser(points: &[[f64; 2]]) -> Option<Matrix3<f64>> {
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let reach = points.iter().map(|point| libm::hypot(point[0] - x, point[1] - y)).sum::<f64>() / count;
    let scale = std::f64::consts::SQRT_2 / reach;
    scale.is_finite().then(|| Matrix3::new(scale, 0.0, -scale * x, 0.0, scale, -scale * y, 0.0, 0.0, 1.0))
}
