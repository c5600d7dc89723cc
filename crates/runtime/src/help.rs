//! `--help`: the parameters of a node, for a newcomer.

use trench_config::ParameterDescriptor;
use trench_core::NodeDescription;

const ARGUMENTS: &str = "\
  --namespaces LIST        a node in each of these namespaces, all in this process: \"[robot1, robot2]\"

ROS arguments (repeatable, ended by --):
  -r FROM:=TO              rename a topic or service; __node:=NAME and __ns:=/NAMESPACE rename the node
  -p [NODE:]NAME:=VALUE    set a parameter; VALUE in YAML
  --params-file FILE       read parameters from a ROS 2 parameter file
  --log-level [NAME:=]LEVEL   debug, info, warn, error or fatal
  --disable-rosout-logs, --disable-stdout-logs

Environment:
  ROS_DOMAIN_ID            the ROS domain, 0 to 232 (default 0)
  TRENCH_STATE_DIR         where checkpoints are kept (default $XDG_RUNTIME_DIR/trench/<domain>, else in /dev/shm)
  TRENCH_SHM_PREFIX        separates shared memory of test runs on one host

Exit codes:
  0 ended as asked   1 system error   2 wrong command line   3 wrong configuration   4 no transport   10.. the node's own
";

/// The text of `--help`.
pub(crate) fn text(description: &NodeDescription, parameters: &[ParameterDescriptor]) -> String {
    let mut text = format!(
        "{about}\n\nUsage: {name} [--help] [--namespaces LIST] [--ros-args ARGUMENTS [--]]\n\n{ARGUMENTS}\nParameters:\n",
        about = description.about,
        name = description.name,
    );
    for parameter in parameters {
        text += &entry(parameter);
    }
    text
}

fn entry(parameter: &ParameterDescriptor) -> String {
    let kind = parameter.default.type_name();
    let range = parameter.range.map_or(String::new(), |(smallest, largest)| format!(", from {smallest} to {largest}"));
    let fixed = if parameter.read_only { ", fixed at start" } else { "" };
    let head = format!("  {} ({kind}{range}{fixed}) = {}\n", parameter.name, parameter.default);
    head + "      " + parameter.description + "\n"
}
