//! Definitions that refer to each other.

use crate::definition::{Definition, Service};
use crate::{Error, hash};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

/// No real definition nests messages deeper than a few levels; a hostile one in a bag could exhaust the stack.
const GREATEST_DEPTH: usize = 32;

/// A set of definitions, in the order of their names.
#[derive(Debug, Clone, Default)]
pub struct Library {
    definitions: BTreeMap<String, Definition>,
    services: BTreeMap<String, Service>,
}

impl Library {
    /// Adds a message, or one half of a service.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn add_message(&mut self, definition: Definition) -> Result<(), Error> {
        match self.definitions.entry(definition.name.clone()) {
            Entry::Vacant(place) => {
                place.insert(definition);
                Ok(())
            }
            Entry::Occupied(taken) => Err(Error::Duplicate(taken.key().clone())),
        }
    }

    /// Adds a service with its two halves.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn add_service(&mut self, service: Service) -> Result<(), Error> {
        self.add_message(service.request.clone())?;
        self.add_message(service.response.clone())?;
        self.services.insert(service.name.clone(), service);
        Ok(())
    }

    /// All messages and halves of services.
    pub fn definitions(&self) -> impl Iterator<Item = &Definition> {
        self.definitions.values()
    }

    /// All services.
    pub fn services(&self) -> impl Iterator<Item = &Service> {
        self.services.values()
    }

    /// The definition of this name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Definition> {
        self.definitions.get(name)
    }

    /// A definition and all it contains, each once, every one behind those that it contains.
    ///
    /// # Errors
    /// When one is missing, contains itself or nests too deeply.
    pub fn closure(&self, name: &str) -> Result<Vec<&Definition>, Error> {
        let mut found = Vec::new();
        self.visit(name, name, &mut Vec::new(), &mut BTreeSet::new(), &mut found)?;
        Ok(found)
    }

    fn visit<'a>(
        &'a self,
        name: &str,
        user: &str,
        path: &mut Vec<&'a str>,
        seen: &mut BTreeSet<&'a str>,
        found: &mut Vec<&'a Definition>,
    ) -> Result<(), Error> {
        if path.contains(&name) {
            return Err(Error::Cycle(name.to_owned()));
        }
        if path.len() == GREATEST_DEPTH {
            return Err(Error::Depth(path[0].to_owned(), GREATEST_DEPTH));
        }
        if seen.contains(name) {
            return Ok(());
        }
        let missing = || Error::Missing { name: user.to_owned(), missing: name.to_owned() };
        let definition = self.definitions.get(name).ok_or_else(missing)?;
        path.push(&definition.name);
        for reference in definition.references() {
            self.visit(reference, name, path, seen, found)?;
        }
        path.pop();
        seen.insert(&definition.name);
        found.push(definition);
        Ok(())
    }

    /// The RIHS01 hash of a message or half of a service.
    ///
    /// # Errors
    /// When something it contains is missing.
    pub fn hash(&self, name: &str) -> Result<String, Error> {
        let mut closure = self.closure(name)?;
        let Some(root) = closure.pop() else {
            return Err(Error::Name(name.to_owned()));
        };
        closure.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(hash::rihs01(root, &closure))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_message;

    fn library(definitions: &[(&str, &str)]) -> Library {
        let mut library = Library::default();
        for (name, text) in definitions {
            library.add_message(parse_message(name, text).expect(text)).expect("another name");
        }
        library
    }

    #[test]
    fn everything_contained_comes_first_and_once() {
        let library = library(&[("p/msg/A", "B b\nC c"), ("p/msg/B", "C[] c"), ("p/msg/C", "uint8 x")]);
        let names: Vec<&str> =
            library.closure("p/msg/A").expect("complete").into_iter().map(|found| found.name.as_str()).collect();
        assert_eq!(names, ["p/msg/C", "p/msg/B", "p/msg/A"]);
    }

    #[test]
    fn what_is_missing_or_circular_is_named() {
        let cyclic = library(&[("p/msg/A", "B b"), ("p/msg/B", "A[] a")]);
        assert_eq!(cyclic.hash("p/msg/A"), Err(Error::Cycle("p/msg/A".to_owned())));
        let missing = Error::Missing { name: "p/msg/A".to_owned(), missing: "p/msg/B".to_owned() };
        assert_eq!(library(&[("p/msg/A", "B b")]).hash("p/msg/A"), Err(missing));
        let chain: Vec<(String, String)> =
            (0..40).map(|index| (format!("p/msg/N{index}"), format!("N{} next", index + 1))).collect();
        let chain: Vec<(&str, &str)> = chain.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        let deep = Error::Depth("p/msg/N0".to_owned(), GREATEST_DEPTH);
        assert_eq!(library(&chain).hash("p/msg/N0"), Err(deep));
    }

    #[test]
    fn a_name_is_taken_once() {
        let mut library = library(&[("p/msg/A", "")]);
        let again = parse_message("p/msg/A", "uint8 x").expect("valid");
        assert_eq!(library.add_message(again), Err(Error::Duplicate("p/msg/A".to_owned())));
        assert_eq!(library.get("p/msg/A").map(|kept| kept.fields.len()), Some(0));
    }

    #[test]
    fn hashes_ignore_comments_constants_and_defaults() {
        // The hash of std_msgs/msg/Empty as ROS 2 states it.
        let empty = "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312";
        assert_eq!(
            library(&[("std_msgs/msg/Empty", "# Nothing.\nuint8 A=1")]).hash("std_msgs/msg/Empty").as_deref(),
            Ok(empty)
        );
        let plain = library(&[("p/msg/A", "uint8 x")]).hash("p/msg/A");
        assert_eq!(library(&[("p/msg/A", "uint8 x 7 # seven")]).hash("p/msg/A"), plain);
        assert_ne!(library(&[("p/msg/A", "uint8 y")]).hash("p/msg/A"), plain);
    }
}
