//! `figures:` the pictures that belong to a scenario.

use super::common::{from_the_start, within_run};
use crate::scenario::{Drawing, Figure, Scenario, Task};
use trench_config::yaml::Node;
use trench_config::{ConfigError, did_you_mean};
use trench_formation::stability::{C1, C2, TwoGainLaw};

const DRAWINGS: [(&str, Drawing); 16] = [
    ("trajectories", Drawing::Trajectories),
    ("snapshots", Drawing::Snapshots),
    ("errors", Drawing::Errors),
    ("misalignments", Drawing::Misalignments),
    ("leader_distances", Drawing::LeaderDistances),
    ("lyapunov", Drawing::Lyapunov),
    ("curvatures", Drawing::Curvatures),
    ("speeds", Drawing::Speeds),
    ("sine_integrals", Drawing::SineIntegrals),
    ("curvature_trends_of_3.9", Drawing::CurvatureTrends(TwoGainLaw::Direct)),
    ("curvature_trends_of_3.10", Drawing::CurvatureTrends(TwoGainLaw::Nominal)),
    ("solutions_above", Drawing::Solutions { critical: C1 }),
    ("solutions_below", Drawing::Solutions { critical: C2 }),
    ("stable_wedge", Drawing::StableWedge { most: 2.0 }),
    ("negative_wedge", Drawing::StableWedge { most: -2.0 }),
    ("stable_wedge_in_space", Drawing::WedgeInSpace),
];

pub(super) fn read(nodes: &[Node], scenario: &Scenario) -> Result<Vec<Figure>, ConfigError> {
    let figures: Vec<Figure> = nodes.iter().map(|node| figure(node, scenario)).collect::<Result<_, _>>()?;
    for (index, (figure, node)) in figures.iter().zip(nodes).enumerate() {
        if let Some(same) = figures[..index].iter().position(|other| other.file_name() == figure.file_name()) {
            let (map, name) = (node.map()?, figure.file_name());
            let problem = format!(
                "is the name of figures[{same}], too: both would be the file {name}, one in place of the other"
            );
            return Err(map.error(
                "figure",
                problem,
                "give each picture a name of its own, of other letters, digits or dots",
            ));
        }
    }
    Ok(figures)
}

fn figure(node: &Node, scenario: &Scenario) -> Result<Figure, ConfigError> {
    let map = node.map()?;
    let figure = Figure {
        number: map.str("figure")?.to_owned(),
        title: map.str("title")?.to_owned(),
        drawing: map.one_of("draws", &DRAWINGS)?,
        robots: map.get_or("robots", Vec::new())?,
        cases: map.get_or("cases", Vec::new())?,
        at: map.get_or("at", Vec::new())?,
        window: map.opt("window")?,
    };
    map.finish()?;
    if let Some([left, right, bottom, top]) = figure.window
        && (left >= right || bottom >= top)
    {
        return Err(map.error("window", "is empty", "write [left, right, bottom, top]"));
    }
    for at in &figure.at {
        from_the_start(&map, "at", *at)?;
    }
    if matches!(scenario.task, Task::Launch(_)) {
        let drawn = [Drawing::Trajectories, Drawing::Errors, Drawing::Snapshots, Drawing::Speeds];
        if !drawn.contains(&figure.drawing) {
            let remedy = "write trajectories, errors, snapshots or speeds";
            return Err(map.error("draws", "is no picture of a launch file's run", remedy));
        }
        return Ok(figure);
    }
    for at in &figure.at {
        within_run(&map, "at", *at, &scenario.timing)?;
    }
    let ranks: Vec<String> = scenario.seats().iter().map(|seat| format!("r{}", seat.rank)).collect();
    let cases: Vec<&str> = scenario.cases().into_iter().map(|(name, _)| name).collect();
    let known =
        |key: &str, wanted: &[String], known: Vec<&str>| match wanted.iter().find(|name| !known.contains(&&***name)) {
            Some(name) => Err(map.error(key, format!("{name} is not in this scenario"), did_you_mean(name, known))),
            None => Ok(()),
        };
    known("robots", &figure.robots, ranks.iter().map(String::as_str).collect())?;
    known("cases", &figure.cases, cases)?;
    let needs_headings = matches!(figure.drawing, Drawing::Misalignments | Drawing::Curvatures);
    if needs_headings && !all_have_headings(scenario, &figure.cases) {
        let problem = "is a picture of robots with headings, but here robots are points, which have none";
        let remedy = match scenario.task {
            Task::GoalTracking(_) => "name `cases` with a `plant`, or draw errors, speeds or trajectories",
            _ => "draw errors, speeds or trajectories",
        };
        return Err(map.error("draws", problem, remedy));
    }
    Ok(figure)
}

/// Whether the robots of these cases, of all where none are named, have headings of their own: unicycles, and robots of 3.1.1. That of a
/// point would be where it moves, and jump wherever it turns back.
fn all_have_headings(scenario: &Scenario, cases: &[String]) -> bool {
    match &scenario.task {
        Task::Regulating(_) => true,
        Task::GoalTracking(task) => {
            let mut drawn = task.cases.iter().filter(|case| cases.is_empty() || cases.contains(&case.name));
            drawn.all(|case| case.plant.is_some())
        }
        Task::Directed(_) | Task::Nearest(..) | Task::Queue(_) | Task::Launch(_) => false,
    }
}
