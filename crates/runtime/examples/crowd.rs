//! One of many: it writes and reads the same topics as all others of its kind, and says `all` once it hears each of them on
//! each topic.
//!
//! `for i in 1 2 3; do cargo run --example crowd -- --ros-args -p peers:=3 -r __node:=c$i & done`

use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, Sink, StartError, Steady,
    Subscribe, Times,
};
use trench_msgs::std_msgs::String as Text;

const CROWD: NodeDescription = NodeDescription { name: "crowd", about: "Meets its like.", parameters, build };

/// Topics that everyone writes and reads.
const TOPICS: usize = 10;

fn parameters() -> Vec<ParameterDescriptor> {
    vec![ParameterDescriptor::integer("peers", 2, "how many there are, with this one").range(1.0, 100.0).read_only()]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let topics: Vec<String> = (0..TOPICS).map(|number| format!("/topic{number}")).collect();
    Ok(Box::new(Crowd {
        interface: Interface {
            subscriptions: topics.iter().map(|topic| Subscribe::to::<Text>(topic, Qos::RELIABLE)).collect(),
            publications: topics
                .iter()
                .map(|topic| Advertise::of::<Text>(topic, Qos::RELIABLE, Local::NetworkOnly))
                .collect(),
            ..Interface::default()
        },
        peers: parameters.usize("peers")?,
        writers: [0; TOPICS],
    }))
}

struct Crowd {
    interface: Interface,
    peers: usize,
    /// Of each topic.
    writers: [usize; TOPICS],
}

impl NodeCore for Crowd {
    fn interface(&self) -> &Interface {
        &self.interface
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
