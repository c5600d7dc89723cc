//! Names of the ROS graph.

/// The absolute name that `name` means for the node `node` in `namespace`: `/x` stays, `x` goes below the namespace,
/// `~/x` below the node.
#[must_use]
pub fn resolve_name(name: &str, namespace: &str, node: &str) -> String {
    let namespace = namespace.trim_end_matches('/');
    if name.starts_with('/') {
        name.to_owned()
    } else if let Some(private) = name.strip_prefix('~') {
        format!("{namespace}/{node}{private}")
    } else {
        format!("{namespace}/{name}")
    }
}

#[cfg(test)]
mod tests {
    use super::resolve_name;

    #[test]
    fn absolute_relative_and_private() {
        let check = |name, namespace, expected: &str| assert_eq!(resolve_name(name, namespace, "node"), expected);
        check("/team_state", "/robot1", "/team_state");
        check("cmd_vel", "/robot1", "/robot1/cmd_vel");
        check("cmd_vel", "/", "/cmd_vel");
        check("~/arm", "/", "/node/arm");
        check("~/arm", "/robot1", "/robot1/node/arm");
        check("~", "/robot1", "/robot1/node");
    }
}
