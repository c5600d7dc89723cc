//! The parameters of leader_assignment.

use crate::room::Room;
use crate::team::TeamLimits;
use crate::{ChainOrder, Seating, TargetLimits};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::Files;
use trench_plan::Plan;

/// What the node is told.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    /// Formations that may be asked for by name: the first is the one to begin with.
    pub(crate) library: Vec<Plan>,
    /// All robots there are, in order of name.
    pub(crate) robots: Vec<String>,
    pub(crate) seating: Seating,
    pub(crate) target: TargetLimits,
    pub(crate) team: TeamLimits,
    /// The robot that is the target; empty: /target says where it is.
    pub(crate) target_robot: String,
    pub(crate) room: Room,
}

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::string("formation_file", "", "the formation file (config/formations)").read_only(),
        P::string_list("more_formations", &[], "files of formations that ~/set_formation may choose too").read_only(),
        P::string_list("robots", &[], "names of the robots that take part").read_only(),
        P::double("keep_margin", 0.2, "fraction by which a new assignment must be shorter to replace the present one")
            .range(0.0, 10.0),
        P::string(
            "chain.order",
            "nearest",
            "who is next in a chain: nearest, to the robot ahead (6.2.1), or places, as the places follow one another",
        ),
        P::double("age.robot", 2.0, "s, for which a robot may be unseen, silent or out of reach before it has quit")
            .range(0.1, 3600.0),
        P::double("age.link", 0.5, "s, for which a follower may not hear its leader before it follows its goal")
            .range(0.1, 3600.0),
        P::double(
            "dwell.robot",
            0.75,
            "s, for which a robot that had quit must be there to join; doubles with each loss",
        )
        .range(0.1, 3600.0),
        P::double("dwell.link", 1.5, "s, for which a link must be good to count again; doubles with each loss")
            .range(0.1, 3600.0),
        P::double("age.target", 0.5, "s, silence of /target after which a formation in its frame stops")
            .range(0.001, 60.0),
        P::double("target.speed", 1.0, "m/s, no target is believed to be faster").range(0.001, 100.0),
        P::double("target.jump", 0.2, "m, between two messages, beside what its speed explains").range(0.0, 100.0),
        P::bool("target.turns", true, "formations turn with the target; false: their axes are the map's"),
        P::string("target.robot", "", "the robot that is the target; empty: whatever /target says").read_only(),
        P::double_list("field", &[], "m, x and y of the field's low corner, then of its high one; empty: anywhere")
            .read_only(),
        P::double(
            "body.radius",
            0.08,
            "m, of the robots: places that are nearer to each other than two of them are refused",
        )
        .range(0.0, 10.0)
        .read_only(),
    ]
}

impl Settings {
    /// The settings, and the formation to begin with.
    pub(crate) fn read(parameters: &Parameters, files: &dyn Files) -> Result<(Self, Plan), ConfigError> {
        let path = parameters.str("formation_file")?;
        if path.is_empty() {
            let remedy = "name a file, for example config/formations/square.yaml";
            return Err(parameters.error("formation_file", "no formation is given", remedy));
        }
        let plan = trench_plan::parse(path, &files.read("formation_file", path)?)?;
        let mut library = vec![plan.clone()];
        for path in parameters.str_list("more_formations")? {
            let plan = trench_plan::parse(path, &files.read("more_formations", path)?)?;
            if library.iter().any(|other| other.name == plan.name) {
                let problem = format!("two formations are called {}", plan.name);
                return Err(parameters.error("more_formations", problem, "give each file's formation its own name"));
            }
            library.push(plan);
        }
        let robots = robots(parameters)?;
        if robots.len() > plan.places() {
            let problem =
                format!("{} robots, but the formation {} has {} places", robots.len(), plan.name, plan.places());
            return Err(parameters.error("robots", problem, "give the queues more vertices or name fewer robots"));
        }
        let room = Room { field: field(parameters)?, body_radius: parameters.f64("body.radius")? };
        room.admit(&plan)
            .map_err(|problem| parameters.error("formation_file", problem, "take a larger field or move its places"))?;
        let settings = Self {
            library,
            robots,
            seating: seating(parameters)?,
            target: target_limits(parameters)?,
            team: team_limits(parameters)?,
            target_robot: parameters.str("target.robot")?.to_owned(),
            room,
        };
        Ok((settings, plan))
    }
}

pub(crate) fn seating(parameters: &Parameters) -> Result<Seating, ConfigError> {
    let order = match parameters.str("chain.order")? {
        "nearest" => ChainOrder::Nearest,
        "places" => ChainOrder::Places,
        other => {
            return Err(parameters.error("chain.order", format!("`{other}` is no order"), "write nearest or places"));
        }
    };
    Ok(Seating { keep_margin: parameters.f64("keep_margin")?, order })
}

pub(crate) fn target_limits(parameters: &Parameters) -> Result<TargetLimits, ConfigError> {
    Ok(TargetLimits {
        speed: parameters.f64("target.speed")?,
        jump: parameters.f64("target.jump")?,
        age: parameters.f64("age.target")?,
        turns: parameters.bool("target.turns")?,
    })
}

pub(crate) fn team_limits(parameters: &Parameters) -> Result<TeamLimits, ConfigError> {
    Ok(TeamLimits {
        robot: parameters.f64("age.robot")?,
        link: parameters.f64("age.link")?,
        robot_dwell: parameters.f64("dwell.robot")?,
        link_dwell: parameters.f64("dwell.link")?,
    })
}

fn field(parameters: &Parameters) -> Result<Option<[f64; 4]>, ConfigError> {
    if parameters.f64_list("field")?.is_empty() {
        return Ok(None);
    }
    let field @ [low_x, low_y, high_x, high_y] = parameters.f64_array("field")?;
    if high_x <= low_x || high_y <= low_y {
        return Err(parameters.error("field", "has no area", "write the low corner first: [0.0, 0.0, 2.48, 1.83]"));
    }
    Ok(Some(field))
}

/// The robots of a request, in order of name, if all are known and each is there once.
pub(crate) fn admit_robots(asked: &[String], known: &[String]) -> Result<Vec<String>, String> {
    let mut robots = asked.to_vec();
    robots.sort();
    if let Some(twice) = robots.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(format!("{} is named twice", twice[0]));
    }
    match robots.iter().find(|robot| !known.contains(robot)) {
        Some(stranger) => Err(format!("{stranger} is none of the robots: {}", known.join(", "))),
        None => Ok(robots),
    }
}

fn robots(parameters: &Parameters) -> Result<Vec<String>, ConfigError> {
    let mut robots = parameters.some_names("robots")?.to_vec();
    robots.sort();
    Ok(robots)
}
