//! Errors a user can act on.

use crate::brief::{elided, with_short_numbers};
use std::fmt;
use std::sync::Arc;

/// Where a value came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The file, or a word such as "command line" or "default".
    pub file: Arc<str>,
    /// Line, from 1; 0 where there is none.
    pub line: usize,
}

impl Origin {
    /// A line of a file.
    pub fn new(file: impl Into<Arc<str>>, line: usize) -> Self {
        Self { file: file.into(), line }
    }
}

impl Default for Origin {
    fn default() -> Self {
        Self::new("", 0)
    }
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
///
/// ```
/// # use trench_config::{ConfigError, Origin};
/// let error = ConfigError {
///     origin: Origin::new("square.yaml", 7),
///     key: "queues[2].share".to_owned(),
///     value: "1.5".to_owned(),
///     problem: "is above 1".to_owned(),
///     remedy: "write a share from 0 to 1".to_owned(),
/// };
/// assert_eq!(error.to_string(), "square.yaml:7: queues[2].share = 1.5: is above 1; write a share from 0 to 1");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.text())]
pub struct ConfigError {
    /// File and line.
    pub origin: Origin,
    /// The key's full path, for example `gains.k1` or `queues[2].share`; empty for a file as a whole.
    pub key: String,
    /// The value as written; empty where it is missing.
    pub value: String,
    /// What is wrong.
    pub problem: String,
    /// What would be right; empty where the problem says it all.
    pub remedy: String,
}

/// Most characters that are repeated of a value, and of what is said of it.
const MOST_OF_VALUE: usize = 120;
const MOST_OF_PROBLEM: usize = 600;

impl ConfigError {
    fn text(&self) -> String {
        let mut subject = elided(&self.key, MOST_OF_VALUE);
        if !self.value.is_empty() {
            let value = elided(&self.value, MOST_OF_VALUE);
            subject = if subject.is_empty() { value } else { format!("{subject} = {value}") };
        }
        let said = |text: &str| elided(&with_short_numbers(text), MOST_OF_PROBLEM);
        let parts = [self.origin.to_string(), subject, said(&self.problem)];
        let text = parts.iter().filter(|part| !part.is_empty()).map(String::as_str).collect::<Vec<_>>().join(": ");
        if self.remedy.is_empty() { text } else { format!("{text}; {}", said(&self.remedy)) }
    }
}
