//! `kind: goal_tracking`: chapter 5.

use super::common::{apart, body, damping, limits, name, point, point_or_zero, positive, some, trench};
use crate::law::GoalLaw;
use crate::scenario::{Bounds, GoalCase, GoalTracking, Plant};
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::avoidance::{GoalPotential, VelocityPotential};
use trench_formation::kinematics::{Axle, Hilare, PointState, WheelDrive};
use trench_formation::laws;
use trench_formation::simulate::{Integration, WaveGoals};
use trench_formation::trench::{AnyDamping, AnyTrench, ConstantDamping};

pub(super) fn read(map: &Map<'_>, integration: Integration) -> Result<GoalTracking, ConfigError> {
    let goals = goals(&map.map("goals")?)?;
    let nodes = some(map, "robots")?;
    let robot = |(index, node): (usize, &Node)| robot(node, &goals, index);
    let robots: Vec<(PointState, f64)> = nodes.iter().enumerate().map(robot).collect::<Result<_, _>>()?;
    let (robots, headings): (Vec<_>, Vec<_>) = robots.into_iter().unzip();
    apart(map, nodes, &robots)?;
    let cases: Vec<GoalCase> = some(map, "cases")?.iter().map(|node| case(node, &robots)).collect::<Result<_, _>>()?;
    for (index, case) in cases.iter().enumerate() {
        if cases[..index].iter().any(|other| other.name == case.name) {
            return Err(map.error("cases", format!("two cases are called {}", case.name), "rename one"));
        }
    }
    suits_bounds(map, integration, cases.iter().filter_map(|case| case.bounds.as_ref()))?;
    Ok(GoalTracking { goals, cases, robots, headings })
}

/// Whether the method is one for robots within bounds: what these leave of an acceleration is held for a step, and the safety filter's room
/// is that of semi-implicit steps.
fn suits_bounds<'a>(
    map: &Map<'_>,
    integration: Integration,
    mut bounds: impl Iterator<Item = &'a Bounds>,
) -> Result<(), ConfigError> {
    let Some(first) = bounds.next() else { return Ok(()) };
    let bodies = first.radius.is_some() || bounds.any(|bounds| bounds.radius.is_some());
    match (integration, bodies) {
        (Integration::RungeKutta, _) => {
            let problem = "does not go with `limits` and `safety`, which hold an acceleration for a step";
            let remedy = if bodies { "write semi_implicit_euler" } else { "write semi_implicit_euler or exact" };
            Err(map.error("method", problem, remedy))
        }
        (Integration::Exact, true) => {
            let problem = "does not go with `safety`, whose room is that of semi-implicit steps";
            Err(map.error("method", problem, "write semi_implicit_euler"))
        }
        _ => Ok(()),
    }
}

fn goals(map: &Map<'_>) -> Result<WaveGoals, ConfigError> {
    let goals = WaveGoals {
        first: map.f64("first")?,
        spacing: map.f64("spacing")?,
        speed: map.f64("speed")?,
        amplitude: map.get_or("amplitude", 0.0)?,
        wave_number: map.get_or("wave_number", 0.0)?,
        phase: map.get_or("phase", 0.0)?,
    };
    map.finish()?;
    Ok(goals)
}

/// Where a robot begins, and its heading.
fn robot(node: &Node, goals: &WaveGoals, index: usize) -> Result<(PointState, f64), ConfigError> {
    let map = node.map()?;
    let position = match map.opt_node("error") {
        Some(error) => goals.at(index, 0.0).position + point(error)?,
        None => point(map.node("position")?)?,
    };
    let state = PointState { position, velocity: point_or_zero(&map, "velocity")? };
    let heading = trench_plan::angle(&map, "heading")?.unwrap_or(0.0);
    map.finish()?;
    Ok((state, heading))
}

/// What the law acts on: double integrators, or a body, perhaps by the torques of its wheels.
fn plant(map: &Map<'_>) -> Result<Option<Plant>, ConfigError> {
    let Some(map) = map.opt_map("plant")? else { return Ok(None) };
    // Whether it has motors, and whether these take speeds.
    let kinds = [
        ("double_integrator", None),
        ("hilare", Some((false, false))),
        ("wheels", Some((true, false))),
        ("wheel_speeds", Some((true, true))),
    ];
    let plant = match map.one_of("kind", &kinds)? {
        None => None,
        Some((has_motors, commanded)) => Some(Plant {
            commanded,
            body: Hilare {
                mass: positive(&map, "mass")?,
                inertia: positive(&map, "inertia")?,
                mass_offset: map.get_or("mass_offset", 0.0)?,
                hand_offset: hand_offset(&map)?,
            },
            drive: if has_motors { Some(drive(&map)?) } else { None },
        }),
    };
    map.finish()?;
    Ok(plant)
}

