//! Levenberg's and Marquardt's method (J. J. Moré's in MINPACK, crate `levenberg-marquardt`) with derivatives by differences.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector};
use nalgebra_for_levenberg as old;

/// Steps of the central differences, relative to 1 or the parameter.
const STEP: f64 = 1e-6;

/// Residuals as functions of parameters. Each residual depends on the first `shared` parameters and on those of its own part.
pub(crate) trait Model {
    /// How many parts there are; part `k` has the parameters from `own(k)` on.
    fn parts(&self) -> usize;
    /// Parameters that all parts share come first.
    fn shared(&self) -> usize;
    /// Parameters that a part has for itself.
    fn own(&self) -> usize;
    /// How many residuals a part has.
    fn residuals_of(&self, part: usize) -> usize;
    /// Puts them into `into`; false where the model has no value.
    fn residuals(&self, part: usize, shared: &[f64], own: &[f64], into: &mut [f64]) -> bool;
}

/// What was found.
pub(crate) struct Solution {
    pub(crate) parameters: Vec<f64>,
    /// In the order of the parts.
    pub(crate) residuals: Vec<f64>,
    /// Standard deviations of the shared parameters, of the residuals' own scatter.
    pub(crate) deviations: Vec<f64>,
}

/// The parameters with the least sum of squares near `start`; None where the method finds none.
pub(crate) fn solve(model: &dyn Model, start: Vec<f64>) -> Option<Solution> {
    let problem = Problem { model, parameters: old::DVector::from_vec(start) };
    let (problem, report) = LevenbergMarquardt::new().with_patience(200).minimize(problem);
    let residuals = problem.residuals()?;
    if !report.termination.was_successful() || !residuals.iter().all(|residual| residual.is_finite()) {
        return None;
    }
    let jacobian = problem.jacobian()?;
    let (rows, columns) = jacobian.shape();
    let jacobian = DMatrix::from_fn(rows, columns, |row, column| jacobian[(row, column)]);
    let freedom = rows.saturating_sub(columns).max(1) as f64;
    let variance = residuals.norm_squared() / freedom;
    let spread: DMatrix<f64> = (jacobian.tr_mul(&jacobian)).try_inverse()?;
    let deviations = (0..model.shared()).map(|index| libm::sqrt(variance * spread[(index, index)].max(0.0))).collect();
    let plain = |vector: &old::DVector<f64>| -> Vec<f64> { vector.iter().copied().collect() };
    Some(Solution { parameters: plain(&problem.parameters), residuals: plain(&residuals), deviations })
}

struct Problem<'a> {
    model: &'a dyn Model,
    parameters: old::DVector<f64>,
}

impl Problem<'_> {
    /// The residuals of a part with these shared and own parameters.
    fn part(&self, part: usize, shared: &[f64], own: &[f64]) -> Option<DVector<f64>> {
        let mut residuals = DVector::zeros(self.model.residuals_of(part));
        self.model.residuals(part, shared, own, residuals.as_mut_slice()).then_some(residuals)
    }

    fn split(&self, part: usize) -> (&[f64], &[f64]) {
        let (shared, own) = (self.model.shared(), self.model.own());
        let all = self.parameters.as_slice();
        (&all[..shared], &all[shared + part * own..shared + (part + 1) * own])
    }

    fn rows(&self) -> usize {
        (0..self.model.parts()).map(|part| self.model.residuals_of(part)).sum()
    }
}

impl LeastSquaresProblem<f64, old::Dyn, old::Dyn> for Problem<'_> {
    type ParameterStorage = old::VecStorage<f64, old::Dyn, old::U1>;
    type ResidualStorage = old::VecStorage<f64, old::Dyn, old::U1>;
    type JacobianStorage = old::VecStorage<f64, old::Dyn, old::Dyn>;

    fn set_params(&mut self, parameters: &old::DVector<f64>) {
        self.parameters.clone_from(parameters);
    }

    fn params(&self) -> old::DVector<f64> {
        self.parameters.clone()
    }

    fn residuals(&self) -> Option<old::DVector<f64>> {
        let mut all = Vec::with_capacity(self.rows());
        for part in 0..self.model.parts() {
            let (shared, own) = self.split(part);
            all.extend(self.part(part, shared, own)?.iter());
        }
        Some(old::DVector::from_vec(all))
    }

    fn jacobian(&self) -> Option<old::DMatrix<f64>> {
        let mut jacobian = old::DMatrix::zeros(self.rows(), self.parameters.len());
        let mut first = 0;
        for part in 0..self.model.parts() {
            let (shared, own) = self.split(part);
            let mut both = [shared, own].concat();
            for index in 0..both.len() {
                let (value, step) = (both[index], STEP * both[index].abs().max(1.0));
                let mut at = |value: f64| {
                    both[index] = value;
                    self.part(part, &both[..shared.len()], &both[shared.len()..])
                };
                let (above, below) = (at(value + step)?, at(value - step)?);
                both[index] = value;
                let column = if index < shared.len() { index } else { index + part * own.len() };
                for (row, slope) in ((above - below) / (2.0 * step)).iter().enumerate() {
                    jacobian[(first + row, column)] = *slope;
                }
            }
            first += self.model.residuals_of(part);
        }
        Some(jacobian)
    }
}
