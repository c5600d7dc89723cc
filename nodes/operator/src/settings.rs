//! The operator's parameters.

use trench_config::{ConfigError, ParameterDescriptor, Parameters};

/// What the operator wants of a run.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) duration: f64,
    pub(crate) tolerance: f64,
    pub(crate) start_timeout: f64,
    pub(crate) robots: Vec<String>,
    pub(crate) assignment_node: String,
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
    ]
}

impl Settings {
    pub(crate) fn read(parameters: &Parameters) -> Result<Self, ConfigError> {
        let robots = parameters.str_list("robots")?.to_vec();
        if robots.is_empty() {
            return Err(parameters.error("robots", "no robot takes part", "name them: robots: [robot1, robot2]"));
        }
        Ok(Self {
            duration: parameters.f64("duration")?,
            tolerance: parameters.f64("tolerance")?,
            start_timeout: parameters.f64("start_timeout")?,
            robots,
            assignment_node: parameters.str("assignment_node")?.to_owned(),
        })
    }
}
