//! Who leads in a scenario's chain: robots stand in the file by rank, or the rule of 6.2.1 orders them.

use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::Vector2;
use trench_formation::chain::{Robot, organise};
use trench_formation::curve::Placed;
use trench_formation::kinematics::PointState;

/// Robots by rank, each with its place in the file.
///
/// # Errors
/// The rule of 6.2.1 without a team goal; robots that are nowhere.
pub(super) fn ranked<'a>(
    map: &Map<'_>,
    nodes: &'a [Node],
    robots: Vec<PointState>,
    goal: Option<Vector2<f64>>,
    segment: &Placed<'_>,
) -> Result<(Vec<&'a Node>, Vec<PointState>), ConfigError> {
    let written =
        map.opt_node("ranks").is_none() || map.one_of("ranks", &[("as_written", true), ("nearest", false)])?;
    if written {
        return Ok((nodes.iter().collect(), robots));
    }
    let Some(goal) = goal else {
        return Err(map.error("ranks", "has no team goal to begin at (6.2.1)", "give team_goal, or write as_written"));
    };
    // Of the same length, so that the alphabet, which decides the last ties, is the order of the file.
    let names: Vec<String> = (0..robots.len()).map(|index| format!("{index:09}")).collect();
    let team: Vec<Robot<'_>> =
        names.iter().zip(&robots).map(|(name, robot)| Robot { name, position: robot.position }).collect();
    let chain = organise(&team, goal, segment)
        .map_err(|error| map.error("robots", error.to_string(), "write numbers for their positions"))?;
    let places = chain.names().iter().filter_map(|name| name.parse::<usize>().ok());
    Ok(places.filter_map(|place| Some((nodes.get(place)?, *robots.get(place)?))).unzip())
}
