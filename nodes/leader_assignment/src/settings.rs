//! The parameters of leader_assignment.

use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::Files;
use trench_plan::{Frame, Plan};

/// What does not change while the node runs.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) plan: Plan,
    pub(crate) robots: Vec<String>,
    pub(crate) keep_margin: f64,
    pub(crate) target_age_limit: f64,
}

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::string("formation_file", "", "the formation file (config/formations)").read_only(),
        P::string_list("robots", &[], "names of the robots that take part").read_only(),
        P::double("keep_margin", 0.2, "fraction by which a new assignment must be shorter to replace the present one")
            .range(0.0, 10.0),
        P::double("age.target", 0.5, "s, silence of /target after which a formation in its frame stops")
            .range(0.001, 60.0),
    ]
}

impl Settings {
    pub(crate) fn read(parameters: &Parameters, files: &dyn Files) -> Result<Self, ConfigError> {
        let path = parameters.str("formation_file")?;
        if path.is_empty() {
            let remedy = "name a file, for example config/formations/square.yaml";
            return Err(parameters.error("formation_file", "no formation is given", remedy));
        }
        let plan = trench_plan::parse(path, &files.read("formation_file", path)?)?;
        let robots = robots(parameters)?;
        if robots.len() > plan.places() {
            let problem =
                format!("{} robots, but the formation {} has {} places", robots.len(), plan.name, plan.places());
            return Err(parameters.error("robots", problem, "give the queues more vertices or name fewer robots"));
        }
        let target_age_limit = match plan.frame {
            Frame::Map => f64::INFINITY,
            Frame::Target => parameters.f64("age.target")?,
        };
        Ok(Self { plan, robots, keep_margin: parameters.f64("keep_margin")?, target_age_limit })
    }
}

fn robots(parameters: &Parameters) -> Result<Vec<String>, ConfigError> {
    let mut robots = parameters.str_list("robots")?.to_vec();
    if robots.is_empty() {
        return Err(parameters.error("robots", "no robot takes part", "name them: robots: [robot1, robot2]"));
    }
    robots.sort();
    if let Some(twice) = robots.windows(2).find(|pair| pair[0] == pair[1]) {
        let problem = format!("two robots have the name {}", twice[0]);
        return Err(parameters.error("robots", problem, "give each robot a name of its own"));
    }
    Ok(robots)
}
