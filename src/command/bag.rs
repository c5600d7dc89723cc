//! `trench bag`: look at, judge and repair recorded runs.

use super::say;
use clap::{Args, Subcommand};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use trench_bag::{BagError, BagMessage, BagReader, BagWriter, Stamp, WriteOptions};

mod analyze;
mod check;
mod info;
mod node;
mod play;
mod record;

/// Records, shows and judges runs in bags (MCAP, as `ros2 bag` and Foxglove read them).
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Records topics into a new bag until it is stopped (Ctrl-C). A killed recorder loses less than a second.
    Record(record::Record),
    /// Publishes what is in a bag at the pace at which it was recorded, as `ros2 bag play` does.
    Play(play::Play),
    /// Says what is in a bag: files, duration, topics with types, counts and rates, and what is damaged.
    Info {
        /// A bag's folder or an .mcap file.
        bag: PathBuf,
    },
    /// Judges a run: final errors, time to conform, distances, zones, links, message rates, gaps and latencies; or the
    /// noise of robots that stand.
    Analyze(analyze::Analyze),
    /// Replays journals through the node cores and compares every output: the regression test of recorded runs.
    Check(check::Check),
    /// Copies all intact messages of a damaged or unfinished bag into a new one and says what is lost.
    Recover {
        /// A bag's folder or an .mcap file.
        bag: PathBuf,
        /// The new bag's folder, which must not exist.
        out: PathBuf,
    },
}

/// Runs the action.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    let done = match &arguments.action {
        Action::Record(record) => {
            eprintln!("trench bag: {}", record.run());
            return ExitCode::FAILURE;
        }
        Action::Play(play) => {
            eprintln!("trench bag: {}", play.run());
            return ExitCode::FAILURE;
        }
        Action::Check(check) => return check.run(),
        Action::Info { bag } => BagReader::open(bag).map(|bag| say(info::Info(&bag))),
        Action::Analyze(analyze) => return told(analyze.run()),
        Action::Recover { bag, out } => recover(bag, out),
    };
    told(done)
}

/// The exit code, with the error where there is one.
fn told(done: Result<(), impl Display>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("trench bag: {error}");
            ExitCode::FAILURE
        }
    }
}

fn recover(path: &Path, out: &Path) -> Result<(), BagError> {
    let bag = with_damage_told(BagReader::examine(path)?);
    let mut writer = BagWriter::create(out, WriteOptions::reproducible())?;
    let copied = copy(&bag, &mut writer);
    // Also a copy that a full disk ended is finished: it is a bag.
    let count = writer.message_count();
    writer.finish()?;
    copied?;
    say(format_args!("{count} messages recovered into {}\n", out.display()));
    Ok(())
}

fn copy(bag: &BagReader, writer: &mut BagWriter) -> Result<(), BagError> {
    let mut ids = Vec::new();
    for topic in bag.topics() {
        ids.push(writer.add_topic(&topic.name, topic.topic_type(), topic.qos())?);
    }
    for message in bag.messages() {
        let message = message?;
        let BagMessage { log_time, publish_time, sequence, .. } = message;
        if let Some(&id) = ids.get(message.topic) {
            writer.write(id, Stamp { log_time, publish_time, sequence }, &message)?;
        }
    }
    Ok(())
}

/// Says what is damaged.
fn with_damage_told(bag: BagReader) -> BagReader {
    for damage in bag.damage() {
        eprintln!("trench bag: {damage}");
    }
    bag
}
