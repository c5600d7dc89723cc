//! Scenario files.

mod chain;
mod common;
mod compared;
mod figures;
mod goals;
mod queue;
mod ranks;
mod regulating;

use crate::scenario::{Scenario, Task, Timing};
use crate::{Argument, Launch};
use trench_config::ConfigError;
use trench_config::yaml::{self, Map};
use trench_formation::simulate::Integration;

/// The kinds of scenarios.
#[derive(Clone, Copy)]
enum Kind {
    Regulation,
    GoalTracking,
    Directions,
    Nearest,
    Queue,
    Launch,
}

const KINDS: [(&str, Kind); 6] = [
    ("regulation", Kind::Regulation),
    ("goal_tracking", Kind::GoalTracking),
    ("directions_of_attraction", Kind::Directions),
    ("nearest_points", Kind::Nearest),
    ("queue", Kind::Queue),
    ("launch", Kind::Launch),
];

/// Steps of one run at most: beyond, a step or duration is a slip.
const MOST_STEPS: f64 = 1e8;

/// Keys of scenarios that other files do not have.
const OF_SCENARIOS: [&str; 4] = ["duration", "step", "segment", "robots"];

/// Whether a YAML text is a scenario rather than a launch file: its root is a map with a `kind`, or with other keys of scenarios, whose kind
/// was forgotten.
#[must_use]
pub fn is_scenario(text: &str) -> bool {
    let root = yaml::parse("", text);
    root.is_ok_and(|root| root.map().is_ok_and(|map| has_keys(&map)))
}

fn has_keys(map: &Map<'_>) -> bool {
    let has = |key: &str| map.opt_node(key).is_some();
    has("kind") || (!has("launch") && !has("queues") && OF_SCENARIOS.into_iter().filter(|key| has(key)).count() > 1)
}

/// Reads a scenario file; `file` names it in errors.
///
/// # Errors
/// The first thing that is wrong, with file, line, key, value and remedy.
pub fn parse(file: &str, text: &str) -> Result<Scenario, ConfigError> {
    let root = yaml::parse(file, text)?;
    let map = root.map()?;
    if map.opt_node("kind").is_none() {
        return Err(map.error(
            "kind",
            "is missing",
            format!("write kind: and one of {}", KINDS.map(|(word, _)| word).join(", ")),
        ));
    }
    let kind = map.one_of("kind", &KINDS)?;
    let name = map.str("name")?.to_owned();
    let section = map.opt_str("section")?.unwrap_or_default().to_owned();
    let (timing, task) = match kind {
        Kind::Launch => (unused(), Task::Launch(launch(&map)?)),
        kind => {
            root.bounded()?;
            let timing = timing(&map, kind)?;
            let task = match kind {
                Kind::Regulation => Task::Regulating(regulating::read(&map)?),
                Kind::GoalTracking => Task::GoalTracking(goals::read(&map, timing.integration)?),
                Kind::Directions => chain::directed(&map, &timing)?,
                Kind::Queue => Task::Queue(Box::new(queue::read(&map, &timing)?)),
                _ => chain::nearest(&map, &timing)?,
            };
            (timing, task)
        }
    };
    // Launch files bring their own, and only a robot among walls is compared: elsewhere these keys are unknown.
    let tolerance = match &task {
        Task::Launch(_) => common::TOLERANCE,
        _ => common::tolerance(&map)?,
    };
    let compared = match &task {
        Task::Nearest(chain, _) => {
            map.opt_map("compared")?.map(|compared| compared::read(&map, &compared, chain)).transpose()?
        }
        _ => None,
    };
    let mut scenario = Scenario { name, section, tolerance, timing, task, compared, figures: Vec::new() };
    scenario.figures = figures::read(map.opt_list("figures")?, &scenario)?;
    map.finish()?;
    Ok(scenario)
}

fn timing(map: &Map<'_>, kind: Kind) -> Result<Timing, ConfigError> {
    let (duration, step) = (common::positive(map, "duration")?, common::positive(map, "step")?);
    if duration / step > MOST_STEPS || step > duration {
        return Err(map.error("step", format!("makes {} steps", duration / step), "write one that fits the duration"));
    }
    let methods = [
        ("exact", Integration::Exact),
        ("rk4", Integration::RungeKutta),
        ("semi_implicit_euler", Integration::SemiImplicitEuler),
    ];
    let integration = map.one_of("method", &methods)?;
    match (kind, integration) {
        (Kind::Nearest, Integration::RungeKutta) => {
            let problem = "does not suit forces that jump at obstacles, nor robots that remember";
            return Err(map.error("method", problem, "write semi_implicit_euler or exact"));
        }
        (Kind::Regulation, Integration::SemiImplicitEuler) => {
            return Err(map.error("method", "is for accelerations", "write exact or rk4"));
        }
        _ => {}
    }
    let every = match map.opt_node("record_every") {
        Some(_) => common::positive(map, "record_every")?,
        None => step,
    };
    if every > duration {
        let problem = format!("is longer than the duration, {duration} s: nothing but the start would be recorded");
        return Err(map.error("record_every", problem, format!("write a multiple of {step} up to {duration}")));
    }
    let steps = libm::round(every / step);
    if steps < 1.0 || libm::fabs(steps * step - every) > 1e-6 * every {
        return Err(map.error("record_every", "is no multiple of the step", format!("write a multiple of {step}")));
    }
    Ok(Timing { duration, step, integration, record_every: steps as u64 })
}

/// Launch files bring their own clock.
fn unused() -> Timing {
    Timing { duration: 0.0, step: 0.0, integration: Integration::Exact, record_every: 1 }
}

fn launch(map: &Map<'_>) -> Result<Launch, ConfigError> {
    let mut arguments = Vec::new();
    if let Some(given) = map.opt_map("arguments")? {
        for entry in given.entries() {
            let (name, value) = (entry.key.clone(), entry.node.str()?.to_owned());
            arguments.push(Argument { name, value, origin: entry.node.origin.clone() });
        }
    }
    let file = map.node("launch")?;
    Ok(Launch { file: file.str()?.to_owned(), origin: file.origin.clone(), arguments })
}
