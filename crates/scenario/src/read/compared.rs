//! `compared` of `kind: nearest_points`: the methods that 7.8 compares apparent obstacles with.

use super::common::{name, points, positive, some};
use crate::scenario::{Compared, ComparedCase};
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::Vector2;
use trench_formation::avoidance::ComparedRepulsion;
use trench_formation::compared::{AnyGuide, Course, InstantGoals, VirtualObstacles};
use trench_formation::curve::Placed;
use trench_formation::simulate::{ChainScenario, Integration};
use trench_formation::trench::AnyTrench;

/// Exponents are small numbers.
const MOST_EXPONENT: i64 = 9;

/// Each method takes the robot from the same start, among the same walls, to the point that is nearest there.
pub(super) fn read(root: &Map<'_>, map: &Map<'_>, chain: &ChainScenario<AnyTrench>) -> Result<Compared, ConfigError> {
    let ([robot], Some(remedies)) = (&chain.robots[..], chain.remedies) else {
        return Err(root.error("compared", "is for one robot with remedies", "give one robot, and remedies"));
    };
    if chain.options.integration != Integration::SemiImplicitEuler {
        let problem = "is not the method by which the others are driven";
        return Err(root.error("method", problem, "write semi_implicit_euler"));
    }
    if !chain.carriage.is_parked() {
        let problem = "moves, and the methods go to a point that rests";
        return Err(root.error("segment_motion", problem, "take velocity and turn_rate away, or compared"));
    }
    let segment = Placed::new(&chain.segment, chain.carriage.at(0.0).0);
    let course = Course {
        goal: segment.nearest(robot.position).point,
        obstacles: root.opt_list("obstacles")?.iter().map(walls).collect::<Result<_, _>>()?,
        repulsion: ComparedRepulsion { strength: 1.0, reach: chain.potential.cut(), goal_exponent: 0 },
        pull: positive(map, "pull")?,
        damping: chain.law.damping,
        watch: remedies.watch,
    };
    let cases = some(map, "methods")?.iter().map(|node| case(node, &course)).collect::<Result<Vec<_>, _>>()?;
    let label = map.str("label")?.to_owned();
    map.finish()?;
    for (index, case) in cases.iter().enumerate() {
        if case.name == "apparent" || cases[..index].iter().any(|other| other.name == case.name) {
            return Err(map.error("methods", format!("two cases are called {}", case.name), "rename one"));
        }
    }
    Ok(Compared { label, cases })
}

/// n of the repulsion, 0 where nothing is said.
fn exponent(map: &Map<'_>) -> Result<i32, ConfigError> {
    match map.get_or("goal_exponent", 0_i64)? {
        exponent @ 0..=MOST_EXPONENT => Ok(exponent as i32),
        _ => Err(map.error("goal_exponent", "is no exponent of Ge and Cui's repulsion", "write 0, 1, 2 ... up to 9")),
    }
}

/// The corners of an obstacle's walls.
fn walls(node: &Node) -> Result<Vec<Vector2<f64>>, ConfigError> {
    let map = node.map()?;
    if map.opt_node("velocity").is_some() {
        return Err(map.error("velocity", "is of walls among which methods are compared", "take it away: they rest"));
    }
    match map.opt_node("walls") {
        Some(corners) => points(corners),
        None => Err(node.error("has no walls", "methods are compared among walls that rest")),
    }
}

fn case(node: &Node, course: &Course) -> Result<ComparedCase, ConfigError> {
    let map = node.map()?;
    let name = name(&map)?;
    let label = map.opt_str("label")?.unwrap_or(&name).to_owned();
    let guide = match map.one_of("method", &[("potential", 0), ("virtual_obstacles", 1), ("instant_goals", 2)])? {
        0 => AnyGuide::Unguided,
        1 => AnyGuide::Virtual(VirtualObstacles::new(positive(&map, "clearance")?)),
        _ => AnyGuide::Instant(InstantGoals::new(positive(&map, "sight")?, positive(&map, "clearance")?)),
    };
    let repulsion =
        ComparedRepulsion { strength: positive(&map, "strength")?, goal_exponent: exponent(&map)?, ..course.repulsion };
    map.finish()?;
    Ok(ComparedCase { name, label, course: Course { repulsion, ..course.clone() }, guide })
}
