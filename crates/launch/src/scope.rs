//! What actions see and change: a scoped group works on a copy.

use std::collections::BTreeMap;
use std::time::Duration;

/// Variables, environment and namespace at one place of a launch file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scope {
    /// Launch configurations: arguments and `let`.
    pub(crate) variables: BTreeMap<String, String>,
    /// Environment variables.
    pub(crate) environment: BTreeMap<String, String>,
    /// The absolute namespace pushed so far, if any.
    pub(crate) namespace: Option<String>,
    /// The folder of the launch file that is being read.
    pub(crate) folder: String,
    /// How long after the start of the run timers let actions here begin.
    pub(crate) start_after: Duration,
}

impl Scope {
    /// The absolute namespace of something placed here with the namespace `own`: `own` below the pushed one unless it
    /// is absolute; `None` where neither is given.
    pub(crate) fn namespace_of(&self, own: Option<&str>) -> Option<String> {
        let joined = match (self.namespace.as_deref(), own) {
            (None, None) => return None,
            (Some(base), None) => base.to_owned(),
            (None, Some(own)) => own.to_owned(),
            (Some(_), Some(own)) if own.starts_with('/') => own.to_owned(),
            (Some(base), Some(own)) => format!("{}/{own}", base.trim_end_matches('/')),
        };
        let absolute = if joined.starts_with('/') { joined } else { format!("/{joined}") };
        let trimmed = absolute.trim_end_matches('/');
        Some(if trimmed.is_empty() { "/".to_owned() } else { trimmed.to_owned() })
    }
}

/// Whether `namespace` (absolute) is one that ROS 2 accepts: parts of letters, digits and underscores that do not
/// begin with a digit.
pub(crate) fn is_valid_namespace(namespace: &str) -> bool {
    namespace == "/" || namespace.strip_prefix('/').is_some_and(|parts| parts.split('/').all(is_valid_name))
}

/// Whether `name` is a node name that ROS 2 accepts.
pub(crate) fn is_valid_name(name: &str) -> bool {
    !name.is_empty()
        && !name.starts_with(|first: char| first.is_ascii_digit())
        && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn namespaces_nest_unless_absolute() {
        for (base, own, expected) in [
            (None, None, None),
            (Some("/a"), None, Some("/a")),
            (None, Some("b"), Some("/b")),
            (Some("/a"), Some("b/"), Some("/a/b")),
            (Some("/a"), Some("/b"), Some("/b")),
            (Some("/"), Some("b"), Some("/b")),
            (None, Some("/"), Some("/")),
        ] {
            let scope = Scope { namespace: base.map(str::to_owned), ..Scope::default() };
            assert_eq!(scope.namespace_of(own).as_deref(), expected, "{base:?} {own:?}");
        }
    }

    #[test]
    fn names_follow_ros() {
        for (namespace, expected) in [("/", true), ("/a/b_1", true), ("/1a", false), ("/a//b", false), ("/a-b", false)]
        {
            assert_eq!(is_valid_namespace(namespace), expected, "{namespace}");
        }
    }
}
