//! `trench bag check`: feeds journals to the cores they are of and compares.

mod find;
mod parallel;
mod plot;
mod show;

use super::super::say;
use clap::Args;
use find::FindError;
use plot::DivergenceError;
use std::cmp::Reverse;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use trench_config::ConfigError;
use trench_harness::replay::{self, ReplayError, Report, Tolerances, Verdict};
use trench_journal::{JournalError, JournalReader};

/// The exit code when an output differs.
const DIFFERS: u8 = 1;
/// The exit code when a journal could not be followed to its end.
const UNREADABLE: u8 = 2;

/// What to check.
#[derive(Args)]
#[command(after_help = "\
Exit codes:
  0   every output of every node is the same, bit for bit or as near as --tolerances ask for
  1   an output differs: a change of behaviour
  2   a journal cannot be read, or not to its end")]
pub(super) struct Check {
    /// A folder of journals, one journal, or a bag with a folder `journals` in it or beside it.
    path: PathBuf,
    /// Checks this node alone: its full name, or the last part of it.
    #[arg(long, value_name = "NAME")]
    node: Option<String>,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
    /// Writes what differs anew with the outputs of today: after an intended change of behaviour.
    #[arg(long)]
    update: bool,
    /// By how much fields of messages may differ: a YAML file (docs/bags.md). Without it, not by one bit.
    #[arg(long, value_name = "FILE")]
    tolerances: Option<PathBuf>,
    /// Draws each field that differs, as recorded and as it is now, into pictures in this folder.
    #[arg(long, value_name = "FOLDER")]
    plot: Option<PathBuf>,
}

/// What keeps a check from being made or told.
#[derive(Debug, thiserror::Error)]
enum CheckError {
    #[error(transparent)]
    Find(#[from] FindError),
    #[error(transparent)]
    Tolerances(#[from] ConfigError),
    #[error("{}: {error}", path.display())]
    Read { path: PathBuf, error: std::io::Error },
    #[error(transparent)]
    Plot(#[from] DivergenceError),
}

/// A journal and what came of it.
struct Checked {
    path: PathBuf,
    result: Result<Report, ReplayError>,
    is_updated: bool,
}

impl Check {
    /// Checks, prints and gives the exit code.
    pub(super) fn run(&self) -> ExitCode {
        self.try_run().unwrap_or_else(|error| {
            eprintln!("trench bag check: {error}");
            UNREADABLE.into()
        })
    }

    fn try_run(&self) -> Result<ExitCode, CheckError> {
        let began = Instant::now();
        let tolerances = self.tolerances.as_deref().map_or(Ok(Tolerances::default()), read_tolerances)?;
        let checked = self.check(find::journals(&self.path)?, &tolerances)?;
        if self.json {
            say(format_args!("{:#}\n", show::json(&checked)));
        } else {
            say(show::Table { checked: &checked, took: began.elapsed().as_secs_f64() });
        }
        if let Some(folder) = &self.plot {
            for picture in plot::draw(&checked, folder)? {
                // With --json, standard output is for programs.
                eprintln!("{}", picture.display());
            }
        }
        Ok(checked.iter().map(Checked::exit_code).max().unwrap_or(UNREADABLE).into())
    }

    /// Checks the journals of the nodes asked for, as many at a time as there are processors.
    fn check(&self, paths: Vec<PathBuf>, tolerances: &Tolerances) -> Result<Vec<Checked>, FindError> {
        let paths = match &self.node {
            Some(name) => find::of_node(paths, name)?,
            None => paths,
        };
        let mut opened = parallel::each(paths, |path| (JournalReader::open(&path), path));
        // The longest work first, so that nobody waits for it at the end.
        opened.sort_by_key(|(journal, _)| Reverse(journal.as_ref().map_or(0, work_of)));
        let mut checked = parallel::each(opened, |(journal, path)| check(path, journal, self.update, tolerances));
        checked.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(checked)
    }
}

fn read_tolerances(path: &Path) -> Result<Tolerances, CheckError> {
    let text = std::fs::read_to_string(path).map_err(|error| CheckError::Read { path: path.to_owned(), error })?;
    Ok(Tolerances::parse(&path.display().to_string(), &text)?)
}

/// About how much work a journal is: a step takes as long as 128 bytes.
fn work_of(journal: &JournalReader) -> u64 {
    journal.step_count() + journal.length() / 128
}

fn check(
    path: PathBuf,
    journal: Result<JournalReader, JournalError>,
    update: bool,
    tolerances: &Tolerances,
) -> Checked {
    let journal = match journal {
        Ok(journal) => journal,
        Err(error) => return Checked { path, result: Err(error.into()), is_updated: false },
    };
    let result = replay::replay_within(&journal, tolerances);
    let differs = matches!(&result, Ok(Report { verdict: Verdict::Differs(_), .. }));
    if !(differs && update) {
        return Checked { path, result, is_updated: false };
    }
    let partial = path.with_extension("mcap.partial");
    let renewed = replay::update(&journal, &partial).and_then(|()| replay::move_over(&partial, &path));
    match renewed {
        Ok(()) => Checked { path, result, is_updated: true },
        Err(error) => {
            let _leftover = std::fs::remove_file(&partial);
            Checked { path, result: Err(error), is_updated: false }
        }
    }
}

impl Checked {
    fn exit_code(&self) -> u8 {
        match &self.result {
            Ok(Report { verdict: Verdict::Equal, .. }) => 0,
            Ok(Report { verdict: Verdict::Differs(_), .. }) if self.is_updated => 0,
            Ok(Report { verdict: Verdict::Differs(_), .. }) => DIFFERS,
            Ok(Report { verdict: Verdict::NotReplayable { .. }, .. }) | Err(_) => UNREADABLE,
        }
    }
}
