//! What a core was made from: the first thing in a journal.

use crate::value::ValueDefinition;
use serde::{Deserialize, Serialize};
use trench_config::{Origin, ParameterDescriptor, ParameterValue, Parameters};
use trench_core::arguments::{NameKind, Names};
use trench_core::{ByteStream, Interface, NodeContext, RosTime};

/// All that a core was made from, and what it was connected to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// The version of the program that ran.
    pub version: String,
    /// The kind of node: `NodeDescription::name`.
    pub description: String,
    /// As in [`NodeContext`].
    pub namespace: String,
    /// As in [`NodeContext`].
    pub name: String,
    /// As in [`NodeContext`].
    pub checkpoint: Option<Vec<u8>>,
    /// As in [`NodeContext`].
    pub seed: u64,
    /// As in [`NodeContext`], ns.
    pub wall: i64,
    /// All parameters with the values in force.
    pub parameters: Vec<Parameter>,
    /// The files that were read.
    pub files: Vec<FileText>,
    /// What the core was connected to.
    pub ports: Ports,
    /// Whether large inputs (images) stand in the journal by value.
    pub keeps_large: bool,
}

/// A parameter and where its value came from: errors name it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Dotted.
    pub name: String,
    /// The value in force.
    #[serde(with = "ValueDefinition")]
    pub value: ParameterValue,
    /// The file, or a word for another source.
    pub file: String,
    /// The line, 0 where there is none.
    pub line: usize,
}

/// A file that the core was given.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileText {
    /// As parameters name it.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// One end of a topic or a service.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Port {
    /// The absolute name, remapped.
    pub name: String,
    /// For example `trench_msgs/msg/TeamState`.
    pub type_name: String,
    /// Its RIHS01 hash.
    pub type_hash: String,
}

/// The core's interface with the names it had in the graph.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Ports {
    /// Topics read.
    pub subscriptions: Vec<Port>,
    /// Topics written.
    pub publications: Vec<Port>,
    /// Services answered.
    pub services: Vec<Port>,
    /// Services called.
    pub clients: Vec<Port>,
    /// Devices and links.
    pub byte_streams: Vec<String>,
}

impl Ports {
    /// Of an interface under these names.
    #[must_use]
    pub fn of(interface: &Interface, names: &Names<'_>) -> Self {
        let port = |name: &str, kind, type_name: &str, type_hash: &str| Port {
            name: names.resolve(name, kind),
            type_name: type_name.to_owned(),
            type_hash: type_hash.to_owned(),
        };
        let topic = |name: &str, info: &trench_msgs::TypeInfo| port(name, NameKind::Topic, info.name, info.hash);
        let service =
            |serve: &trench_core::Serve| port(&serve.name, NameKind::Service, serve.service.name, serve.service.hash);
        let subscriptions = interface.subscriptions.iter();
        let publications = interface.publications.iter();
        Self {
            subscriptions: subscriptions.map(|subscribe| topic(&subscribe.topic, subscribe.type_info)).collect(),
            publications: publications.map(|advertise| topic(&advertise.topic, advertise.type_info)).collect(),
            services: interface.services.iter().map(service).collect(),
            clients: interface.clients.iter().map(service).collect(),
            byte_streams: interface.byte_streams.iter().map(device).collect(),
        }
    }
}

fn device(stream: &ByteStream) -> String {
    match stream {
        ByteStream::Serial { path, .. } => path.clone(),
        ByteStream::PseudoTerminal { link } => link.clone(),
        ByteStream::Keyboard => "keyboard".to_owned(),
        ByteStream::StandardInput => "standard input".to_owned(),
    }
}

impl Start {
    /// The full name: `/robot1/formation_controller`.
    #[must_use]
    pub fn full_name(&self) -> String {
        trench_core::resolve_name(&self.name, &self.namespace, &self.name)
    }

    /// What the core is told of its process.
    #[must_use]
    pub fn context(&self) -> NodeContext {
        NodeContext {
            namespace: self.namespace.clone(),
            name: self.name.clone(),
            checkpoint: self.checkpoint.clone(),
            seed: self.seed,
            wall: RosTime(self.wall),
        }
    }

    /// The recorded values; parameters declared since then have their defaults.
    #[must_use]
    pub fn parameters(&self, declared: &[ParameterDescriptor]) -> Parameters {
        let mut all = Parameters::default();
        for descriptor in declared {
            all.insert(descriptor.name, descriptor.default.clone(), Origin::new("default", 0));
        }
        for Parameter { name, value, file, line } in &self.parameters {
            all.insert(name.as_str(), value.clone(), Origin::new(file.as_str(), *line));
        }
        all
    }
}

impl Start {
    /// As this program would write it: with the parameters that it declares.
    #[must_use]
    pub fn renewed(&self, declared: &[ParameterDescriptor]) -> Self {
        let parameters = kept(&self.parameters(declared));
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), parameters, ..self.clone() }
    }
}

/// Parameters as a journal keeps them.
pub(crate) fn kept(parameters: &Parameters) -> Vec<Parameter> {
    let kept = parameters.iter().map(|(name, value, origin)| Parameter {
        name: name.to_owned(),
        value: value.clone(),
        file: origin.file.as_ref().to_owned(),
        line: origin.line,
    });
    kept.collect()
}
