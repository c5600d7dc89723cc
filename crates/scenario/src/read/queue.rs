//! `kind: queue`: the linear laws of chapter 8, and what befalls a queue.

use super::common::{apart, body, limits, point, point_or_zero, positive, some, within_run};
use crate::scenario::{Queue, Timing};
use trench_config::yaml::{Map, Node};
use trench_config::{ConfigError, did_you_mean};
use trench_formation::kinematics::PointState;
use trench_formation::laws::QueueFollowing;
use trench_formation::safety::Stopping;
use trench_formation::simulate::{BrokenLink, Integration, QueueRobotScenario, QueueScenario, Quitting, Recovery};
use trench_plan::{ChainPlaces, NoRoom};

pub(super) fn read(map: &Map<'_>, timing: &Timing) -> Result<Queue, ConfigError> {
    let (shape, segment) = trench_plan::segment(map.node("segment")?)?;
    let nodes = some(map, "robots")?;
    let robots: Vec<QueueRobotScenario> = nodes.iter().map(|node| robot(node, timing)).collect::<Result<_, _>>()?;
    if robots.iter().all(|robot| robot.joins.is_some()) {
        return Err(map.error("robots", "all join later: there is no queue", "have one be there from the beginning"));
    }
    apart(map, nodes, &robots.iter().map(|robot| robot.start).collect::<Vec<_>>())?;
    let limits = limits(map)?;
    // Who comes later may come to be ahead of the first.
    let leads = map.opt_node("recovery").is_none() && robots.iter().all(|robot| robot.joins.is_none());
    let queue = QueueScenario {
        target: point(map.node("target")?)?,
        spacing: positive(map, "spacing")?,
        law: law(&map.map("law")?)?,
        broken: broken_links(map, robots.len(), (timing, leads))?,
        recovery: map.opt_map("recovery")?.map(|map| recovery(&map)).transpose()?,
        limits,
        safety: body(map, limits)?.map(|(radius, capability)| Stopping { radius, capability }),
        segment,
        robots,
    };
    checked(map, timing, &queue)?;
    has_places(map, &queue)?;
    Ok(Queue { queue, segment: shape })
}

/// Whether all robots that the file names, those that join later too, have places before the target, or round a closed segment.
fn has_places(map: &Map<'_>, queue: &QueueScenario) -> Result<(), ConfigError> {
    let count = queue.robots.len();
    let places = ChainPlaces { robots: u32::try_from(count).unwrap_or(u32::MAX), spacing: queue.spacing };
    let before = queue.first_place() - queue.segment.domain().0;
    let Err(no_room) = places.fits(&queue.segment, before) else { return Ok(()) };
    let they_need = match no_room {
        NoRoom::Behind { chain, room } => format!("they need {chain} m before the target, there are {room} m"),
        NoRoom::Round { chain, room } => format!(
            "round the closed segment they need {chain} m, from the last place on to the first one, too, and it is {room:.3} m long"
        ),
    };
    let problem = format!("leaves no places for {count} robots: {they_need}");
    Err(map.error("spacing", problem, "lengthen the segment, or space them more closely"))
}

/// K, or the poles that it gives.
fn law(map: &Map<'_>) -> Result<QueueFollowing, ConfigError> {
    let law = match map.opt_node("poles") {
        Some(node) => match node.get::<[f64; 2]>()? {
            [first, second] if first < 0.0 && second < 0.0 => QueueFollowing::with_poles(-first, -second),
            _ => {
                return Err(map.error(
                    "poles",
                    "are not both below 0: F is not Hurwitz",
                    "write two numbers below 0, 1/s",
                ));
            }
        },
        None => QueueFollowing {
            position_gain: positive(map, "position_gain")?,
            velocity_gain: positive(map, "velocity_gain")?,
        },
    };
    map.finish()?;
    Ok(law)
}

fn robot(node: &Node, timing: &Timing) -> Result<QueueRobotScenario, ConfigError> {
    let map = node.map()?;
    let start = PointState { position: point(map.node("position")?)?, velocity: point_or_zero(&map, "velocity")? };
    let joins = map.opt_node("joins").map(|_| time(&map, "joins", timing)).transpose()?;
    let quits = map.opt_map("quits")?.map(|map| quitting(&map, timing)).transpose()?;
    if quits.is_some_and(|quits| joins.is_some_and(|joins| quits.at <= joins)) {
        return Err(map.error("quits", "is before the robot joins", "have it quit later"));
    }
    map.finish()?;
    Ok(QueueRobotScenario { start, joins, quits })
}

