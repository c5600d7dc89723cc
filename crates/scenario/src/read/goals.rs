//! `kind: goal_tracking`: chapter 5.

use super::common::{name, point, point_or_zero, positive, some, trench};
use crate::law::GoalLaw;
use crate::scenario::{GoalCase, GoalTracking};
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::avoidance::{GoalPotential, VelocityPotential};
use trench_formation::kinematics::PointState;
use trench_formation::laws;
use trench_formation::simulate::WaveGoals;
use trench_formation::trench::ConstantDamping;

pub(super) fn read(map: &Map<'_>) -> Result<GoalTracking, ConfigError> {
    let goals = goals(&map.map("goals")?)?;
    let robot = |(index, node): (usize, &Node)| robot(node, &goals, index);
    let robots = some(map, "robots")?.iter().enumerate().map(robot).collect::<Result<_, _>>()?;
    let cases: Vec<GoalCase> = some(map, "cases")?.iter().map(case).collect::<Result<_, _>>()?;
    for (index, case) in cases.iter().enumerate() {
        if cases[..index].iter().any(|other| other.name == case.name) {
            return Err(map.error("cases", format!("two cases are called {}", case.name), "rename one"));
        }
    }
    Ok(GoalTracking { goals, cases, robots })
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

fn robot(node: &Node, goals: &WaveGoals, index: usize) -> Result<PointState, ConfigError> {
    let map = node.map()?;
    let position = match map.opt_node("error") {
        Some(error) => goals.at(index, 0.0).position + point(error)?,
        None => point(map.node("position")?)?,
    };
    let state = PointState { position, velocity: point_or_zero(&map, "velocity")? };
    map.finish()?;
    Ok(state)
}

fn case(node: &Node) -> Result<GoalCase, ConfigError> {
    let map = node.map()?;
    let name = name(&map)?;
    let label = map.opt_str("label")?.unwrap_or(&name).to_owned();
    let law = map.map("law")?;
    let chosen = match law.one_of("kind", &[("trench", 0), ("conventional", 1), ("velocity_potential", 2)])? {
        0 => GoalLaw::Trench(laws::GoalTracking {
            trench: trench(&law, "trench")?,
            damping: ConstantDamping { coefficient: positive(&law, "damping")? },
        }),
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
    map.finish()?;
    Ok(GoalCase { name, label, law: chosen })
}
