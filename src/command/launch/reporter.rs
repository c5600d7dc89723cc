//! Who tells /diagnostics what happens to the processes of a launch.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;
use trench_core::arguments::{Arguments, Names};
use trench_core::resolve_name;
use trench_launch::{Output, Plan, Process, Reporter};

/// A process of its own (decision 15), on the network of the first node: its variables say which. Where there is no node, nobody
/// listens: a router needs none.
pub(super) fn of(plan: &Plan, file: &Path) -> std::io::Result<Option<Reporter>> {
    let Some(first) = plan.processes.iter().find(|process| process.is_node) else { return Ok(None) };
    let process = Process {
        label: "diagnostics".to_owned(),
        is_node: true,
        argv: command(first, file)?,
        parameter_files: Vec::new(),
        start_after: Duration::ZERO,
        output: Output::Log,
        respawn: None,
        ends_run: false,
        ..first.clone()
    };
    let named = |process: &Process| Some((process.label.clone(), name(process)?));
    let names: BTreeMap<String, String> = plan.processes.iter().filter_map(named).collect();
    Ok(Some(Reporter { process, names }))
}

fn command(first: &Process, file: &Path) -> std::io::Result<Vec<String>> {
    let program = std::env::current_exe()?.display().to_string();
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let name = format!("__node:=launch_{}_{}", token(host.trim()), std::process::id());
    let file = format!("file:='{}'", file.display().to_string().replace('\'', "''"));
    let own = ["report", "--", "--ros-args", "-r", &name, "-p", &file];
    // Where DDS Security is asked for it is who the first node is.
    let enclave = arguments(first).map(|arguments| ["--enclave".to_owned(), arguments.enclave]);
    Ok(std::iter::once(program).chain(own.map(str::to_owned)).chain(enclave.into_iter().flatten()).collect())
}

/// The full name of the one node of a process.
fn name(process: &Process) -> Option<String> {
    let arguments = process.is_node.then(|| arguments(process)).flatten()?;
    let program = Path::new(process.argv.first()?).file_name()?.to_str()?;
    let [one] = arguments.of_each_node(program).try_into().ok()?;
    let names = Names::new(&one.remaps, program);
    Some(resolve_name("~", &names.namespace, &names.node))
}

fn arguments(process: &Process) -> Option<Arguments> {
    Arguments::parse(process.argv.iter().skip(1).cloned()).ok()
}

/// As ROS allows it within a node's name.
fn token(text: &str) -> String {
    text.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_config::Origin;

    fn process(is_node: bool, argv: &[&str]) -> Process {
        Process {
            label: "label-1".to_owned(),
            is_node,
            argv: argv.iter().map(|&word| word.to_owned()).collect(),
            environment: BTreeMap::new(),
            folder: None,
            parameter_files: Vec::new(),
            start_after: Duration::ZERO,
            output: Output::Log,
            respawn: None,
            ends_run: false,
            sigterm_timeout: Duration::ZERO,
            sigkill_timeout: Duration::ZERO,
            origin: Origin::default(),
        }
    }

    #[test]
    fn a_process_has_the_name_of_its_node_if_it_is_one() {
        let named = |is_node, argv: &[&str]| name(&process(is_node, argv));
        assert_eq!(named(true, &["/opt/rf_bridge", "--ros-args"]).as_deref(), Some("/rf_bridge"));
        let remapped = ["formation_controller", "--ros-args", "-r", "__node:=control", "-r", "__ns:=/robot2"];
        assert_eq!(named(true, &remapped).as_deref(), Some("/robot2/control"));
        assert_eq!(named(true, &["formation_controller", "--namespaces", "[a, b]"]), None, "several nodes");
        assert_eq!(named(true, &["sh", "--ros-args", "-r", "no rule"]), None);
        assert_eq!(named(false, &["trench", "view"]), None);
    }

    #[test]
    fn without_a_node_nobody_is_told() {
        let plan = |processes| Plan { processes, warnings: Vec::new() };
        let of = |processes| of(&plan(processes), Path::new("a.launch.yaml")).unwrap();
        assert!(of(vec![process(false, &["trench", "router"])]).is_none());
        let variable = ("ROS_DOMAIN_ID".to_owned(), Some("7".to_owned()));
        let mut node = process(true, &["rf_bridge", "--ros-args", "--enclave", "/bridge"]);
        node.environment.extend([variable.clone()]);
        let reporter = of(vec![process(false, &["sleep", "9"]), node]).unwrap();
        assert_eq!(reporter.process.environment.into_iter().collect::<Vec<_>>(), [variable]);
        assert_eq!(reporter.process.argv.last().unwrap(), "/bridge");
    }
}
