//! `trench bag analyze`: the table of a run.

use super::super::plot::diagrams;
use super::super::say;
use super::with_damage_told;
use clap::Args;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trench_bag::analysis::{Analysis, AnalysisOptions, Noise, NoiseSeries, analyze, noise};
use trench_bag::run::{Run, RunSummary, StepTable, SummaryOptions, steps, summary};
use trench_bag::{BagError, BagReader};

/// What to judge.
#[derive(Args)]
pub(super) struct Analyze {
    /// A bag's folder or an .mcap file.
    bag: PathBuf,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
    /// When to give the shape error, in seconds since the beginning of the run.
    #[arg(long, value_name = "SECONDS", value_delimiter = ',')]
    at: Vec<f64>,
    /// Over which interval to give the largest shape error; by default the last third of the goal points' motion and all
    /// that follows. With --noise, when the robots stand; by default all the time.
    #[arg(long, value_names = ["FROM", "TO"], num_args = 2)]
    interval: Vec<f64>,
    /// The radius of zone 1: robots whose centres are nearer than this are told.
    #[arg(long, value_name = "METRES", default_value_t = AnalysisOptions::default().zone_radius)]
    zone: f64,
    /// Analyses the noise of these robots, which must stand, instead: of what the localizer measured, mean, standard
    /// deviation and spectrum (4.5.3).
    #[arg(long, value_name = "ROBOT", num_args = 1..)]
    noise: Vec<String>,
    /// With --noise: draws errors and spectra into pictures in this folder.
    #[arg(long, value_name = "FOLDER", requires = "noise")]
    plot: Option<PathBuf>,
}

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub(super) enum AnalyzeError {
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error("{robot}: fewer than 16 poses between t = {from} s and {to} s in /team_state; it has those of {known}")]
    Still { robot: String, from: f64, to: f64, known: String },
    #[error("{}: {error}", path.display())]
    Write { path: PathBuf, error: std::io::Error },
    #[error("{}: {problem}", path.display())]
    Drawing { path: PathBuf, problem: String },
}

impl Analyze {
    /// Reads and prints.
    pub(super) fn run(&self) -> Result<(), AnalyzeError> {
        let bag = with_damage_told(BagReader::open(&self.bag)?);
        if !self.noise.is_empty() {
            return self.tell_noise(&bag);
        }
        let run = Run::from_bag(&bag)?;
        let mut options = SummaryOptions::default();
        if !self.at.is_empty() {
            options.shape_times = self.at.clone();
        }
        if let &[from, to] = &*self.interval {
            options.interval = Some((from, to));
        }
        let bounds = AnalysisOptions { zone_radius: self.zone, ..AnalysisOptions::default() };
        let (summary, steps) = (summary(&run, &options), steps(&bag)?);
        let analysis = analyze(&bag, &run, &bounds)?;
        if self.json {
            let mut document = merged(&summary, &analysis);
            document["steps"] = json!(steps);
            say(format_args!("{document:#}\n"));
        } else {
            // The table of steps comes last: scripts cut it out.
            say(format_args!("{summary}{analysis}\n{}", StepTable(&steps)));
        }
        Ok(())
    }

    fn tell_noise(&self, bag: &BagReader) -> Result<(), AnalyzeError> {
        let run = Run::measured(bag)?;
        let (from, to) = match *self.interval {
            [from, to] => (from, to),
            _ => run.span().unwrap_or((0.0, 0.0)),
        };
        let mut all = BTreeMap::new();
        for robot in &self.noise {
            let known = || run.robots.keys().cloned().collect::<Vec<_>>().join(", ");
            let still = || AnalyzeError::Still { robot: robot.clone(), from, to, known: known() };
            let found = run.robots.get(robot).and_then(|track| noise(track, from, to)).ok_or_else(still)?;
            if let Some(folder) = &self.plot {
                draw(folder, robot, &found)?;
            }
            all.insert(robot.clone(), found);
        }
        if self.json {
            say(format_args!("{:#}\n", json!(all)));
        } else {
            all.iter().for_each(|(robot, noise)| say(format_args!("{robot}: {noise}")));
        }
        Ok(())
    }
}

/// One object with all figures.
fn merged(summary: &RunSummary, analysis: &Analysis) -> Value {
    let (mut all, more) = (json!(summary), json!(analysis));
    if let (Value::Object(all), Value::Object(more)) = (&mut all, more) {
        all.extend(more);
    }
    all
}

/// Name, notes, horizontal axis and curve of a picture.
type Kind = (&'static str, &'static str, &'static str, fn(&NoiseSeries) -> Vec<(f64, f64)>);

const PICTURES: [Kind; 2] = [
    ("noise", "error: measure less mean", "t (s)", |series| series.errors.clone()),
    // The mean, at 0 Hz, is no noise.
    ("spectrum", "amplitude", "frequency (Hz)", |series| series.spectrum.iter().skip(1).copied().collect()),
];

/// Errors over time (Figures 4.26 to 4.28) and their spectra (4.29 to 4.31).
fn draw(folder: &Path, robot: &str, noise: &Noise) -> Result<(), AnalyzeError> {
    let write = |path: &Path, error| AnalyzeError::Write { path: path.to_owned(), error };
    std::fs::create_dir_all(folder).map_err(|error| write(folder, error))?;
    let series = [("x (m)", &noise.x), ("y (m)", &noise.y), ("heading (rad)", &noise.theta)];
    for (name, notes, horizontal, curve) in PICTURES {
        let path = folder.join(format!("{name}-{robot}.svg"));
        let stack: Vec<_> = series.iter().map(|(quantity, of)| ((*quantity).to_owned(), vec![curve(of)])).collect();
        let svg = diagrams(&[robot.to_owned()], notes, horizontal, &stack);
        let svg = svg.map_err(|problem| AnalyzeError::Drawing { path: path.clone(), problem })?;
        std::fs::write(&path, svg).map_err(|error| write(&path, error))?;
        eprintln!("{}", path.display());
    }
    Ok(())
}
