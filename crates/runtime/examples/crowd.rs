//! One of many: it writes and reads the same topics as all others of its kind, and says `all` once it hears each of them on
//! each topic. With `discovers` it opens a subscription when it learns that somebody writes the topic, as a recorder does.
//!
//! `for i in 1 2 3; do cargo run --example crowd -- --ros-args -p peers:=3 -r __node:=c$i & done`

use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Discovered, Event, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, Sink,
    StartError, Steady, Subscribe, Times,
};
use trench_msgs::std_msgs::String as Text;

const CROWD: NodeDescription = NodeDescription { name: "crowd", about: "Meets its like.", parameters, build };

/// Topics that everyone writes and reads.
const TOPICS: usize = 10;

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::integer("peers", 2, "how many there are, with this one").range(1.0, 100.0).read_only(),
        ParameterDescriptor::bool("discovers", false, "read each topic once somebody writes it").read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let topics: Vec<String> = (0..TOPICS).map(|number| format!("/topic{number}")).collect();
    let found = if parameters.bool("discovers")? { Vec::new() } else { topics.clone() };
    Ok(Box::new(Crowd {
        interface: Interface {
            subscriptions: found.iter().map(|topic| Subscribe::to::<Text>(topic, Qos::RELIABLE)).collect(),
            publications: topics
                .iter()
                .map(|topic| Advertise::of::<Text>(topic, Qos::RELIABLE, Local::NetworkOnly))
                .collect(),
            ..Interface::default()
        },
        peers: parameters.usize("peers")?,
        found,
        writers: [0; TOPICS],
    }))
}

struct Crowd {
    interface: Interface,
    peers: usize,
    /// What is read.
    found: Vec<String>,
    /// Of each of these.
    writers: [usize; TOPICS],
}

impl NodeCore for Crowd {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn discovered(&mut self, topic: Discovered<'_>) -> Option<Subscribe> {
        if !topic.topic.starts_with("/topic") || self.found.iter().any(|found| found == topic.topic) {
            return None;
        }
        self.found.push(topic.topic.to_owned());
        Some(Subscribe::to::<Text>(topic.topic, Qos::RELIABLE))
    }

    fn handle(&mut self, _: Times, event: Event<'_>, _: &mut dyn Sink) {
        if let Event::Matched { port, writers } = event
            && let Some(count) = self.writers.get_mut(port)
        {
            *count = writers;
            if self.writers.iter().all(|count| *count == self.peers) {
                println!("all");
            }
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        None
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

fn main() -> ExitCode {
    trench_runtime::run(CROWD)
}
