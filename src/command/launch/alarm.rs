//! What the launcher does when a node that all robots need is lost: an emergency stop.

use std::path::Path;
use std::time::Duration;
use trench_launch::{Alarm, Output, Plan, Process, Respawn};

/// Nodes without which all robots stand, by the time-outs of the others (docs/timeouts.md). Without its controller one robot stands,
/// and the others go on without it.
const NEEDED_BY_ALL: [&str; 6] =
    ["testbed", "overhead_camera", "overhead_localizer", "leader_assignment", "obstacle_mapper", "rf_bridge"];

/// `trench stop`, for when one of those dies and is not started again: it goes on saying stop until the launch ends, and the stop
/// holds until somebody resets it, so that nothing moves by surprise when the node is mended by hand.
pub(super) fn of(plan: &Plan) -> std::io::Result<Option<Alarm>> {
    let needed: Vec<&Process> = plan.processes.iter().filter(|process| is_needed_by_all(process)).collect();
    let Some(first) = needed.first() else { return Ok(None) };
    let process = Process {
        label: format!("emergency_stop-{}", plan.processes.len() + 1),
        is_node: false,
        argv: command()?,
        parameter_files: Vec::new(),
        start_after: Duration::ZERO,
        output: Output::Screen,
        respawn: Some(Respawn { delay: Duration::from_millis(200), max_retries: None }),
        ends_run: false,
        // Its variables too: they say which network.
        ..(*first).clone()
    };
    Ok(Some(Alarm { process, matters: needed.iter().map(|process| process.label.clone()).collect() }))
}

/// Its name is its own: a hand may be on another one's key (`trench stop --wait`), or another launch may stop as well.
fn command() -> std::io::Result<Vec<String>> {
    let program = std::env::current_exe()?.display().to_string();
    let name = format!("__node:=emergency_stop_of_launch_{}", std::process::id());
    let arguments = ["stop", "--", "--ros-args", "-r", &name];
    Ok(std::iter::once(program).chain(arguments.map(str::to_owned)).collect())
}

fn is_needed_by_all(process: &Process) -> bool {
    let Some((program, arguments)) = process.argv.split_first() else { return false };
    let Some(program) = Path::new(program).file_name() else { return false };
    // The controllers of a team in one process die together.
    let is_team = program == "formation_controller" && arguments.iter().any(|argument| argument == "--namespaces");
    process.is_node && (is_team || NEEDED_BY_ALL.iter().any(|needed| program == *needed))
}
