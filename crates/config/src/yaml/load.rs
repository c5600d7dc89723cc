//! From text to nodes.

use super::map::join;
use super::{Entry, Node, Value};
use crate::{ConfigError, Origin};
use saphyr_parser::{Event, Marker, Parser, ScalarStyle, ScanError, StrInput, Tag};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Lists and maps deeper than this are refused: no configuration needs them, and reading them recurses.
const DEEPEST: usize = 64;

/// Parses the only document of `text`; `file` names it in errors. An empty file is an empty scalar.
///
/// # Errors
/// On a syntax error, an anchor, alias or unknown tag, a duplicate key, a second document.
pub fn parse(file: &str, text: &str) -> Result<Node, ConfigError> {
    let mut loader = Loader { file: file.into(), parser: Parser::new_from_str(text) };
    let mut root = None;
    loop {
        let (event, at) = loader.next()?;
        match event {
            Event::StreamStart | Event::DocumentStart(_) | Event::DocumentEnd | Event::Nothing => {}
            Event::StreamEnd => break,
            _ if root.is_some() => return Err(loader.refuse(at, "", "a second document", "keep one to a file")),
            event => root = Some(loader.node(event, at, String::new(), 0)?),
        }
    }
    let nothing = Value::Scalar { text: String::new(), plain: true };
    Ok(root.unwrap_or_else(|| Node { value: nothing, origin: Origin::new(file, 1), path: String::new() }))
}

struct Loader<'input> {
    file: Arc<str>,
    parser: Parser<'input, StrInput<'input>>,
}

impl<'input> Loader<'input> {
    fn next(&mut self) -> Result<(Event<'input>, Marker), ConfigError> {
        match self.parser.next_event() {
            Some(Ok((event, span))) => Ok((event, span.start)),
            Some(Err(error)) => Err(self.syntax_error(&error)),
            None => Ok((Event::StreamEnd, Marker::default())),
        }
    }

    fn node(&mut self, event: Event<'input>, at: Marker, path: String, depth: usize) -> Result<Node, ConfigError> {
        if depth > DEEPEST {
            return Err(self.refuse(at, &path, "is nested too deeply", &format!("nest at most {DEEPEST} levels")));
        }
        let value = match event {
            Event::Scalar(text, style, 0, tag) => {
                let plain = !matches!(style, ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted)
                    && !self.is_string_tag(tag.as_deref(), at, &path)?;
                Value::Scalar { text: text.into_owned(), plain }
            }
            Event::SequenceStart(0, None) => Value::List(self.list(&path, depth)?),
            Event::MappingStart(0, None) => Value::Map(self.map(&path, depth)?),
            Event::SequenceStart(0, Some(_)) | Event::MappingStart(0, Some(_)) => {
                return Err(self.refuse(at, &path, "has a tag", "leave tags out"));
            }
            _ => return Err(self.refuse(at, &path, "is an anchor or alias", "write the value out")),
        };
        Ok(Node { value, origin: self.origin(at), path })
    }

    fn list(&mut self, path: &str, depth: usize) -> Result<Vec<Node>, ConfigError> {
        let mut items = Vec::new();
        loop {
            match self.next()? {
                (Event::SequenceEnd, _) => return Ok(items),
                (event, at) => items.push(self.node(event, at, format!("{path}[{}]", items.len()), depth + 1)?),
            }
        }
    }

    fn map(&mut self, path: &str, depth: usize) -> Result<Vec<Entry>, ConfigError> {
        let mut entries = Vec::new();
        let mut keys = BTreeSet::new();
        loop {
            let (key, at) = match self.next()? {
                (Event::MappingEnd, _) => return Ok(entries),
                (Event::Scalar(key, _, 0, None), at) => (key.into_owned(), at),
                (_, at) => return Err(self.refuse(at, path, "has a key that is no plain text", "write key: value")),
            };
            let path = join(path, &key);
            if !keys.insert(key.clone()) {
                return Err(self.refuse(at, &path, "duplicate key", "keep one"));
            }
            let (event, value_at) = self.next()?;
            let node = self.node(event, value_at, path, depth + 1)?;
            entries.push(Entry { key, origin: self.origin(at), node });
        }
    }

    fn is_string_tag(&self, tag: Option<&Tag>, at: Marker, path: &str) -> Result<bool, ConfigError> {
        match tag {
            None => Ok(false),
            Some(tag) if tag.is_yaml_core_schema() && tag.suffix == "str" => Ok(true),
            Some(_) => Err(self.refuse(at, path, "has a tag other than !!str", "leave it out")),
        }
    }

    fn origin(&self, at: Marker) -> Origin {
        Origin::new(Arc::clone(&self.file), at.line())
    }

    fn refuse(&self, at: Marker, path: &str, problem: &str, remedy: &str) -> ConfigError {
        ConfigError {
            origin: self.origin(at),
            key: path.to_owned(),
            value: String::new(),
            problem: problem.to_owned(),
            remedy: remedy.to_owned(),
        }
    }

    fn syntax_error(&self, error: &ScanError) -> ConfigError {
        let column = error.marker().col() + 1;
        let problem = format!("not valid YAML at column {column}: {}", error.info());
        self.refuse(*error.marker(), "", &problem, "check indentation, quotes and brackets")
    }
}