/// Wheels and their motors.
fn drive(map: &Map<'_>) -> Result<WheelDrive, ConfigError> {
    Ok(WheelDrive {
        axle: Axle { half_track: positive(map, "half_track")? },
        radius: positive(map, "wheel_radius")?,
        most: positive(map, "wheel_torque")?,
    })
}

/// L, in front of the axle or behind it.
fn hand_offset(map: &Map<'_>) -> Result<f64, ConfigError> {
    let offset = map.f64("hand_offset")?;
    if offset != 0.0 {
        return Ok(offset);
    }
    Err(map.error("hand_offset", "is 0: T1 has no inverse there (3.1.1)", "steer a point in front of the axle"))
}

fn case(node: &Node, robots: &[PointState]) -> Result<GoalCase, ConfigError> {
    let map = node.map()?;
    let name = name(&map)?;
    let label = map.opt_str("label")?.unwrap_or(&name).to_owned();
    let law = map.map("law")?;
    let kinds = [("trench", 0), ("conventional", 1), ("velocity_potential", 2), ("within_limits", 3)];
    let chosen = match law.one_of("kind", &kinds)? {
        3 => GoalLaw::Trench(within_limits(&map)?),
        0 => {
            let trench = trench(&law, "trench")?;
            GoalLaw::Trench(laws::GoalTracking { damping: damping_with(&law, &trench)?, trench })
        }
        1 => GoalLaw::Conventional(GoalPotential {
            strength: positive(&law, "strength")?,
            damping: positive(&law, "damping")?,
        }),
        _ => GoalLaw::Velocity(VelocityPotential {
            position: positive(&law, "position")?,
            velocity: positive(&law, "velocity")?,
        }),
    };
    law.finish()?;
    let plant = plant(&map)?;
    let bounds = bounds(&map, robots)?;
    if bounds.is_some() && (plant.is_some() || !matches!(chosen, GoalLaw::Trench(_))) {
        let problem = "hold double integrators under the law trench within bounds, nothing else";
        return Err(map.error("limits", problem, "leave them out, or choose this law and no plant"));
    }
    map.finish()?;
    Ok(GoalCase { name, label, law: chosen, plant, bounds })
}

/// (5.1) with the trench and the damping that follow from what robots can do, so that nothing of it is ever cut (chapter 5 of docs/theory).
fn within_limits(case: &Map<'_>) -> Result<laws::GoalTracking<AnyTrench, AnyDamping>, ConfigError> {
    let Some(limits) = limits(case)? else {
        return Err(case.error("limits", "is missing: the law follows from it", "give speed and acceleration"));
    };
    let laws::GoalTracking { trench, damping } = laws::GoalTracking::within(limits);
    Ok(laws::GoalTracking { trench: AnyTrench::Hyperbolic(trench), damping: AnyDamping::Constant(damping) })
}

/// What the robots can do, and their bodies, which must not begin in each other.
fn bounds(map: &Map<'_>, robots: &[PointState]) -> Result<Option<Bounds>, ConfigError> {
    let limits = limits(map)?;
    let radius = body(map, limits)?.map(|(radius, _)| radius);
    let pairs = robots
        .iter()
        .enumerate()
        .flat_map(|(index, robot)| robots[..index].iter().map(move |other| (index, robot, other)));
    for (index, robot, other) in pairs {
        let distance = (robot.position - other.position).norm();
        if radius.is_some_and(|radius| distance < 2.0 * radius) {
            let problem =
                format!("is so large that r{} begins in another body, {distance} m from its middle", index + 1);
            return Err(map.error("safety", problem, "make bodies smaller, or move robots apart"));
        }
    }
    Ok(limits.map(|limits| Bounds { limits, radius }))
}

/// k, a number or a function of the distance; that which the trench is made of where it is critically damped and the law names none.
fn damping_with(law: &Map<'_>, trench: &AnyTrench) -> Result<AnyDamping, ConfigError> {
    match (law.opt_node("damping"), trench) {
        (None, AnyTrench::Critical(trench)) => Ok(trench.0.clone()),
        (Some(node), _) if node.map().is_ok() => damping(law, "damping"),
        _ => Ok(AnyDamping::Constant(ConstantDamping { coefficient: positive(law, "damping")? })),
    }
}
