//! `trench launch`: runs a ROS 2 launch file.

mod alarm;
mod journals;
mod reporter;

use clap::Parser;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;
use trench_launch::{Options, Output, Plan, Process, Request, Respawn};
use trench_runtime::Exit;

const EXIT_CODES: &str = "\
Exit codes:
  0    all processes finished cleanly, or the one marked `on_exit: shutdown` ended with 0: the run reached its goal
  n    the process marked `on_exit: shutdown` ended with n (128 + signal if a signal ended it)
  1    a process failed and none is marked `on_exit: shutdown`
  2    the launch file or the arguments are wrong, and nothing was started; or a node refused its command line
  3    a node refused its parameters, or a file that they name: it is not started again, the run ends, its words come last
  12   a node that all robots need died and was not started again: an emergency stop was called, which holds until ~/reset of
       rf_bridge; whatever others ended with
  130  interrupted before the process marked `on_exit: shutdown` ended";

/// Starts and supervises the processes of a ROS 2 launch file in YAML.
///
/// Ctrl-C ends all of them: SIGINT, 5 s later SIGTERM, 5 s later SIGKILL. Their output goes to log files in the run
/// folder, and to the screen where the launch file says `output: screen` (standard error always).
#[derive(Parser)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    /// The launch file, for example launch/square.launch.yaml.
    file: PathBuf,
    /// Arguments of the launch file.
    #[arg(value_name = "NAME:=VALUE", value_parser = name_and_value)]
    arguments: Vec<(String, String)>,
    /// List the arguments of the launch file and stop.
    #[arg(long)]
    show_args: bool,
    /// Print the processes with their arguments, variables and parameter files as JSON and stop.
    #[arg(long)]
    dry_run: bool,
    /// Where logs, parameter files and what the run leaves behind go [default: run/FILE-TIME-PID].
    #[arg(long, value_name = "FOLDER")]
    run_dir: Option<PathBuf>,
    /// Each node keeps a journal for trench bag check, in a folder `journals` beside the bag if one is recorded, else in
    /// the run folder. `images`: camera images too (40 MB/s), so that the localizer can be checked.
    #[arg(long, value_enum, value_name = "WHAT", num_args = 0..=1, require_equals = true, default_missing_value = "messages")]
    journal: Option<journals::Kept>,
    /// Tell nobody on /diagnostics what happens to the processes: no node of the launcher's own joins their network.
    #[arg(long)]
    no_diagnostics: bool,
}

pub(crate) fn name_and_value(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once(":=").ok_or("write name:=value")?;
    Ok((name.to_owned(), value.to_owned()))
}

/// What can go wrong before anything runs.
#[derive(Debug, thiserror::Error)]
enum LaunchError {
    #[error(transparent)]
    Config(#[from] trench_config::ConfigError),
    #[error(transparent)]
    Supervise(#[from] trench_launch::SuperviseError),
    #[error("{} exists already; remove it, or give the run another folder", .0.display())]
    JournalsExist(PathBuf),
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

/// Runs the subcommand.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match launch(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("trench launch: {error}");
            ExitCode::from(2)
        }
    }
}

fn launch(arguments: &Arguments) -> Result<u8, LaunchError> {
    if arguments.show_args {
        show_arguments(&arguments.file)?;
        return Ok(0);
    }
    let run_folder = std::path::absolute(arguments.run_dir.clone().unwrap_or_else(|| default_folder(&arguments.file)))?;
    let environment: BTreeMap<String, String> = std::env::vars_os()
        .filter_map(|(name, value)| Some((name.into_string().ok()?, value.into_string().ok()?)))
        .collect();
    let mut plan = trench_launch::resolve(&Request {
        file: &arguments.file,
        arguments: &arguments.arguments.iter().cloned().collect(),
        environment: &environment,
        additions: &additions(&environment, &run_folder)?,
        parameter_folder: &run_folder.join("parameters"),
    })?;
    for warning in &plan.warnings {
        eprintln!("trench launch: warning: {warning}");
    }
    // Before journals are asked for: they are no nodes of the run.
    let alarm = alarm::of(&plan)?;
    let reporter = if arguments.no_diagnostics { None } else { reporter::of(&plan, &arguments.file)? };
    if let Some(kept) = arguments.journal {
        journals::keep(&mut plan, kept, &run_folder)?;
    }
    if arguments.dry_run {
        let text = serde_json::to_string_pretty(&describe(&plan)).map_err(std::io::Error::from)?;
        writeln!(std::io::stdout(), "{text}")?;
        return Ok(0);
    }
    eprintln!("trench launch: run folder {}", run_folder.display());
    // What they mean no restart can mend.
    let refusals = vec![Exit::Usage as u8, Exit::Configuration as u8];
    let options = Options { refusals, alarm, reporter, ..Options::new(&run_folder.join("log")) };
    Ok(trench_launch::supervise(&plan, &options)?.exit_code())
}

/// Variables that all processes get: the folder of this program first on PATH, so that launch files name our nodes
/// without a path, and where the run leaves its files.
fn additions(
    environment: &BTreeMap<String, String>,
    run_folder: &Path,
) -> Result<BTreeMap<String, String>, std::io::Error> {
    let program = std::env::current_exe()?;
    let own_folder = program.parent().unwrap_or(Path::new("/")).display().to_string();
    let path = match environment.get("PATH") {
        Some(path) => format!("{own_folder}:{path}"),
        None => own_folder,
    };
    Ok(BTreeMap::from([("PATH".to_owned(), path), ("TRENCH_RUN_DIR".to_owned(), run_folder.display().to_string())]))
}

fn default_folder(file: &Path) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.split('.').next().unwrap_or("launch");
    let time = jiff::Timestamp::now().strftime("%Y%m%dT%H%M%SZ");
    Path::new("run").join(format!("{stem}-{time}-{}", std::process::id()))
}

fn show_arguments(file: &Path) -> Result<(), LaunchError> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "Arguments (pass as NAME:=VALUE):")?;
    for argument in trench_launch::arguments(file)? {
        let default = argument.default.map_or("required".to_owned(), |default| format!("default: {default:?}"));
        writeln!(out, "\n  {} ({default})", argument.name)?;
        if !argument.description.is_empty() {
            writeln!(out, "      {}", argument.description)?;
        }
        if !argument.choices.is_empty() {
            writeln!(out, "      one of: {}", argument.choices.join(", "))?;
        }
    }
    Ok(())
}

fn describe(plan: &Plan) -> Value {
    plan.processes.iter().map(describe_process).collect()
}

fn describe_process(process: &Process) -> Value {
    let files: BTreeMap<String, &str> =
        process.parameter_files.iter().map(|file| (file.path.display().to_string(), file.text.as_str())).collect();
    json!({
        "label": process.label,
        "argv": process.argv,
        "env": process.environment,
        "cwd": process.folder,
        "parameter_files": files,
        "start_after": process.start_after.as_secs_f64(),
        "output": if process.output == Output::Screen { "screen" } else { "log" },
        "respawn": process.respawn.as_ref().map(describe_respawn),
        "ends_run": process.ends_run,
        "sigterm_timeout": process.sigterm_timeout.as_secs_f64(),
        "sigkill_timeout": process.sigkill_timeout.as_secs_f64(),
    })
}

fn describe_respawn(respawn: &Respawn) -> Value {
    let delay: Duration = respawn.delay;
    json!({ "delay": delay.as_secs_f64(), "max_retries": respawn.max_retries })
}
