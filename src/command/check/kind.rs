//! What a file is, by what stands in it.

use trench_config::yaml::{self, Node, Value};
use trench_config::{ConfigError, Origin};

/// A kind of file that can be judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::command) enum Kind {
    /// `queues:`
    Formation,
    /// `launch:`
    Launch,
    /// `ros__parameters:` under each key.
    Parameters,
    /// `kind:`
    Scenario,
}

/// The kind of the file called `file`.
pub(in crate::command) fn kind(file: &str, text: &str) -> Result<Kind, ConfigError> {
    let root = yaml::parse(file, text)?;
    let map = root.map()?;
    // Before launch files: a scenario may name one.
    if trench_scenario::is_scenario(text) && !has_parameters(&root) {
        return Ok(Kind::Scenario);
    }
    if map.opt_node("launch").is_some() {
        return Ok(Kind::Launch);
    }
    if map.opt_node("queues").is_some() {
        return Ok(Kind::Formation);
    }
    if has_parameters(&root) {
        return Ok(Kind::Parameters);
    }
    Err(ConfigError {
        origin: Origin::new(file, 0),
        key: String::new(),
        value: String::new(),
        problem: "is no formation (queues:), launch (launch:), scenario (kind:) or parameter file (ros__parameters:)"
            .to_owned(),
        remedy: "check one of these".to_owned(),
    })
}

/// Whether `ros__parameters` is a key somewhere.
fn has_parameters(node: &Node) -> bool {
    match &node.value {
        Value::Map(entries) => {
            entries.iter().any(|entry| entry.key == "ros__parameters" || has_parameters(&entry.node))
        }
        Value::Scalar { .. } | Value::List(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_told_apart() {
        let check = |text: &str, expected: Kind| assert_eq!(kind("a.yaml", text), Ok(expected), "{text}");
        check("name: a\nqueues: []\n", Kind::Formation);
        check("launch:\n- node: {exec: a}\n", Kind::Launch);
        check("/**/testbed:\n  ros__parameters: {plant: ideal}\n", Kind::Parameters);
        check("/robot1:\n  formation_controller:\n    ros__parameters: {law: robust}\n", Kind::Parameters);
        check("name: a\nkind: regulation\n", Kind::Scenario);
        check("name: a\nkind: launch\nlaunch: b.yaml\n", Kind::Scenario);
        // Its kind was forgotten.
        check("name: a\nduration: 1.0\nstep: 0.1\n", Kind::Scenario);
        let error = kind("a.yaml", "camera: 1\n").unwrap_err().to_string();
        assert!(error.starts_with("a.yaml: is no formation (queues:)"), "{error}");
    }
}
