//! Texts with substitutions: `$(var name)`, `$(env NAME default)`, `$(dirname)`, `$(find-pkg-share package)`.

mod parse;
mod perform;

pub(crate) use perform::Failure;

/// A text with substitutions in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Template(pub(crate) Vec<Part>);

/// A piece of a [`Template`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Part {
    /// Stands for itself.
    Text(String),
    /// `$(name argument ...)`
    Call {
        /// Which substitution.
        name: String,
        /// Its arguments, which may hold substitutions themselves.
        arguments: Vec<Template>,
    },
}

impl Template {
    /// The text, if it has no substitution.
    pub(crate) fn literal(&self) -> Option<&str> {
        match self.0.as_slice() {
            [] => Some(""),
            [Part::Text(text)] => Some(text),
            _ => None,
        }
    }
}
