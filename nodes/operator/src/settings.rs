//! The operator's parameters.

use crate::Route;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};

/// What the operator wants of a run.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) duration: f64,
    pub(crate) tolerance: f64,
    pub(crate) start_timeout: f64,
    pub(crate) robots: Vec<String>,
    pub(crate) assignment_node: String,
    /// The way of a target that the operator leads.
    pub(crate) route: Option<Route>,
    /// s, from t0 to the target's setting out.
    pub(crate) depart: f64,
    /// Whether robots are judged by their distance from their segments, not from their goal points.
    pub(crate) by_segment: bool,
}

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::double("duration", 60.0, "s, length of the run from t0").range(0.0, 86_400.0),
        ParameterDescriptor::double("tolerance", 0.02, "m, each robot's largest distance to its goal at the end")
            .range(0.0, 100.0),
        ParameterDescriptor::double("start_timeout", 30.0, "s, give up when the run has not started by then")
            .range(0.0, 3600.0),
        ParameterDescriptor::string_list("robots", &[], "names of the robots that take part"),
        ParameterDescriptor::string(
            "assignment_node",
            "/leader_assignment",
            "node whose arm, start and stop are called",
        ),
        ParameterDescriptor::string("judge", "goals", "by the distance from goals, or from segments (chains, 7.5)"),
        ParameterDescriptor::double_list(
            "target.waypoints",
            &[],
            "m, x and y of each point of a target's way; empty: the operator leads no target",
        ),
        ParameterDescriptor::double("target.speed", 0.06, "m/s, of the target on its way").range(0.001, 10.0),
        ParameterDescriptor::double("target.acceleration", 0.05, "m/s^2, at both ends of the way").range(0.001, 100.0),
        ParameterDescriptor::double("target.heading", 0.0, "rad, of a target that has one waypoint").range(-10.0, 10.0),
        ParameterDescriptor::double("target.depart", 10.0, "s from t0, when it sets out").range(0.0, 86_400.0),
    ]
}

impl Settings {
    pub(crate) fn read(parameters: &Parameters) -> Result<Self, ConfigError> {
        let robots = parameters.some_names("robots")?.to_vec();
        Ok(Self {
            duration: parameters.f64("duration")?,
            tolerance: parameters.f64("tolerance")?,
            start_timeout: parameters.f64("start_timeout")?,
            robots,
            assignment_node: parameters.str("assignment_node")?.to_owned(),
            route: Route::read(parameters)?,
            depart: parameters.f64("target.depart")?,
            by_segment: by_segment(parameters)?,
        })
    }
}

fn by_segment(parameters: &Parameters) -> Result<bool, ConfigError> {
    match parameters.str("judge")? {
        "goals" => Ok(false),
        "segments" => Ok(true),
        _ => Err(parameters.error("judge", "is nothing to judge by", "write goals or segments")),
    }
}
