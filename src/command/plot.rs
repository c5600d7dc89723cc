//! `trench plot`: pictures of a run.

mod axes;
mod clip;
mod errors;
mod extensions;
mod field;
mod figures;
mod output;
mod snapshots;
mod speeds;
mod stack;
mod style;
mod ticks;
mod trajectories;

use super::check::{Kind, kind};
use super::{say, sim};
use clap::Args;
use output::Format;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use trench_bag::run::{CsvError, Run};
use trench_bag::{BagError, BagReader};
use trench_core::Files;
use trench_harness::Disk;
use trench_scenario::{Drawing, Figure, Scenario, Task};

/// Draws a run: trajectories, errors, snapshots and speeds over time.
///
/// Reads a bag, or the table that `trench sim` writes, and writes trajectories, errors, snapshots and speeds as SVG and
/// PNG pictures. Of scenarios and their bags it draws the figures that the scenario file asks for.
#[derive(Args)]
pub(crate) struct Arguments {
    /// A bag (folder or .mcap file), a table (.csv) of `trench sim`, or a scenario (.yaml), which is run first.
    run: PathBuf,
    /// Where the pictures go; by default into the bag's folder, or beside the file.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// What to write.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "svg,png")]
    format: Vec<Format>,
    /// When to take snapshots, in seconds since the beginning of the run; by default six,
    /// between which the team goes equally far.
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
    Drawing { name: String, problem: String },
    #[error(transparent)]
    Simulation(#[from] sim::SimError),
    #[error(transparent)]
    Scenario(#[from] trench_config::ConfigError),
    #[error("{}: is a launch file, whose node cores run in trench sim: record a bag there (--bag FOLDER) and plot that", .0.display())]
    Launch(PathBuf),
    #[error("{}: describes no run: give a bag, a table (.csv) of trench sim, or a scenario (kind:)", .0.display())]
    NoRun(PathBuf),
    #[error("{}: does not exist; give a bag (folder or .mcap file), a table (.csv) of trench sim, or a scenario (.yaml)", .0.display())]
    Missing(PathBuf),
    #[error("{}: --at {at} is not of the run, which ends {last} s after its beginning; give seconds between 0 and that", path.display())]
    At { path: PathBuf, at: f64, last: f64 },
}

/// By which share of a run a snapshot may be taken after its last record: bags end a little before what they record does.
const LATE: f64 = 0.01;

/// Draws diagrams of quantities over one horizontal axis, one below the other, as SVG. The legend names the curves in
/// the order of their colours.
pub(super) fn diagrams(
    names: &[String],
    notes: &str,
    horizontal: &str,
    diagrams: &[stack::Diagram],
) -> Result<String, String> {
    stack::draw(names, notes, horizontal, diagrams)
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
    let (run, scenario) = read(&arguments.run)?;
    if let Some(scenario) = scenario.filter(|scenario| !scenario.figures.is_empty() && arguments.at.is_empty()) {
        return draw_figures(arguments, &scenario, &run);
    }
    let Some((first, last)) = run.span() else { return Err(PlotError::Empty(arguments.run.clone())) };
    // What came before the beginning of the run is not part of it.
    let span = (first.max(0.0).min(last), last);
    let latest = span.1 + LATE * (span.1 - span.0);
    if let Some(at) = arguments.at.iter().find(|at| !(0.0..=latest).contains(*at)) {
        return Err(PlotError::At { path: arguments.run.clone(), at: *at, last: span.1 });
    }
    let times = if arguments.at.is_empty() { snapshots::telling_times(&run, span, 6) } else { arguments.at.clone() };
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
        save(arguments, &folder, (name, picture), &mut paths)?;
    }
    Ok(paths)
}

/// The figures that a scenario asks for, named by their numbers.
fn draw_figures(arguments: &Arguments, scenario: &Scenario, run: &Run) -> Result<Vec<PathBuf>, PlotError> {
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.run));
    fs::create_dir_all(&folder).map_err(|source| PlotError::Io { path: folder.clone(), source })?;
    let mut paths = Vec::new();
    for figure in &scenario.figures {
        let picture = match scenario.task {
            Task::Launch(_) => of_launch(figure, run),
            _ => figures::draw(figure, scenario, run),
        };
        save(arguments, &folder, (&figure.file_name(), picture), &mut paths)?;
    }
    Ok(paths)
}

