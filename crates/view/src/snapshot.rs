//! What a browser gets: the parts of the picture that changed since it last asked.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

/// The picture at one time: its parts as JSON, each with the count of its changes.
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    pub(crate) parts: BTreeMap<&'static str, (u64, Arc<str>)>,
    /// The history as JSON, where it was asked for.
    pub(crate) history: Option<Arc<str>>,
}

impl Snapshot {
    /// Whether a browser can start with it.
    #[must_use]
    pub fn has_history(&self) -> bool {
        self.history.is_some()
    }
}

/// What one browser has seen.
#[derive(Debug, Clone, Default)]
pub struct Seen {
    revisions: BTreeMap<&'static str, u64>,
    started: bool,
}

impl Seen {
    /// Whether it waits for a snapshot with a history.
    #[must_use]
    pub fn needs_history(&self) -> bool {
        !self.started
    }

    /// The browser begins anew with the next snapshot that has a history.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// A JSON object of the parts that are new to this browser, or nothing. The first one a browser gets has `history`
    /// too.
    pub fn news(&mut self, snapshot: &Snapshot) -> Option<String> {
        let mut text = String::from("{");
        if !self.started {
            let history = snapshot.history.as_deref()?;
            let _ = write!(text, "\"history\":{history}");
            self.started = true;
        }
        for (name, (revision, json)) in &snapshot.parts {
            if self.revisions.insert(name, *revision) != Some(*revision) {
                let comma = if text.len() > 1 { "," } else { "" };
                let _ = write!(text, "{comma}\"{name}\":{json}");
            }
        }
        text.push('}');
        (text.len() > 2).then_some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_browser_gets_what_is_new_to_it() {
        let part = |revision, text: &str| (revision, Arc::from(text));
        let mut snapshot =
            Snapshot { parts: BTreeMap::from([("a", part(1, "1")), ("b", part(1, "[]"))]), history: None };
        let mut seen = Seen::default();
        assert_eq!(seen.news(&snapshot), None, "without a history there is no beginning");
        snapshot.history = Some("{}".into());
        assert_eq!(seen.news(&snapshot).as_deref(), Some(r#"{"history":{},"a":1,"b":[]}"#));
        assert_eq!(seen.news(&snapshot), None);
        snapshot.parts.insert("a", part(2, "2"));
        assert_eq!(seen.news(&snapshot).as_deref(), Some(r#"{"a":2}"#));
        seen.forget();
        assert_eq!(seen.news(&snapshot).as_deref(), Some(r#"{"history":{},"a":2,"b":[]}"#));
    }
}
