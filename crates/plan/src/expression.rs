//! Expressions in files and parameters, with the errors a person can act on.

use trench_config::yaml::Node;
use trench_config::{ConfigError, did_you_mean};
use trench_expression::{Expression, ExpressionError, known_names};

/// Reads a text as an expression in x; a number serves too.
///
/// # Errors
/// When it is none: the column in the text, what was expected, and the name that was probably meant.
pub fn expression(node: &Node) -> Result<Expression, ConfigError> {
    let text = match node.scalar() {
        Some(trench_config::yaml::Scalar::Integer(number)) => number.to_string(),
        Some(trench_config::yaml::Scalar::Double(number)) => number.to_string(),
        _ => node.str()?.to_owned(),
    };
    Expression::parse(&text).map_err(|error| node.error(error.to_string(), expression_remedy(&error)))
}

/// What to do about a text that is no expression.
#[must_use]
pub fn expression_remedy(error: &ExpressionError) -> String {
    match error {
        ExpressionError::UnknownName { name, .. } => did_you_mean(name, known_names()),
        ExpressionError::Syntax { .. } => "write it like 0.5*sin(2*pi*x/3)".to_owned(),
        ExpressionError::Arguments { expected, .. } => format!("give it {expected}"),
        ExpressionError::NotFinite { .. } => "write a finite number".to_owned(),
        ExpressionError::TooLarge { .. } => "simplify it".to_owned(),
    }
}
