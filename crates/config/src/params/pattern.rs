//! Which nodes a key of a parameter file means.

/// How closely a pattern names a node; the greater beats the lesser.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Match {
    /// Through `*` or `**`.
    Wildcard,
    /// By its full name.
    FullName,
}

/// Whether `pattern` means the node `full_name` (`/ns/name`). `*` stands for exactly one part of a name, `**` for any
/// number of parts; a pattern without a leading `/` begins at the root all the same.
pub(super) fn matches(pattern: &str, full_name: &str) -> Option<Match> {
    let pattern: Vec<&str> = pattern.trim_start_matches('/').split('/').collect();
    let name: Vec<&str> = full_name.trim_start_matches('/').split('/').collect();
    if pattern == name {
        return Some(Match::FullName);
    }
    parts_match(&pattern, &name).then_some(Match::Wildcard)
}

fn parts_match(pattern: &[&str], name: &[&str]) -> bool {
    match (pattern, name) {
        ([], []) => true,
        (["**", rest @ ..], _) => (0..=name.len()).any(|skipped| parts_match(rest, &name[skipped..])),
        ([first, rest @ ..], [part, others @ ..]) => (*first == "*" || first == part) && parts_match(rest, others),
        ([], _) | (_, []) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::{Match, matches};

    #[test]
    fn matches_as_ros_does() {
        for (pattern, name, expected) in [
            ("/**", "/a", Some(Match::Wildcard)),
            ("/**", "/ns/deep/a", Some(Match::Wildcard)),
            ("**", "/ns/a", Some(Match::Wildcard)),
            ("/*", "/a", Some(Match::Wildcard)),
            ("/*", "/ns/a", None),
            ("/**/a", "/a", Some(Match::Wildcard)),
            ("/**/a", "/ns/deep/a", Some(Match::Wildcard)),
            ("/*/a", "/ns/a", Some(Match::Wildcard)),
            ("/*/a", "/ns/deep/a", None),
            ("/ns/*", "/ns/b", Some(Match::Wildcard)),
            ("/ns/a", "/ns/a", Some(Match::FullName)),
            ("ns/a", "/ns/a", Some(Match::FullName)),
            ("a", "/ns/a", None),
            ("/ns/a", "/ns/b", None),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
