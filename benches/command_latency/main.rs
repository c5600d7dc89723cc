//! How long it takes from a camera frame to the commands on the serial port, in the launched square.
//!
//! ```text
//! cargo build --release --workspace --bins && cargo bench --bench command_latency
//! cargo bench --bench command_latency -- together:=true      arguments of the launch file
//! ```
//!
//! Starts `launch/square.launch.yaml` as `trench launch` does, with one process more: a [`probe`] that sits in the serial
//! line between bridge and test bed, hands on all bytes at once, and sees the frames too. The bench is both programs:
//! with `--ros-args` it is the probe.

mod probe;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use trench_launch::{Options, Output, Plan, Process, Request, SuperviseError};

/// Length of the run, s.
const SECONDS: &str = "30.0";

#[derive(Debug, thiserror::Error)]
enum BenchError {
    #[error(transparent)]
    Config(#[from] trench_config::ConfigError),
    #[error(transparent)]
    Supervise(#[from] SuperviseError),
    #[error(transparent)]
    Io(#[from] std::io::Error),
    #[error("the launch file starts no {0}")]
    Missing(&'static str),
}

fn main() -> ExitCode {
    if std::env::args().any(|argument| argument == "--ros-args") {
        // As the bridge whose bytes it hands on: what waits here for the processor would not on a real line.
        trench_runtime::wait_turn(trench_runtime::Turn::Bridge);
        return trench_runtime::run(probe::DESCRIPTION);
    }
    match launch() {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("command_latency: {error}");
            ExitCode::from(2)
        }
    }
}

fn launch() -> Result<u8, BenchError> {
    let own = std::env::current_exe()?;
    // Benches are in the folder below that of the programs.
    let programs = own.ancestors().nth(2).unwrap_or(Path::new("."));
    let folder = std::env::temp_dir().join(format!("trench-command-latency-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let mut plan = resolve(programs, &folder)?;
    insert_probe(&mut plan, &own, &folder)?;
    let code = trench_launch::supervise(&plan, &Options::new(&folder.join("log")))?.exit_code();
    trench_runtime::forget_shared_memory(&shared_memory())?;
    std::fs::remove_dir_all(&folder)?;
    Ok(code)
}

/// The square, with its serial port and its shared memory in a folder of its own.
fn resolve(programs: &Path, folder: &Path) -> Result<Plan, BenchError> {
    let environment: BTreeMap<String, String> = std::env::vars().collect();
    let path = environment.get("PATH").map_or("", String::as_str);
    let mut additions = BTreeMap::from([
        ("PATH".to_owned(), format!("{}:{path}", programs.display())),
        ("TRENCH_STATE_DIR".to_owned(), folder.join("state").display().to_string()),
        ("TRENCH_SHM_PREFIX".to_owned(), shared_memory()),
    ]);
    if !environment.contains_key("ROS_DOMAIN_ID") {
        additions.insert("ROS_DOMAIN_ID".to_owned(), "92".to_owned());
    }
    let mut arguments = BTreeMap::from([
        ("port".to_owned(), line(folder).display().to_string()),
        ("duration".to_owned(), SECONDS.to_owned()),
    ]);
    let given = std::env::args()
        .filter_map(|argument| argument.split_once(":=").map(|(name, value)| (name.to_owned(), value.to_owned())));
    arguments.extend(given);
    Ok(trench_launch::resolve(&Request {
        file: &Path::new(env!("CARGO_MANIFEST_DIR")).join("launch/square.launch.yaml"),
        arguments: &arguments,
        environment: &environment,
        additions: &additions,
        parameter_folder: &folder.join("parameters"),
    })?)
}

/// Gives the bridge another port, and starts the probe between that and the test bed's.
fn insert_probe(plan: &mut Plan, own: &Path, folder: &Path) -> Result<(), BenchError> {
    let is_bridge = |process: &&mut Process| process.argv.first().is_some_and(|program| program == "rf_bridge");
    let bridge = plan.processes.iter_mut().find(is_bridge).ok_or(BenchError::Missing("rf_bridge"))?;
    let tap = folder.join("tap");
    bridge.argv.extend(["-p".to_owned(), format!("serial.port:={}", tap.display())]);
    let mut probe = bridge.clone();
    probe.label = "command_latency".to_owned();
    probe.output = Output::Screen;
    probe.parameter_files.clear();
    probe.argv = [own.display().to_string(), "--ros-args".to_owned()].into();
    for (name, path) in [("line", line(folder)), ("tap", tap)] {
        probe.argv.extend(["-p".to_owned(), format!("{name}:={}", path.display())]);
    }
    plan.processes.push(probe);
    Ok(())
}

/// The prefix of the run's shared memory.
fn shared_memory() -> String {
    format!("latency{}_", std::process::id())
}

/// The test bed's port.
fn line(folder: &Path) -> PathBuf {
    folder.join("line")
}
