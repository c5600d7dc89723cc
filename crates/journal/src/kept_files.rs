//! Files on their way into a journal and out of it.

use crate::start::FileText;
use std::cell::RefCell;
use trench_config::{ConfigError, Origin};
use trench_core::Files;

/// Reads through other [`Files`] and keeps what it read.
pub struct KeptFiles<'a> {
    inner: &'a dyn Files,
    kept: RefCell<Vec<FileText>>,
}

impl<'a> KeptFiles<'a> {
    /// Through `inner`.
    #[must_use]
    pub fn new(inner: &'a dyn Files) -> Self {
        Self { inner, kept: RefCell::default() }
    }

    /// What was read, in order.
    #[must_use]
    pub fn into_texts(self) -> Vec<FileText> {
        self.kept.into_inner()
    }
}

impl Files for KeptFiles<'_> {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let text = self.inner.read(key, path)?;
        self.kept.borrow_mut().push(FileText { path: path.to_owned(), text: text.clone() });
        Ok(text)
    }
}

/// The files in a journal.
pub struct RecordedFiles<'a>(pub &'a [FileText]);

impl Files for RecordedFiles<'_> {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let found = self.0.iter().find(|file| file.path == path).map(|file| file.text.clone());
        found.ok_or_else(|| ConfigError {
            origin: Origin::new("journal", 0),
            key: key.to_owned(),
            value: path.to_owned(),
            problem: "was not read when the journal was recorded".to_owned(),
            remedy: String::new(),
        })
    }
}
