//! `kind: regulation`: robots of chapter 4.

use super::common::{name, point, point_or_zero, some};
use crate::law::ChosenLaw;
use crate::scenario::{Regulating, RegulatingCase, Start};
use std::collections::BTreeSet;
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::Vector2;
use trench_formation::kinematics::Pose;
use trench_formation::laws::{Direct, Family, Nominal, Robust};

pub(super) fn read(map: &Map<'_>) -> Result<Regulating, ConfigError> {
    let goal = point_or_zero(map, "goal")?;
    let starts = some(map, "robots")?.iter().map(|node| start(node, goal)).collect::<Result<_, _>>()?;
    let mut names = BTreeSet::new();
    let mut cases = Vec::new();
    for node in some(map, "cases")? {
        let case = case(node)?;
        if !names.insert(case.name.clone()) {
            return Err(node.error(format!("two cases are called {}", case.name), "rename one"));
        }
        cases.push(case);
    }
    Ok(Regulating { goal, cases, starts })
}

fn case(node: &Node) -> Result<RegulatingCase, ConfigError> {
    let map = node.map()?;
    let name = name(&map)?;
    let label = map.opt_str("label")?.unwrap_or(&name).to_owned();
    let law = law(&map.map("law")?)?;
    map.finish()?;
    Ok(RegulatingCase { name, label, law })
}

fn law(map: &Map<'_>) -> Result<ChosenLaw, ConfigError> {
    let kind = map.one_of("kind", &[("direct", 0), ("nominal", 1), ("robust", 2), ("family", 3)])?;
    let (k1, k2) = (map.f64("k1")?, map.f64("k2")?);
    let power = |key| map.get_or::<u32>(key, 0);
    let law = match kind {
        0 => ChosenLaw::Direct(Direct { k1, k2 }),
        1 => ChosenLaw::Nominal(Nominal { k1, k2 }),
        2 => ChosenLaw::Robust(Robust { k1, k2, k3: map.f64("k3")? }),
        _ => ChosenLaw::Family(Family { k1, k2, n: power("n")?, p: power("p")?, q: power("q")?, s: power("s")? }),
    };
    for (key, value) in [("k1", k1), ("k2", k2)] {
        if value <= 0.0 {
            return Err(map.error(key, "is not positive", "write a gain above 0"));
        }
    }
    map.finish()?;
    Ok(law)
}

/// A position with the misalignment phi from the goal's direction, or with a heading.
fn start(node: &Node, goal: Vector2<f64>) -> Result<Start, ConfigError> {
    let map = node.map()?;
    let position = point(map.node("position")?)?;
    let towards = goal - position;
    if towards == Vector2::zeros() {
        return Err(map.error("position", "is the goal", "start elsewhere"));
    }
    let heading = match trench_plan::angle(&map, "misalignment")? {
        Some(phi) => libm::atan2(towards.y, towards.x) + phi,
        None => match trench_plan::angle(&map, "heading")? {
            Some(heading) => heading,
            None => map.f64("heading")?,
        },
    };
    map.finish()?;
    Ok(Start(Pose::new(position.x, position.y, heading)))
}