fn quitting(map: &Map<'_>, timing: &Timing) -> Result<Quitting, ConfigError> {
    let (at, to) = (time(map, "at", timing)?, point(map.node("to")?)?);
    let quitting = Quitting { at, to, closes_up: map.get_or("closes_up", true)? };
    map.finish()?;
    Ok(quitting)
}

/// When something happens after the beginning, s.
fn time(map: &Map<'_>, key: &str, timing: &Timing) -> Result<f64, ConfigError> {
    within_run(map, key, positive(map, key)?, timing)
}

/// Whether links can hold the queue together, and limits and bodies can be.
fn checked(map: &Map<'_>, timing: &Timing, queue: &QueueScenario) -> Result<(), ConfigError> {
    if queue.recovery.is_some_and(|recovery| recovery.range < queue.spacing) {
        let problem = "has links that reach less far than `spacing`: robots in their places are lost to one another";
        return Err(map.error("recovery", problem, "give a longer range, or space them more closely"));
    }
    match (timing.integration, queue.limits, queue.safety) {
        (Integration::RungeKutta, Some(_), _) => {
            let problem = "does not suit limits, which hold accelerations for a step";
            return Err(map.error("method", problem, "write semi_implicit_euler"));
        }
        (Integration::Exact, _, Some(_)) => {
            let problem = "does not suit the safety filter, whose room is that of semi-implicit steps";
            return Err(map.error("method", problem, "write semi_implicit_euler"));
        }
        _ => {}
    }
    let Some(Stopping { radius, .. }) = queue.safety else { return Ok(()) };
    for (index, robot) in queue.robots.iter().enumerate() {
        for (other, mate) in queue.robots[..index].iter().enumerate() {
            let distance = (mate.start.position - robot.start.position).norm();
            if distance < 2.0 * radius {
                let problem =
                    format!("have r{} and r{} start {distance} m apart: bodies overlap", other + 1, index + 1);
                return Err(map.error("robots", problem, "move one of them"));
            }
        }
    }
    Ok(())
}

/// Links that break for a time of the run, of `count` robots, of which r1 may be one that always leads.
pub(super) fn broken_links(map: &Map<'_>, count: usize, run: (&Timing, bool)) -> Result<Vec<BrokenLink>, ConfigError> {
    map.opt_list("broken_links")?.iter().map(|node| broken(node, count, run)).collect()
}

fn broken(node: &Node, count: usize, (timing, leads): (&Timing, bool)) -> Result<BrokenLink, ConfigError> {
    let map = node.map()?;
    let names: Vec<String> = (1..=count).map(|rank| format!("r{rank}")).collect();
    let name = map.str("robot")?;
    let Some(robot) = names.iter().position(|known| known == name) else {
        let remedy = did_you_mean(name, names.iter().map(String::as_str));
        return Err(map.error("robot", "is not in this scenario", remedy));
    };
    if leads && robot == 0 {
        let remedy = "name a robot behind it: a link is the one to the robot ahead";
        return Err(map.error("robot", "leads, and has no link that could break", remedy));
    }
    // One that is whole again after the run is broken to its end.
    let (from, to) = (within_run(&map, "from", map.f64("from")?, timing)?, map.f64("to")?);
    if from > timing.duration - 0.5 * timing.step {
        let remedy = format!("write seconds before it, {}", timing.duration);
        return Err(map.error("from", format!("{from} s is the end of the run: no link would break in it"), remedy));
    }
    if from >= to {
        return Err(map.error("to", "is not after `from`", "write when the link is whole again, s"));
    }
    map.finish()?;
    Ok(BrokenLink { robot, from, to })
}

fn recovery(map: &Map<'_>) -> Result<Recovery, ConfigError> {
    let recovery = Recovery { range: positive(map, "range")?, speed: positive(map, "speed")? };
    map.finish()?;
    Ok(recovery)
}
