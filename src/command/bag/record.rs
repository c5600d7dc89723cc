//! `trench bag record`: becomes the node `bag_recorder`, which lies beside this program.

use clap::Args;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::Command;

/// What to record, and where.
#[derive(Args)]
pub(super) struct Record {
    /// The new bag's folder, which must not exist.
    out: PathBuf,
    /// Topics: NAME, or NAME:TYPE where the stack does not know the name (/x:std_msgs/msg/Bool).
    #[arg(long, value_name = "TOPIC", num_args = 1.., conflicts_with = "all")]
    topics: Vec<String>,
    /// All topics of the stack, images excepted. This is the default.
    #[arg(long)]
    all: bool,
    /// The robots whose topics belong to all.
    #[arg(long, value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    robots: Vec<String>,
    /// Further arguments of the node, for example `--ros-args -p use_sim_time:=true`.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

impl Record {
    /// Becomes the recorder, and comes back only where that fails, with the reason.
    pub(super) fn run(&self) -> std::io::Error {
        let program = match std::env::current_exe() {
            Ok(program) => program.with_file_name("bag_recorder"),
            Err(error) => return error,
        };
        let mut command = Command::new(&program);
        command.arg("--ros-args").arg("-p").arg(format!("output:={}", quoted(&self.out.to_string_lossy())));
        for (name, values) in [("topics", &self.topics), ("robots", &self.robots)] {
            if !values.is_empty() {
                let values: Vec<_> = values.iter().map(|value| quoted(value)).collect();
                command.arg("-p").arg(format!("{name}:=[{}]", values.join(", ")));
            }
        }
        let error = command.arg("--").args(&self.node_arguments).exec();
        std::io::Error::new(error.kind(), format!("{}: {error}", program.display()))
    }
}

/// A string as YAML takes it, whatever is in it.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}
