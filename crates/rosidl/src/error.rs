//! What can be wrong with definitions.

/// Why a definition is not understood.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A line is not a constant, a field, a comment or empty.
    #[error("{name}, line {line}: {problem}")]
    Syntax {
        /// The type being parsed.
        name: String,
        /// Counted from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// A service needs exactly one line `---`.
    #[error("{0} has {1} lines `---`, a service has one")]
    Separator(String, usize),
    /// A name is not `package/msg/Name`.
    #[error("`{0}` is not the name of a type: package/msg/Name is")]
    Name(String),
    /// A field names a message that is not there.
    #[error("{name} uses {missing}, whose definition is missing")]
    Missing {
        /// Who uses it.
        name: String,
        /// What is not there.
        missing: String,
    },
    /// A message contains itself.
    #[error("{0} contains itself")]
    Cycle(String),
    /// Messages inside messages, deeper than any real definition.
    #[error("{0} nests deeper than {1} messages")]
    Depth(String, usize),
    /// Two definitions of one name.
    #[error("{0} is defined twice")]
    Duplicate(String),
    /// Something that ROS 2 allows and no type of ours uses.
    #[error("{name}: {what} is not supported")]
    Unsupported {
        /// Who uses it.
        name: String,
        /// What it is.
        what: &'static str,
    },
}
