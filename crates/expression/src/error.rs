//! Texts that are no expressions.
use crate::compile::CONSTANTS;
use crate::function::Function;

/// What is wrong with the text. Columns count characters from 1.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionError {
    /// The text breaks the grammar.
    #[error("does not parse at column {column}: found {found}, expected {expected}")]
    Syntax {
        /// Where.
        column: usize,
        /// What stands there.
        found: String,
        /// What could stand there.
        expected: String,
    },
    /// A name that means nothing.
    #[error("`{name}` at column {column} is unknown")]
    UnknownName {
        /// Where.
        column: usize,
        /// The name.
        name: String,
    },
    /// A function without its arguments, or with too many.
    #[error("`{name}` at column {column} takes {expected}, but has {got}")]
    Arguments {
        /// Where.
        column: usize,
        /// The function.
        name: String,
        /// "1 argument" or the like.
        expected: String,
        /// How many there are.
        got: usize,
    },
    /// A number or constant part that is infinite or not a number.
    #[error("the constant at column {column} is {value}, not a finite number")]
    NotFinite {
        /// Where.
        column: usize,
        /// What it came to.
        value: String,
    },
    /// More than any formula that a person writes.
    #[error("is too long or too deeply nested: at most {characters} characters and {depth} levels are read")]
    TooLarge {
        /// Most characters.
        characters: usize,
        /// Most levels.
        depth: usize,
    },
}

/// All names that may stand in an expression.
pub fn known_names() -> impl Iterator<Item = &'static str> + Clone {
    Function::NAMES.iter().map(|(name, _)| *name).chain(CONSTANTS.iter().map(|(name, _)| *name)).chain(["x"])
}
