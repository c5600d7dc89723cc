//! From what a command line says about parameters to those of a node.

use super::{Arguments, Names, ParameterSource};
use trench_config::params::{self, Source};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};

/// Names topics meant for this host that the process also sends over the network.
pub const PUBLISH_OVER_NETWORK: &str = "publish_over_network";

/// bit/s, that each such topic may take of the network.
pub const NETWORK_RATE: &str = "network_rate";

/// Names topics of which the process takes what comes, whatever their nodes ask for.
pub const READ_BEST_EFFORT: &str = "read_best_effort";

/// Names the node of another host whose clock is ROS time.
pub const CLOCK_REFERENCE: &str = "clock_reference";

/// Whether the node tells its time to those that go by it.
pub const SERVE_CLOCK: &str = "serve_clock";

/// The parameters that every process has besides its node's own.
#[must_use]
pub fn process_parameters() -> [ParameterDescriptor; 6] {
    let reference =
        "full name of the node, on another host, whose clock is ROS time here, as measured; empty: this host's";
    let serve = "whether nodes of other hosts may go by this node's clock: the service ~/exchange_time";
    let clock = "whether /clock is this node's time";
    let network = "topics meant for this host (images) that also go over the network, for viewers; [\"*\"] means all";
    let takes = "topics read over a slow link: what is lost on the way is not repeated, as the next message comes anyway; [\"*\"]: all of which that is so";
    let rate =
        "bit/s, that images of each topic may take of the network: they come less often rather than hold up commands";
    [
        ParameterDescriptor::bool(params::USE_SIM_TIME, false, clock).read_only(),
        ParameterDescriptor::string_list(PUBLISH_OVER_NETWORK, &[], network).read_only(),
        ParameterDescriptor::double(NETWORK_RATE, 400.0e6, rate).range(10.0e3, 10.0e9).read_only(),
        ParameterDescriptor::string_list(READ_BEST_EFFORT, &[], takes).read_only(),
        ParameterDescriptor::string(CLOCK_REFERENCE, "", reference).read_only(),
        ParameterDescriptor::bool(SERVE_CLOCK, false, serve).read_only(),
    ]
}

impl Arguments {
    /// The parameters of the node that `names` names, declared by `descriptors`; `read` gives the text of a parameter
    /// file.
    ///
    /// # Errors
    /// The first file that cannot be read, or else all that is wrong with the values.
    pub fn resolve_parameters(
        &self,
        names: &Names<'_>,
        descriptors: &[ParameterDescriptor],
        read: impl Fn(&str) -> Result<String, ConfigError>,
    ) -> Result<Parameters, Vec<ConfigError>> {
        let text = |source: &ParameterSource| match source {
            ParameterSource::File(path) => read(path),
            ParameterSource::Override { .. } => Ok(String::new()),
        };
        let texts: Vec<String> =
            self.parameters.iter().map(text).collect::<Result<_, _>>().map_err(|error| vec![error])?;
        let sources: Vec<Source<'_>> = self.parameters.iter().zip(&texts).map(as_source).collect();
        params::resolve(&sources, &names.namespace, &names.node, descriptors)
    }
}

fn as_source<'a>((source, text): (&'a ParameterSource, &'a String)) -> Source<'a> {
    match source {
        ParameterSource::File(name) => Source::File { name, text },
        ParameterSource::Override { node, name, value } => Source::Override { node: node.as_deref(), name, value },
    }
}
