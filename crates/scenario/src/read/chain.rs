//! `kind: directions_of_attraction` (6.5) and `kind: nearest_points` (chapter 7).

use super::common::{
    FULL, body, edge, limits, not_negative, point, point_or_zero, points, positive, positive_or, sharpness, some,
    trench, zoning,
};
use super::queue::broken_links;
use super::ranks::ranked;
use crate::scenario::{Directed, Task, Timing};
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::Vector2;
use trench_formation::agent::Method;
use trench_formation::avoidance::WatchSettings;
use trench_formation::curve::{CurveShape, Placed};
use trench_formation::hull::{Obstacle, Outline, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{NearestAttraction, ZonedAttraction};
use trench_formation::safety::Stopping;
use trench_formation::seek::{Fragments, LeaderRule, SeekError, SeekSettings};
use trench_formation::simulate::{
    Carriage, ChainScenario, ChainSimulation, Encroaching, Options, Remedies, ScenarioError, Sight, ZonedChainScenario,
};
use trench_formation::trench::AnyTrench;
use trench_formation::zoning::{Edge, ObstaclePotential, Sharpness, Zoning};

/// What robots that remember, or are bounded, have besides: the controllers' core simulates them.
const BESIDES: [&str; 6] = ["remedies", "sidesteps", "limits", "safety", "recovery", "broken_links"];

/// Sine of the angle to a segment below which a direction is along it.
const PARALLEL: f64 = 1e-6;

/// 6.5.
pub(super) fn directed(map: &Map<'_>, timing: &Timing) -> Result<Task, ConfigError> {
    let node = map.node("segment")?;
    let (shape, curve) = trench_plan::segment(node)?;
    let CurveShape::Line(from, to) = shape else {
        return Err(node.error("is not straight", "directions of attraction are simulated towards kind: line"));
    };
    let law = law(map)?;
    let zoning = zoning(map)?;
    let nodes = some(map, "robots")?;
    let robots: Vec<PointState> = nodes.iter().map(state).collect::<Result<_, _>>()?;
    let team_goal = point(map.node("team_goal")?)?;
    let (nodes, robots) = ranked(map, nodes, robots, Some(team_goal), &Placed::new(&curve, Default::default()))?;
    let nodes = &nodes;
    let (tangent, domain) = ((to - from).normalize(), curve.domain());
    let direction = trench_plan::angle(map, "direction")?;
    let across = Vector2::new(-tangent.y, tangent.x);
    let unit = |angle: f64| Vector2::new(libm::cos(angle), libm::sin(angle));
    if direction.is_some_and(|direction| unit(direction).perp(&tangent).abs() < PARALLEL) {
        let remedy =
            format!("write one across it, for example {:.4} rad, or none at all", libm::atan2(across.y, across.x));
        return Err(map.error("direction", "is parallel to the segment, and meets it nowhere (6.3)", remedy));
    }
    let chain = ZonedChainScenario {
        origin: from,
        tangent,
        directions: vec![direction.map_or(across, unit); robots.len()],
        team_goal,
        robots,
        law: ZonedAttraction {
            trench: law.trench,
            zoning,
            damping: law.damping,
            leader_damping: law.leader_damping,
            compensates: map.get_or("compensates", true)?,
        },
    };
    for (index, (robot, node)) in chain.robots.iter().zip(nodes).enumerate() {
        for (other, mate) in chain.robots[..index].iter().enumerate() {
            let distance = (mate.position - robot.position).norm();
            if distance <= zoning.radii().rho_underbar {
                let problem = format!("starts {distance} m from r{}, within zone 1", other + 1);
                return Err(node.error(problem, "move one of them"));
            }
        }
        // A direction is proper if the segment, seen along it, reaches as far as the robot drifts (6.3).
        let point = chain.attraction(*robot, index).point;
        let drift = if index == 0 { 0.0 } else { chain.law.drift_across(chain.directions[index], *robot) };
        let along = (point - from).dot(&tangent);
        if index > 0 && !(domain.0 + drift..=domain.1 - drift).contains(&along) {
            let problem = format!("has no point of attraction on the segment: its direction meets it at {along} m");
            return Err(node.error(problem, "lengthen the segment or choose another direction (6.3)"));
        }
    }
    if BESIDES.iter().all(|key| map.opt_node(key).is_none()) {
        return Ok(Task::Directed(Box::new(Directed { chain, segment: shape, curve })));
    }
    let method = Method::Directed { direction: direction.map(unit), compensates: chain.law.compensates };
    let ZonedAttraction { trench, zoning, damping, leader_damping, .. } = chain.law;
    let law = NearestAttraction { trench, damping, leader_damping };
    let potential = without_obstacles(map, &zoning)?;
    let scenario = ChainScenario {
        segment: curve,
        carriage: Carriage::parked(),
        team_goal: Some(team_goal),
        robots: chain.robots,
        law,
        zoning,
        obstacles: Vec::new(),
        clearance: 0.0,
        potential,
        seeking: SEEKING,
        encroaching: Encroaching::Nothing,
        remedies: map.opt_map("remedies")?.map(|map| remedies(&map)).transpose()?,
        options: Options { method: Some(method), ..options(map, timing, nodes.len())? },
        step: timing.step,
        steps_per_tick: 1,
    };
    buildable(map, nodes, &scenario)?;
    Ok(Task::Nearest(Box::new(scenario), shape))
}

/// What chains may have besides, whatever draws them.
fn options(map: &Map<'_>, timing: &Timing, count: usize) -> Result<Options, ConfigError> {
    let limits = limits(map)?;
    let recovery = map.opt_map("recovery")?.map(|recovery| {
        let speed = positive(&recovery, "speed")?;
        recovery.finish()?;
        match map.opt_node("team_goal") {
            Some(_) => Ok(speed),
            None => Err(map.error("recovery", "has no team goal to go to (Remark 6.2.1)", "give team_goal")),
        }
    });
    Ok(Options {
        limits,
        safety: body(map, limits)?.map(|(radius, capability)| Stopping { radius, capability }),
        sidesteps: map.get_or("sidesteps", false)?,
        recovery: recovery.transpose()?,
        broken: broken_links(map, count, (timing, true))?,
        integration: timing.integration,
        ..Options::default()
    })
}

/// Chapter 7.
pub(super) fn nearest(map: &Map<'_>, timing: &Timing) -> Result<Task, ConfigError> {
    let (shape, curve) = trench_plan::segment(map.node("segment")?)?;
    let nodes = some(map, "robots")?;
    let robots: Vec<PointState> = nodes.iter().map(state).collect::<Result<_, _>>()?;
    let carriage = map.opt_map("segment_motion")?.map_or(Ok(Carriage::parked()), |map| carriage(&map))?;
    let team_goal = map.opt_node("team_goal").map(point).transpose()?;
    let (nodes, robots) = ranked(map, nodes, robots, team_goal, &Placed::new(&curve, carriage.at(0.0).0))?;
    let listed = listed(map.opt_list("obstacles")?)?;
    let options = options(map, timing, robots.len())?;
    let zoning = zoning(map)?;
    let scenario = ChainScenario {
        segment: curve,
        carriage,
        team_goal,
        robots,
        law: law(map)?,
        zoning,
        potential: match map.opt_node("obstacle_potential") {
            None if listed.obstacles.is_empty() => without_obstacles(map, &zoning)?,
            _ => potential(map)?,
        },
        obstacles: listed.obstacles,
        clearance: not_negative(map, "clearance", 0.0)?,
        seeking: seeking(map)?,
        encroaching: encroaching(map)?,
        remedies: map.opt_map("remedies")?.map(|map| remedies(&map)).transpose()?,
        options: Options {
            method: map.opt_map("directed")?.map(|map| along_directions(&map)).transpose()?,
            obstacle_velocities: listed.velocities,
            walls: listed.walls,
            sight: map.opt_map("sight")?.map(|map| sight(&map)).transpose()?,
            ..options
        },
        step: timing.step,
        steps_per_tick: map.get_or("steps_per_tick", 1)?,
    };
    buildable(map, &nodes, &scenario)?;
    Ok(Task::Nearest(Box::new(scenario), shape))
}

/// Whether the chain can be built, and leaves its robots a place.
fn buildable(map: &Map<'_>, robots: &[&Node], scenario: &ChainScenario<AnyTrench>) -> Result<(), ConfigError> {
    if let Err(error) = ChainSimulation::new(scenario.clone()) {
        let text = error.to_string();
        return Err(match error {
            // These say themselves what would be right.
            ScenarioError::StartInZoneOne(_, rank, _)
            | ScenarioError::BodiesOverlap(_, rank, ..)
            | ScenarioError::StartInObstacle(rank, _)
            | ScenarioError::BodyInObstacle(rank, ..)
            | ScenarioError::RobotNotFinite(rank) => {
                robots.get(rank - 1).map_or_else(|| map.error("robots", &*text, ""), |node| node.error(&*text, ""))
            }
            ScenarioError::NoRobots => map.error("robots", text, ""),
            ScenarioError::NotFinite(_) => map.as_node().error(text, ""),
            ScenarioError::Step(..) if scenario.steps_per_tick == 0 => {
                map.error("steps_per_tick", "leaves robots without a tick", "write 1 or more steps a tick")
            }
            ScenarioError::Step(..) => map.error("step", text, "write a step above 0 s"),
            ScenarioError::Integration(..) => map.error("method", text, "write semi_implicit_euler"),
            ScenarioError::SightOfWalls => map.error("sight", text, "take `apart` or the sight away"),
            ScenarioError::SightTooShort { .. } => map.error("sight", text, "see farther, or in shorter pieces"),
            ScenarioError::SightTooFine(_) => map.error("sight", text, "give a longer `piece`"),
            ScenarioError::SightOfMoving => map.error("sight", text, "take the velocities or the sight away"),
            ScenarioError::Hull(_) => map.error("obstacles", text, "mend the obstacles or the clearance"),
            ScenarioError::Seek(wrong) => seeking_error(map, &wrong),
        });
    }
    let whole = scenario.segment.domain();
    let placed = Placed::new(&scenario.segment, scenario.carriage.at(0.0).0);
    let combined = scenario
        .combined(&scenario.obstacles)
        .map_err(|error| map.error("obstacles", error.to_string(), "mend the obstacles or the clearance"))?;
    let outlines: Vec<Outline<'_>> = combined.iter().map(|obstacle| obstacle.shape.outline()).collect();
    let fragments = Fragments::find(&placed, whole, &outlines, scenario.potential.cut(), scenario.seeking.room);
    if fragments.intervals().is_empty() {
        let problem = "cover the whole segment: no qualified fragment is left for a robot (7.5.1)";
        return Err(map.error("obstacles", problem, "move obstacles away, or lengthen the segment"));
    }
    Ok(())
}

fn law(map: &Map<'_>) -> Result<NearestAttraction<AnyTrench>, ConfigError> {
    let trench = trench(map, "trench")?;
    let (damping, leader_damping) = (positive(map, "damping")?, not_negative(map, "leader_damping", 0.0)?);
    Ok(NearestAttraction { trench, damping, leader_damping })
}

fn state(node: &Node) -> Result<PointState, ConfigError> {
    let map = node.map()?;
    let state = PointState { position: point(map.node("position")?)?, velocity: point_or_zero(&map, "velocity")? };
    map.finish()?;
    Ok(state)
}

fn carriage(map: &Map<'_>) -> Result<Carriage, ConfigError> {
    let carriage = Carriage {
        origin: point_or_zero(map, "origin")?,
        heading: trench_plan::angle(map, "heading")?.unwrap_or(0.0),
        velocity: point_or_zero(map, "velocity")?,
        turn_rate: map.get_or("turn_rate", 0.0)?,
    };
    map.finish()?;
    Ok(carriage)
}

/// The obstacles of a file, by id from 1 on, with their velocities (m/s) and the walls that they are pieces of.
#[derive(Default)]
struct Listed {
    obstacles: Vec<Obstacle>,
    velocities: Vec<Vector2<f64>>,
    walls: Vec<Option<u32>>,
}

fn listed(nodes: &[Node]) -> Result<Listed, ConfigError> {
    let mut listed = Listed::default();
    for (node, wall) in nodes.iter().zip(0..) {
        let map = node.map()?;
        let velocity = point_or_zero(&map, "velocity")?;
        let apart = map.get_or("apart", false)?;
        if apart && map.opt_node("walls").is_none() {
            return Err(map.error("apart", "is for the pieces of walls", "take it away, or give walls"));
        }
        for shape in shapes(node, &map)? {
            let id = listed.obstacles.len() as u32 + 1;
            listed.obstacles.push(Obstacle { id, shape });
            listed.velocities.push(velocity);
            listed.walls.push(apart.then_some(wall));
        }
        map.finish()?;
    }
    Ok(listed)
}

/// A disc, a convex polygon, or walls: the pieces of an open chain of corners, which make concave obstacles.
fn shapes(node: &Node, map: &Map<'_>) -> Result<Vec<Shape>, ConfigError> {
    let shape = |points: &[Vector2<f64>], radius: f64| {
        Shape::new(points, radius).map_err(|error| node.error(error.to_string(), "mend the obstacle"))
    };
    let found = if let Some(centre) = map.opt_node("disc") {
        vec![shape(&[point(centre)?], positive(map, "radius")?)?]
    } else if let Some(corners) = map.opt_node("walls") {
        let (corners, radius) = (points(corners)?, not_negative(map, "radius", 0.0)?);
        if corners.len() < 2 {
            return Err(map.error("walls", "has no two corners", "give two or more"));
        }
        corners.windows(2).map(|pair| shape(pair, radius)).collect::<Result<_, _>>()?
    } else {
        vec![shape(&points(map.node("polygon")?)?, not_negative(map, "radius", 0.0)?)?]
    };
    Ok(found)
}

/// What repels robots where nothing does: by its reach, a quarter of zone 2, carrots lead them.
fn without_obstacles(map: &Map<'_>, zoning: &Zoning) -> Result<ObstaclePotential, ConfigError> {
    let (radii, full) = (zoning.radii(), zoning.full_acceleration());
    let lead = 0.25 * (radii.rho_hat - radii.rho_underbar);
    ObstaclePotential::new(0.0, lead, 1.0, Sharpness::Two, Edge::Continuous, full)
        .map_err(|error| map.error("zoning", error.to_string(), "mend the radii"))
}

/// `obstacle_potential`.
fn potential(map: &Map<'_>) -> Result<ObstaclePotential, ConfigError> {
    let map = map.map("obstacle_potential")?;
    let (pole, cut) = (not_negative(&map, "pole", 0.0)?, positive(&map, "cut")?);
    let full = positive_or(&map, "full_acceleration", FULL)?;
    let made = ObstaclePotential::new(pole, cut, positive(&map, "strength")?, sharpness(&map)?, edge(&map)?, full);
    let made = made.map_err(|error| map.error("cut", error.to_string(), "mend the gaps"))?;
    map.finish()?;
    Ok(made)
}

/// How robots seek where the file says nothing of it.
const SEEKING: SeekSettings = SeekSettings {
    room: 0.0,
    transit_margin: 1e-3,
    settled_distance: 0.05,
    settled_speed: 0.05,
    leader_rule: LeaderRule::StepSix,
};

/// What is wrong with a number of `seeking`, at its key.
fn seeking_error(map: &Map<'_>, wrong: &SeekError) -> ConfigError {
    let remedy = format!("write a number that is {}", wrong.required);
    match map.opt_map("seeking") {
        Ok(Some(seeking)) => seeking.error(wrong.name, wrong.to_string(), remedy),
        _ => map.error("seeking", wrong.to_string(), remedy),
    }
}

fn seeking(map: &Map<'_>) -> Result<SeekSettings, ConfigError> {
    let standard = SEEKING;
    let Some(map) = map.opt_map("seeking")? else { return Ok(standard) };
    let rules = [("step_six", LeaderRule::StepSix), ("whole_segment_while_far", LeaderRule::WholeSegmentWhileFar)];
    let settings = SeekSettings {
        room: map.get_or("room", standard.room)?,
        transit_margin: map.get_or("transit_margin", standard.transit_margin)?,
        settled_distance: map.get_or("settled_distance", standard.settled_distance)?,
        settled_speed: map.get_or("settled_speed", standard.settled_speed)?,
        leader_rule: if map.opt_node("leader_rule").is_some() {
            map.one_of("leader_rule", &rules)?
        } else {
            standard.leader_rule
        },
    };
    map.finish()?;
    Ok(settings)
}

fn encroaching(map: &Map<'_>) -> Result<Encroaching, ConfigError> {
    if map.opt_node("encroaching").is_none() {
        return Ok(Encroaching::Nothing);
    }
    let kinds = [
        ("nothing", 0),
        ("obstacles", 1),
        ("obstacles_and_robots", 2),
        ("obstacles_and_places", 3),
        ("obstacles_and_robots_apart", 4),
    ];
    match map.one_of("encroaching", &kinds)? {
        0 => Ok(Encroaching::Nothing),
        1 => Ok(Encroaching::Obstacles),
        3 => Ok(Encroaching::ObstaclesAndPlaces(positive(map, "body_radius")?)),
        4 => Ok(Encroaching::ObstaclesAndRobotsApart(positive(map, "body_radius")?)),
        _ => Ok(Encroaching::ObstaclesAndRobots(positive(map, "body_radius")?)),
    }
}

/// Law (6.1) instead of (7.13): in a direction of the segment's frame, or across the segment.
fn along_directions(map: &Map<'_>) -> Result<Method, ConfigError> {
    let direction = trench_plan::angle(map, "direction")?.map(|angle| Vector2::new(libm::cos(angle), libm::sin(angle)));
    let method = Method::Directed { direction, compensates: map.get_or("compensates", true)? };
    map.finish()?;
    Ok(method)
}

/// How far robots see.
fn sight(map: &Map<'_>) -> Result<Sight, ConfigError> {
    let sight = Sight { range: positive(map, "range")?, piece: positive(map, "piece")? };
    map.finish()?;
    Ok(sight)
}

fn remedies(map: &Map<'_>) -> Result<Remedies, ConfigError> {
    let watch = WatchSettings {
        radius: positive(map, "radius")?,
        patience: positive(map, "patience")?,
        arrived: positive(map, "arrived")?,
    };
    let remedies = Remedies { watch, rising: positive(map, "rising")? };
    map.finish()?;
    Ok(remedies)
}
