//! `trench plot`: pictures of a run.

mod axes;
mod errors;
mod field;
mod output;
mod snapshots;
mod speeds;
mod style;
mod trajectories;

use super::say;
use clap::Args;
use output::Format;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use trench_bag::run::{CsvError, Run};
use trench_bag::{BagError, BagReader};

/// Draws a run: trajectories, errors, snapshots and speeds over time.
///
/// Reads a bag, or the table that `trench sim` writes, and writes trajectories, errors, snapshots and speeds as SVG and
/// PNG pictures.
#[derive(Args)]
pub(crate) struct Arguments {
    /// A bag (folder or .mcap file), or a table (.csv) of `trench sim`.
    run: PathBuf,
    /// Where the pictures go; by default into the bag's folder, or beside the file.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// What to write.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "svg,png")]
    format: Vec<Format>,
    /// When to take snapshots, in seconds since the beginning of the run; by default six, evenly spaced.
    #[arg(long, value_name = "SECONDS", value_delimiter = ',')]
    at: Vec<f64>,
}

/// Why there are no pictures.
#[derive(Debug, thiserror::Error)]
enum PlotError {
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error("{}: {source}", path.display())]
    Table { path: PathBuf, source: CsvError },
    #[error("{}: {source}", path.display())]
    Io { path: PathBuf, source: std::io::Error },
    #[error("{}: no robot's pose is in it: neither /ground_truth/<robot>/odom nor /team_state was recorded", .0.display())]
    Empty(PathBuf),
    #[error("the picture {name} cannot be drawn: {problem}")]
    Drawing { name: &'static str, problem: String },
}

/// The colours of robots in the order of their names, as style sheets write them.
pub(super) fn colours() -> Vec<String> {
    style::COLOURS.iter().map(|colour| format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)).collect()
}

/// Draws all pictures and says where they are.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    match draw_all(arguments) {
        Ok(paths) => {
            for path in paths {
                say(format_args!("{}\n", path.display()));
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("trench plot: {error}");
            ExitCode::FAILURE
        }
    }
}

fn draw_all(arguments: &Arguments) -> Result<Vec<PathBuf>, PlotError> {
    let run = read(&arguments.run)?;
    let Some((first, last)) = run.span() else { return Err(PlotError::Empty(arguments.run.clone())) };
    // What came before the beginning of the run is not part of it.
    let span = (first.max(0.0).min(last), last);
    let times = if arguments.at.is_empty() { evenly(span, 6) } else { arguments.at.clone() };
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.run));
    fs::create_dir_all(&folder).map_err(|source| PlotError::Io { path: folder.clone(), source })?;
    let pictures = [
        ("trajectories", trajectories::draw(&run, span, &times)),
        ("errors", errors::draw(&run, span)),
        ("snapshots", snapshots::draw(&run, &times)),
        ("speeds", speeds::draw(&run, span)),
    ];
    let mut paths = Vec::new();
    for (name, picture) in pictures {
        let svg = picture.map_err(|problem| PlotError::Drawing { name, problem })?;
        for &format in &arguments.format {
            let path = folder.join(name).with_extension(format.extension());
            let bytes = output::encode(&svg, format).map_err(|problem| PlotError::Drawing { name, problem })?;
            fs::write(&path, bytes).map_err(|source| PlotError::Io { path: path.clone(), source })?;
            paths.push(path);
        }
    }
    Ok(paths)
}

fn read(path: &Path) -> Result<Run, PlotError> {
    if path.extension().is_some_and(|extension| extension == "csv") {
        let text = fs::read_to_string(path).map_err(|source| PlotError::Io { path: path.to_owned(), source })?;
        return Run::from_csv(&text).map_err(|source| PlotError::Table { path: path.to_owned(), source });
    }
    let bag = BagReader::open(path)?;
    for damage in bag.damage() {
        eprintln!("trench plot: {damage}");
    }
    Ok(Run::from_bag(&bag)?)
}

fn default_folder(run: &Path) -> PathBuf {
    if run.is_dir() { run.to_owned() } else { run.parent().map_or_else(PathBuf::new, Path::to_owned) }
}

fn evenly((first, last): (f64, f64), count: u32) -> Vec<f64> {
    (0..count).map(|index| first + (last - first) * f64::from(index) / f64::from(count - 1)).collect()
}
