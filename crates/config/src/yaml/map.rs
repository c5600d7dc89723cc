//! Reading the keys of a map.

use super::{Entry, FromNode, Node};
use crate::{ConfigError, did_you_mean};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// A map that is being read: it remembers the keys asked for, so that [`Map::finish`] can tell the unknown ones.
#[derive(Debug)]
pub struct Map<'a> {
    node: &'a Node,
    entries: &'a [Entry],
    known: RefCell<BTreeSet<String>>,
}

impl<'a> Map<'a> {
    pub(super) fn new(node: &'a Node, entries: &'a [Entry]) -> Self {
        Self { node, entries, known: RefCell::default() }
    }

    /// The node that is this map, for errors about it as a whole.
    #[must_use]
    pub fn as_node(&self) -> &'a Node {
        self.node
    }

    /// All entries in the order of the file. Does not count as asking for them.
    #[must_use]
    pub fn entries(&self) -> &'a [Entry] {
        self.entries
    }

    /// The value of `key`, if it is there.
    #[must_use]
    pub fn opt_node(&self, key: &str) -> Option<&'a Node> {
        self.known.borrow_mut().insert(key.to_owned());
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    /// The value of `key`.
    ///
    /// # Errors
    /// When it is missing.
    pub fn node(&self, key: &str) -> Result<&'a Node, ConfigError> {
        self.opt_node(key).ok_or_else(|| self.missing(key))
    }

    /// The value of `key` as a `T`: a number, a text, a `Vec`, an array `[T; N]` ...
    ///
    /// # Errors
    /// When it is missing or not a `T`.
    pub fn get<T: FromNode>(&self, key: &str) -> Result<T, ConfigError> {
        self.node(key)?.get()
    }

    /// The value of `key` as a `T`, if it is there.
    ///
    /// # Errors
    /// When it is there and not a `T`.
    pub fn opt<T: FromNode>(&self, key: &str) -> Result<Option<T>, ConfigError> {
        self.opt_node(key).map(Node::get).transpose()
    }

    /// The value of `key` as a `T`, `default` where it is missing.
    ///
    /// # Errors
    /// When it is there and not a `T`.
    pub fn get_or<T: FromNode>(&self, key: &str, default: T) -> Result<T, ConfigError> {
        Ok(self.opt(key)?.unwrap_or(default))
    }

    /// A finite real number; an integer serves too.
    ///
    /// # Errors
    /// When it is missing or not one.
    pub fn f64(&self, key: &str) -> Result<f64, ConfigError> {
        self.get(key)
    }

    /// A finite real number, if it is there.
    ///
    /// # Errors
    /// When it is there and not one.
    pub fn opt_f64(&self, key: &str) -> Result<Option<f64>, ConfigError> {
        self.opt(key)
    }

    /// A text.
    ///
    /// # Errors
    /// When it is missing or not one.
    pub fn str(&self, key: &str) -> Result<&'a str, ConfigError> {
        self.node(key)?.str()
    }

    /// A text, if it is there.
    ///
    /// # Errors
    /// When it is there and not one.
    pub fn opt_str(&self, key: &str) -> Result<Option<&'a str>, ConfigError> {
        self.opt_node(key).map(Node::str).transpose()
    }

    /// A list.
    ///
    /// # Errors
    /// When it is missing or not one.
    pub fn list(&self, key: &str) -> Result<&'a [Node], ConfigError> {
        self.node(key)?.list()
    }

    /// A list, empty where it is missing.
    ///
    /// # Errors
    /// When it is there and not one.
    pub fn opt_list(&self, key: &str) -> Result<&'a [Node], ConfigError> {
        self.opt_node(key).map_or(Ok(&[]), Node::list)
    }

    /// A map.
    ///
    /// # Errors
    /// When it is missing or not one.
    pub fn map(&self, key: &str) -> Result<Map<'a>, ConfigError> {
        self.node(key)?.map()
    }

    /// A map, if it is there.
    ///
    /// # Errors
    /// When it is there and not one.
    pub fn opt_map(&self, key: &str) -> Result<Option<Map<'a>>, ConfigError> {
        self.opt_node(key).map(Node::map).transpose()
    }

    /// One of a few words: the value that stands beside the word.
    ///
    /// # Errors
    /// When it is missing or none of them.
    pub fn one_of<T: Copy>(&self, key: &str, words: &[(&str, T)]) -> Result<T, ConfigError> {
        let node = self.node(key)?;
        let text = node.str()?;
        words.iter().find(|(word, _)| *word == text).map(|(_, value)| *value).ok_or_else(|| {
            node.error("is none of the allowed words", did_you_mean(text, words.iter().map(|(word, _)| *word)))
        })
    }

    /// An error about `key` of this map, where it stands.
    #[must_use]
    pub fn error(&self, key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> ConfigError {
        match self.entries.iter().find(|entry| entry.key == key) {
            Some(entry) => entry.node.error(problem, remedy),
            None => ConfigError {
                origin: self.node.origin.clone(),
                key: join(&self.node.path, key),
                value: String::new(),
                problem: problem.into(),
                remedy: remedy.into(),
            },
        }
    }

    /// Checks that no key is left that was not asked for.
    ///
    /// # Errors
    /// When one is: it names the nearest known key.
    pub fn finish(&self) -> Result<(), ConfigError> {
        let known = self.known.borrow();
        match self.entries.iter().find(|entry| !known.contains(&entry.key)) {
            None => Ok(()),
            Some(entry) => Err(ConfigError {
                origin: entry.origin.clone(),
                key: join(&self.node.path, &entry.key),
                value: String::new(),
                problem: "unknown key".to_owned(),
                remedy: did_you_mean(&entry.key, known.iter().map(String::as_str)),
            }),
        }
    }

    fn missing(&self, key: &str) -> ConfigError {
        // A misspelt key is the likely reason, and then the place to look is there.
        let known = self.known.borrow();
        let unknown: Vec<&Entry> = self.entries.iter().filter(|entry| !known.contains(&entry.key)).collect();
        let misspelt = crate::nearest(key, unknown.iter().map(|entry| entry.key.as_str()));
        let remedy = match misspelt {
            Some(misspelt) => format!("add it, or did you mean it by `{misspelt}`?"),
            None => "add it".to_owned(),
        };
        self.error(key, "is missing", remedy)
    }
}

/// The full key of `key` in the map at `path`.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}
