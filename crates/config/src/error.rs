//! Errors a user can act on.

use std::fmt;

/// Where a value came from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Origin {
    /// The file, or a word such as "command line" or "default".
    pub file: String,
    /// Line, from 1; 0 where there is none.
    pub line: usize,
}

impl fmt::Display for Origin {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(formatter, "{}", self.file),
            line => write!(formatter, "{}:{line}", self.file),
        }
    }
}

/// One thing that is wrong with configuration: where, which key, which value, what is wrong, what would be right.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{origin}: {key}{}{value}: {problem}; {remedy}", if value.is_empty() { "" } else { " = " })]
pub struct ConfigError {
    /// File and line.
    pub origin: Origin,
    /// The key's full path, for example `gains.k1` or `queues[2].share`.
    pub key: String,
    /// The value as written; empty where it is missing.
    pub value: String,
    /// What is wrong.
    pub problem: String,
    /// What would be right.
    pub remedy: String,
}
