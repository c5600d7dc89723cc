//! `list_parameters`: names below prefixes, down to a depth.

use std::collections::BTreeSet;
use trench_msgs::rcl_interfaces::{ListParametersRequest, ListParametersResult};

/// The names that a request asks for, with the prefixes they stand under.
pub(super) fn list<'a>(names: impl Iterator<Item = &'a str>, request: &ListParametersRequest) -> ListParametersResult {
    let wanted = names.filter(|name| is_wanted(name, request));
    let mut result = ListParametersResult::default();
    let mut prefixes = BTreeSet::new();
    for name in wanted {
        if let Some((prefix, _)) = name.rsplit_once('.') {
            prefixes.insert(prefix.to_owned());
        }
        result.names.push(name.to_owned());
    }
    result.prefixes = prefixes.into_iter().collect();
    result
}

fn is_wanted(name: &str, request: &ListParametersRequest) -> bool {
    let deep_enough = |rest: &str| {
        let dots = rest.bytes().filter(|byte| *byte == b'.').count() as u64;
        request.depth == ListParametersRequest::DEPTH_RECURSIVE || dots < request.depth
    };
    if request.prefixes.is_empty() {
        return deep_enough(name);
    }
    request.prefixes.iter().any(|prefix| {
        name == prefix
            || name.strip_prefix(prefix.as_str()).and_then(|rest| rest.strip_prefix('.')).is_some_and(deep_enough)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_and_depth() {
        let names = ["a", "gains.k1", "gains.k2", "gains.deep.k3", "gainsx"];
        let check = |prefixes: &[&str], depth, expected: &[&str]| {
            let prefixes = prefixes.iter().map(|prefix| (*prefix).to_owned()).collect();
            let result = list(names.iter().copied(), &ListParametersRequest { prefixes, depth });
            assert_eq!(result.names, expected);
        };
        check(&[], 0, &names);
        check(&[], 1, &["a", "gainsx"]);
        check(&["gains"], 0, &["gains.k1", "gains.k2", "gains.deep.k3"]);
        check(&["gains"], 1, &["gains.k1", "gains.k2"]);
        check(&["gains.deep", "a"], 0, &["a", "gains.deep.k3"]);
        let all = list(names.iter().copied(), &ListParametersRequest::default());
        assert_eq!(all.prefixes, ["gains", "gains.deep"]);
    }
}