/// A figure of a run of node cores: one of the pictures that every run has, below its title.
fn of_launch(figure: &Figure, run: &Run) -> style::Picture {
    let (first, last) = run.span().ok_or("nobody's pose was recorded")?;
    let span = (first.max(0.0).min(last), last);
    let times = if figure.at.is_empty() { snapshots::telling_times(run, span, 6) } else { figure.at.clone() };
    let picture = match figure.drawing {
        Drawing::Trajectories => trajectories::draw(run, span, &times),
        Drawing::Errors => errors::draw(run, span),
        Drawing::Snapshots => snapshots::draw(run, &times),
        Drawing::Speeds => speeds::draw(run, span),
        _ => Err("runs of launch files have trajectories, errors, snapshots and speeds alone".to_owned()),
    };
    style::titled(&figures::title(figure), &picture?)
}

fn save(
    arguments: &Arguments,
    folder: &Path,
    (name, picture): (&str, style::Picture),
    paths: &mut Vec<PathBuf>,
) -> Result<(), PlotError> {
    let failed = |problem| PlotError::Drawing { name: name.to_owned(), problem };
    let svg = picture.map_err(failed)?;
    for &format in &arguments.format {
        // Figure numbers have a dot, which is no extension.
        let path = folder.join(format!("{name}.{}", format.extension()));
        let bytes = output::encode(&svg, format).map_err(failed)?;
        fs::write(&path, bytes).map_err(|source| PlotError::Io { path: path.clone(), source })?;
        paths.push(path);
    }
    Ok(())
}

/// What is wrong with a file that is no scenario: only launch files are to be run elsewhere.
fn without_run(path: &Path) -> PlotError {
    let name = path.display().to_string();
    let found = Disk.read("FILE", &name).and_then(|text| kind(&name, &text));
    match found {
        Ok(Kind::Launch) => PlotError::Launch(path.to_owned()),
        Ok(_) => PlotError::NoRun(path.to_owned()),
        Err(error) => PlotError::Scenario(error),
    }
}

/// A run, and the scenario that it is of, if it is known.
fn read(path: &Path) -> Result<(Run, Option<Scenario>), PlotError> {
    if path.extension().is_some_and(|extension| extension == "yaml") {
        let Some((scenario, text)) = sim::read(path)? else { return Err(without_run(path)) };
        if let Task::Launch(launch) = &scenario.task {
            return Ok((sim::launched(path, launch)?, Some(scenario)));
        }
        let manner = sim::scenario::Manner { bag: None, progress: false, threads: 1 };
        let done = sim::scenario::run(&scenario, &text, manner).map_err(|error| error.of_run(path))?;
        // Drawn all the same: that is how one sees where.
        if let Some(collision) = done.summary.first_collision() {
            eprintln!("trench plot: {}: collided: {collision}", path.display());
        }
        return Ok((done.run, Some(scenario)));
    }
    if path.extension().is_some_and(|extension| extension == "csv") {
        let text = Disk.read("FILE", &path.display().to_string())?;
        let run = Run::from_csv(&text).map_err(|source| PlotError::Table { path: path.to_owned(), source });
        return Ok((run?, None));
    }
    if !path.exists() {
        return Err(PlotError::Missing(path.to_owned()));
    }
    let bag = BagReader::open(path)?;
    for damage in bag.damage() {
        eprintln!("trench plot: {damage}");
    }
    let run = Run::from_bag(&bag)?;
    let scenario = run.scenario.as_deref().map(|text| trench_scenario::parse("/scenario", text)).transpose()?;
    Ok((run, scenario))
}

fn default_folder(run: &Path) -> PathBuf {
    if run.is_dir() { run.to_owned() } else { run.parent().map_or_else(PathBuf::new, Path::to_owned) }
}
