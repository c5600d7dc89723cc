//! `node` and `executable`.

use super::attributes::{list, opt_count, opt_plain_text, opt_seconds, opt_text, text};
use super::command_line::{Word, words};
use super::parameter::{Parameter, parameter};
use super::{Text, pairs};
use crate::plan::Respawn;
use std::time::Duration;
use trench_config::ConfigError;
use trench_config::yaml::Map;

/// How long a process is given to end after SIGINT, and again after SIGTERM, where the launch file says nothing.
const DEFAULT_TIMEOUT: Duration = Duration::from_secs(5);

/// A process to start.
#[derive(Debug)]
pub(crate) struct ProcessAction<'a> {
    pub(crate) command: Command<'a>,
    /// `name` of an executable, `exec_name` of a node: its label.
    pub(crate) label: Option<Text<'a>>,
    pub(crate) folder: Option<Text<'a>>,
    pub(crate) environment: Vec<(Text<'a>, Text<'a>)>,
    pub(crate) output: Option<Text<'a>>,
    /// Whether to start it again, and how if so.
    pub(crate) respawn: Option<(Text<'a>, Respawn)>,
    pub(crate) ends_run: bool,
    pub(crate) sigterm_timeout: Duration,
    pub(crate) sigkill_timeout: Duration,
}

/// What to run.
#[derive(Debug)]
pub(crate) enum Command<'a> {
    /// The words of `cmd`, and where they stand.
    Executable(Vec<Word>, Text<'a>),
    /// A ROS node.
    Node(Box<NodeCommand<'a>>),
}

/// A ROS node.
#[derive(Debug)]
pub(crate) struct NodeCommand<'a> {
    pub(crate) executable: Text<'a>,
    pub(crate) package: Option<Text<'a>>,
    /// The words of `args` and of `ros_args`, and where they stand.
    pub(crate) arguments: Option<(Vec<Word>, Text<'a>)>,
    pub(crate) ros_arguments: Option<(Vec<Word>, Text<'a>)>,
    pub(crate) name: Option<Text<'a>>,
    pub(crate) namespace: Option<Text<'a>>,
    pub(crate) parameters: Vec<Parameter<'a>>,
    pub(crate) remaps: Vec<(Text<'a>, Text<'a>)>,
}

pub(super) fn executable<'a>(map: &Map<'a>) -> Result<ProcessAction<'a>, ConfigError> {
    let command = text(map, "cmd")?;
    let words = words(&command)?;
    if words.is_empty() {
        return Err(map.error("cmd", "is empty", "write a program and its arguments"));
    }
    process(map, "name", Command::Executable(words, command))
}

pub(super) fn node<'a>(map: &Map<'a>) -> Result<ProcessAction<'a>, ConfigError> {
    let opt_words = |key| {
        let split = |text: Text<'a>| words(&text).map(|words| (words, text));
        opt_text(map, key)?.map(split).transpose()
    };
    let node = NodeCommand {
        executable: text(map, "exec")?,
        package: opt_text(map, "pkg")?,
        arguments: opt_words("args")?,
        ros_arguments: opt_words("ros_args")?,
        name: opt_text(map, "name")?,
        namespace: opt_text(map, "namespace")?,
        parameters: list(map, "param", parameter)?,
        remaps: pairs(map, "remap", "from", "to")?,
    };
    process(map, "exec_name", Command::Node(Box::new(node)))
}

fn process<'a>(map: &Map<'a>, label: &str, command: Command<'a>) -> Result<ProcessAction<'a>, ConfigError> {
    let ends_run = match opt_plain_text(map, "on_exit")?.as_deref() {
        None => false,
        Some("shutdown") => true,
        Some(_) => return Err(map.error("on_exit", "is no reaction known here", "write shutdown")),
    };
    let delay = opt_seconds(map, "respawn_delay")?.unwrap_or_default();
    // A negative number of retries means no limit, as there.
    let max_retries = opt_count(map, "respawn_max_retries")?.and_then(|count| u32::try_from(count).ok());
    Ok(ProcessAction {
        command,
        label: opt_text(map, label)?,
        folder: opt_text(map, "cwd")?,
        environment: pairs(map, "env", "name", "value")?,
        output: opt_text(map, "output")?,
        respawn: opt_text(map, "respawn")?.map(|text| (text, Respawn { delay, max_retries })),
        ends_run,
        sigterm_timeout: opt_seconds(map, "sigterm_timeout")?.unwrap_or(DEFAULT_TIMEOUT),
        sigkill_timeout: opt_seconds(map, "sigkill_timeout")?.unwrap_or(DEFAULT_TIMEOUT),
    })
}
