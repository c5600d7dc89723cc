//! From YAML to actions, all keys and types checked. Nothing is resolved yet: a wrong key is found also in an action
//! whose condition is false.

mod attributes;
mod command_line;
mod parameter;
mod process;

pub(crate) use attributes::{Text, seconds};
pub(crate) use command_line::Word;
pub(crate) use parameter::{Item, Parameter, ParameterTree, ParameterValue, Type, literal_type};
pub(crate) use process::{Command, NodeCommand, ProcessAction};

use crate::plan::Argument;
use attributes::{list, opt_bool, opt_plain_text, opt_text, plain_text, text};
use trench_config::yaml::{Map, Node, Value};
use trench_config::{ConfigError, did_you_mean};

/// Actions of ROS 2's launch that this launcher knows.
const ACTIONS: [&str; 11] = [
    "arg",
    "executable",
    "group",
    "include",
    "let",
    "node",
    "push-ros-namespace",
    "push_ros_namespace",
    "set_env",
    "timer",
    "unset_env",
];

/// One action of a launch file.
#[derive(Debug)]
pub(crate) struct Action<'a> {
    /// Where it stands.
    pub(crate) node: &'a Node,
    /// When it is done: the text must be true, or false if the flag is set (`unless`).
    pub(crate) condition: Option<(Text<'a>, bool)>,
    /// What it does.
    pub(crate) kind: Kind<'a>,
}

/// What an action does.
#[derive(Debug)]
pub(crate) enum Kind<'a> {
    /// `arg`: declares an argument, with its default.
    Argument { argument: Argument, default: Option<Text<'a>> },
    /// `let`: sets a variable.
    Let { name: Text<'a>, value: Text<'a> },
    /// `set_env`, or `unset_env` without a value.
    Environment { name: Text<'a>, value: Option<Text<'a>> },
    /// `push_ros_namespace`.
    PushNamespace(Text<'a>),
    /// `include`.
    Include { file: Text<'a>, arguments: Vec<(Text<'a>, Text<'a>)> },
    /// `group`.
    Group { scoped: bool, actions: Vec<Action<'a>> },
    /// `timer`: the period in seconds.
    Timer { period: Text<'a>, actions: Vec<Action<'a>> },
    /// `node`, `executable`.
    Process(Box<ProcessAction<'a>>),
}

/// The actions of a launch file, given the root of its YAML.
pub(crate) fn launch_file(root: &Node) -> Result<Vec<Action<'_>>, ConfigError> {
    let map = root.map()?;
    let node = map.node("launch")?;
    map.finish()?;
    actions(node)
}

fn actions(node: &Node) -> Result<Vec<Action<'_>>, ConfigError> {
    node.list()?.iter().map(action).collect()
}

fn action(item: &Node) -> Result<Action<'_>, ConfigError> {
    let Value::Map(entries) = &item.value else {
        return Err(item.error("is no action", "write - action: {key: value}"));
    };
    let [entry] = entries.as_slice() else {
        return Err(item
            .error(format!("has {} keys", entries.len()), "an action has one key, its name: indent what is below it"));
    };
    let node = &entry.node;
    if entry.key == "group" && matches!(node.value, Value::List(_)) {
        return Ok(Action { node, condition: None, kind: Kind::Group { scoped: true, actions: actions(node)? } });
    }
    if !ACTIONS.contains(&entry.key.as_str()) {
        return Err(node.error(format!("unknown action `{}`", entry.key), did_you_mean(&entry.key, ACTIONS)));
    }
    let map = node.map()?;
    let condition = condition(&map)?;
    let kind = kind(&entry.key, &map)?;
    map.finish()?;
    Ok(Action { node, condition, kind })
}

fn condition<'a>(map: &Map<'a>) -> Result<Option<(Text<'a>, bool)>, ConfigError> {
    match (opt_text(map, "if")?, opt_text(map, "unless")?) {
        (Some(_), Some(_)) => Err(map.error("unless", "stands beside `if`", "use one of them")),
        (Some(text), None) => Ok(Some((text, false))),
        (None, Some(text)) => Ok(Some((text, true))),
        (None, None) => Ok(None),
    }
}

fn kind<'a>(name: &str, map: &Map<'a>) -> Result<Kind<'a>, ConfigError> {
    Ok(match name {
        "arg" => argument(map)?,
        "let" => Kind::Let { name: text(map, "name")?, value: text(map, "value")? },
        "set_env" => Kind::Environment { name: text(map, "name")?, value: Some(text(map, "value")?) },
        "unset_env" => Kind::Environment { name: text(map, "name")?, value: None },
        "push_ros_namespace" | "push-ros-namespace" => Kind::PushNamespace(text(map, "namespace")?),
        "include" => Kind::Include { file: text(map, "file")?, arguments: pairs(map, "arg", "name", "value")? },
        "group" => {
            Kind::Group { scoped: opt_bool(map, "scoped")?.unwrap_or(true), actions: actions(map.node("children")?)? }
        }
        "timer" => {
            Kind::Timer { period: attributes::seconds_text(map, "period")?, actions: actions(map.node("children")?)? }
        }
        "node" => Kind::Process(Box::new(process::node(map)?)),
        // `action` lets only the names above and `executable` through.
        _ => Kind::Process(Box::new(process::executable(map)?)),
    })
}

fn argument<'a>(map: &Map<'a>) -> Result<Kind<'a>, ConfigError> {
    let default = opt_text(map, "default")?;
    let argument = Argument {
        name: plain_text(map.node("name")?)?,
        default: opt_plain_text(map, "default")?,
        description: opt_plain_text(map, "description")?.unwrap_or_default(),
        choices: list(map, "choice", |choice| plain_text(choice.node("value")?))?,
    };
    Ok(Kind::Argument { argument, default })
}

/// The entries of the list `key`, each a map with the texts `first` and `second`.
fn pairs<'a>(map: &Map<'a>, key: &str, first: &str, second: &str) -> Result<Vec<(Text<'a>, Text<'a>)>, ConfigError> {
    list(map, key, |entry| Ok((text(entry, first)?, text(entry, second)?)))
}
