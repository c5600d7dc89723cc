//! [`cascade_bounds`](super::cascade_bounds) for chains whose robots are all alike, in a time that suits long chains.
//!
//! What the error of one robot does to that of another depends on how many are between them alone: W is F + C z, with z the shift by one
//! rank, and so exp(W t) is a power series in z, cut off at the length of the chain. What is done to whole matrices there is done to the
//! blocks of their first columns here. The bounds, and why they are bounds, are the same.
use super::cascade::{MOST_STEPS, STEP, cascade_bounds};
use super::input_to_state::{ChainError, Coupling, QueueRobot, close, input_to_state, recursive_bounds};
use nalgebra::{DMatrix, Matrix2};

/// Powers of z whose coefficients in the exponential of one step are above rounding: those of its series.
const ORDER: usize = 10;

/// For each of the robots of a chain, all like `robot`, what its error never exceeds when the chain starts with errors of the norms
/// `initial_errors`, one for each robot there is.
///
/// # Errors
/// When matrices do not fit, or the closed loop is not Hurwitz.
pub fn uniform_bounds(robot: &QueueRobot, coupling: Coupling, initial_errors: &[f64]) -> Result<Vec<f64>, ChainError> {
    let count = initial_errors.len();
    let closed = close(core::slice::from_ref(robot), coupling)?.pop().map(|closed| [closed.system, closed.coupling]);
    let Some(blocks) = closed.filter(|[system, _]| count > 1 && system.nrows() == 2) else {
        return cascade_bounds(&vec![robot.clone(); count], coupling, initial_errors);
    };
    let recursion = input_to_state(&[robot.clone(), robot.clone()], coupling, 0.5)?;
    let blocks = blocks.map(|block| of_two(&block));
    let norms = blocks.map(|block| norm(&block));
    let step = STEP / (norms[0] + norms[1]).max(f64::MIN_POSITIVE);
    let advance = exponential(blocks.map(|block| block * step), count);
    // The same series of the norms, which commute.
    let growth: Vec<f64> = exponential(norms.map(|norm| Matrix2::from_diagonal_element(norm * step)), count)
        .iter()
        .map(|block| block[0])
        .collect();
    let mut flow = vec![Matrix2::zeros(); count];
    flow[0] = Matrix2::identity();
    let (mut bounds, mut peak, mut errors) = (vec![0.0_f64; count], 0.0_f64, Vec::new());
    for _ in 0..MOST_STEPS {
        let now: Vec<f64> = flow.iter().map(norm).collect();
        errors = (0..count).map(|rank| convolved(&now, initial_errors, rank)).collect();
        for (rank, bound) in bounds.iter_mut().enumerate() {
            *bound = bound.max(convolved(&growth, &errors, rank));
            peak = peak.max(convolved(&growth, &now, rank));
        }
        let mut ahead = 0.0;
        let is_over = errors.iter().zip(&bounds).all(|(error, bound)| {
            ahead += error;
            peak * ahead <= *bound
        });
        if is_over && now.iter().sum::<f64>() < 1.0 {
            return Ok(bounds);
        }
        flow = (0..count).map(|power| coefficient(&advance, &flow, power)).collect();
    }
    let recursion: Vec<_> = (0..count).map(|rank| recursion[rank.min(1)]).collect();
    let rest = recursive_bounds(&recursion, &errors);
    Ok(rest.into_iter().zip(&bounds).map(|(rest, bound)| rest.max(*bound)).collect())
}

fn of_two(block: &DMatrix<f64>) -> Matrix2<f64> {
    Matrix2::from_fn(|row, column| block[(row, column)])
}

/// The larger singular value: with the sum of squares f and the determinant d, sum and difference of both squared are f + 2 |d|, f - 2 |d|.
fn norm(block: &Matrix2<f64>) -> f64 {
    let (squares, twice) = (block.norm_squared(), 2.0 * block.determinant().abs());
    0.5 * ((squares + twice).sqrt() + (squares - twice).max(0.0).sqrt())
}

/// The coefficient of z^`power` in the product of two series, the first of which may end early.
fn convolved(first: &[f64], second: &[f64], power: usize) -> f64 {
    first.iter().take(power + 1).enumerate().map(|(index, one)| one * second[power - index]).sum()
}

fn coefficient(first: &[Matrix2<f64>], second: &[Matrix2<f64>], power: usize) -> Matrix2<f64> {
    let addends = first.iter().take(power + 1).enumerate().map(|(index, block)| block * second[power - index]);
    addends.fold(Matrix2::zeros(), |sum, addend| sum + addend)
}

/// exp(a + b z) up to z^10 for small blocks, by its power series.
fn exponential([a, b]: [Matrix2<f64>; 2], count: usize) -> Vec<Matrix2<f64>> {
    let argument = [a, b];
    let mut unit = vec![Matrix2::zeros(); count.min(ORDER + 1)];
    unit[0] = Matrix2::identity();
    (1..=ORDER).rev().fold(unit.clone(), |sum, order| {
        let next = |(power, unit): (usize, &Matrix2<f64>)| unit + coefficient(&argument, &sum, power) / order as f64;
        unit.iter().enumerate().map(next).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_as_of_the_whole_matrix() {
        let robot = QueueRobot::double_integrator_with(2.5, 2.5);
        for (coupling, errors) in [
            (Coupling::Realisable, vec![0.05; 9]),
            (Coupling::Printed, vec![0.1, 0.0, 0.3, 0.02]),
            (Coupling::Realisable, vec![1.0, 2.0]),
        ] {
            let whole = cascade_bounds(&vec![robot.clone(); errors.len()], coupling, &errors).unwrap();
            let found = uniform_bounds(&robot, coupling, &errors).unwrap();
            assert_eq!(whole.len(), found.len());
            for (whole, found) in whole.iter().zip(&found) {
                assert!((whole - found).abs() <= 1e-9 * whole, "{whole} {found}");
            }
        }
        assert_eq!(uniform_bounds(&robot, Coupling::Realisable, &[]), Ok(Vec::new()));
    }

    /// Ranks ahead know nothing of those behind.
    #[test]
    fn longer_chains_begin_alike() {
        let robot = QueueRobot::double_integrator(1.0, 2.0);
        let [short, long] =
            [12, 40].map(|count| uniform_bounds(&robot, Coupling::Realisable, &vec![1.0; count]).unwrap());
        assert!(short.iter().zip(&long).all(|(short, long)| (short - long).abs() <= 1e-9 * long), "{short:?} {long:?}");
        assert!(long.windows(2).all(|pair| pair[1] > pair[0]), "{long:?}");
    }
}
