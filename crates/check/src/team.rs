//! What is known of the robots, from a controller's parameters.

use crate::stiffness::stiffness;
use trench_config::{ConfigError, Parameters};
use trench_formation::Vector2;
use trench_plan::trench_from_parameters;

/// What a formation needs to know of the robots that take it up; lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub struct Team {
    /// How many robots take part, if that is known.
    pub robots: Option<usize>,
    /// Radius of a robot.
    pub radius: f64,
    /// Kept between bodies besides.
    pub margin: f64,
    /// m/s, a wheel's largest.
    pub wheel_speed: f64,
    /// Low and high x, low and high y of the field.
    pub field: [[f64; 2]; 2],
    /// 1/s, of the kinematic laws.
    pub approach_gain: f64,
    /// Whether the velocity of a goal point is fed forward.
    pub feeds_forward: bool,
    /// Radii of the zones, if the law has zones.
    pub zones: Option<[f64; 5]>,
    /// Stiffness of the trench's bottom (1/s^2) and damping, that towards a resting leader included (1/s), if the law has them.
    pub chain_gains: Option<(f64, f64)>,
    /// The law, by its name.
    pub law: String,
    /// m/s^2, of the points that dynamic laws steer.
    pub acceleration: f64,
    /// How followers approach their segments, under the law along directions of attraction.
    pub along: Option<Along>,
    /// Where the followers of each formation in the map begin; empty where nobody knows.
    pub starts: Vec<Start>,
}

/// Directions of attraction (6.3) of followers under law (6.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Along {
    /// In the segment's frame; none: across the segment, to the nearest point.
    pub direction: Option<Vector2<f64>>,
    /// k, 1/s.
    pub damping: f64,
    /// m/s, the fastest that a robot may be when it is given a segment.
    pub speed: f64,
}

/// A robot at rest before a run, and what it will follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Its name.
    pub robot: String,
    /// Index of its queue.
    pub queue: usize,
    /// In its chain, from 1.
    pub rank: usize,
    /// m, frame `map`.
    pub position: Vector2<f64>,
}

/// Reads a team from the parameters of one formation_controller.
///
/// # Errors
/// When one is missing that every controller declares.
pub fn team(parameters: &Parameters, robots: Option<usize>) -> Result<Team, ConfigError> {
    let [low_x, low_y, high_x, high_y] = parameters.f64_array("field")?;
    let law = parameters.str("law")?;
    let is_chained = matches!(law, "zoned" | "chain");
    let zones = if is_chained { Some(parameters.f64_array("zones.radii")?) } else { None };
    let is_dynamic = !matches!(law, "robust" | "nominal" | "direct" | "family");
    let kinematic_feed = law == "robust" && parameters.bool("feed_forward")?;
    Ok(Team {
        robots,
        radius: parameters.f64("body.radius")?,
        margin: parameters.f64("safety.margin")?,
        wheel_speed: parameters.f64("wheels.max_speed")?,
        field: [[low_x, high_x], [low_y, high_y]],
        approach_gain: parameters.f64("gains.k1")?,
        feeds_forward: kinematic_feed || is_dynamic,
        zones,
        chain_gains: if is_chained || law == "queue" { chain_gains(parameters)? } else { None },
        law: law.to_owned(),
        acceleration: parameters.f64("motion.acceleration")?,
        along: if law == "zoned" { Some(along(parameters)?) } else { None },
        starts: Vec::new(),
    })
}

fn along(parameters: &Parameters) -> Result<Along, ConfigError> {
    let direction = match *parameters.f64_list("zoned.direction")? {
        [x, y] if x != 0.0 || y != 0.0 => Some(Vector2::new(x, y)),
        _ => None,
    };
    Ok(Along { direction, damping: parameters.f64("damping")?, speed: parameters.f64("motion.speed")? })
}

/// Phi''(0) and k + c; none for trenches without a stiffness at their bottom.
fn chain_gains(parameters: &Parameters) -> Result<Option<(f64, f64)>, ConfigError> {
    if parameters.str("law")? == "queue" {
        return Ok(Some((parameters.f64("queue.position_gain")?, parameters.f64("queue.velocity_gain")?)));
    }
    let damping = parameters.f64("damping")? + parameters.f64("leader_damping")?;
    Ok(stiffness(&trench_from_parameters(parameters)?).map(|stiffness| (stiffness, damping)))
}
