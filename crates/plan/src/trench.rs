//! Trenches in parameters.

use crate::expression_remedy;
use trench_config::{ConfigError, Parameters};
use trench_expression::Expression;
use trench_formation::trench::{
    AnyDamping, AnyTrench, Conic, ConstantDamping, CriticallyDamped, Hyperbolic, Meaning, Quadratic, Saturated,
    SlopeTable, SquareRoot, Written,
};

/// Trenches are looked at up to this distance, m.
pub const TRENCH_RANGE: f64 = 100.0;

/// The names `trench.shape` may have.
pub const TRENCH_SHAPES: &str =
    "one of: hyperbolic, quadratic, saturated, conic, square_root, critical, table, potential, slope";

/// The trench that `trench.shape` names: a pull of up to `trench.alpha` (m/s^2), a bottom of width `trench.a` (m); or that which the law's
/// `damping` damps critically (Corollary A.9.1, Example A.9.1); or what a person
/// wrote: `trench.formula` as Phi (potential) or phi (slope), or phi in the rows x, phi of `trench.table`.
///
/// # Errors
/// An unknown shape; a formula or a table that is none, with what is wrong and where.
pub fn trench_from_parameters(parameters: &Parameters) -> Result<AnyTrench, ConfigError> {
    let (alpha, a) = (parameters.f64("trench.alpha")?, parameters.f64("trench.a")?);
    Ok(match parameters.str("trench.shape")? {
        "hyperbolic" => AnyTrench::Hyperbolic(Hyperbolic { alpha, a }),
        "quadratic" => AnyTrench::Quadratic(Quadratic { alpha: alpha / a }),
        "saturated" => AnyTrench::Saturated(Saturated { stiffness: alpha / a, edge: a }),
        "conic" => AnyTrench::Conic(Conic { alpha }),
        "square_root" => AnyTrench::SquareRoot(SquareRoot),
        "critical" => {
            let constant = ConstantDamping { coefficient: parameters.f64("damping")? };
            AnyTrench::Critical(CriticallyDamped(AnyDamping::Constant(constant)))
        }
        "table" => AnyTrench::Table(table(parameters)?),
        "potential" => AnyTrench::Written(Box::new(written(parameters, Meaning::Potential)?)),
        "slope" => AnyTrench::Written(Box::new(written(parameters, Meaning::Slope)?)),
        _ => return Err(parameters.error("trench.shape", "is no trench", TRENCH_SHAPES)),
    })
}

fn written(parameters: &Parameters, meaning: Meaning) -> Result<Written, ConfigError> {
    let key = "trench.formula";
    let formula = Expression::parse(parameters.str(key)?)
        .map_err(|error| parameters.error(key, error.to_string(), expression_remedy(&error)))?;
    Written::new(formula, meaning, TRENCH_RANGE)
        .map_err(|error| parameters.error(key, error.to_string(), "write another formula, like 2*abs(x)"))
}

fn table(parameters: &Parameters) -> Result<SlopeTable, ConfigError> {
    let (key, remedy) = ("trench.table", "write pairs of x (m) and phi (m/s^2), like [0.0, 0.0, 0.5, 0.4]");
    let numbers = parameters.f64_list(key)?;
    if numbers.len() % 2 != 0 {
        return Err(parameters.error(key, "has an odd number of numbers", remedy));
    }
    let rows = numbers.chunks_exact(2).map(|row| (row[0], row[1])).collect();
    SlopeTable::new(rows).map_err(|error| parameters.error(key, error.to_string(), remedy))
}
