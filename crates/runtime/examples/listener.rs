//! The smallest node that reads: it prints what `/chatter` says, one line a message.
//!
//! `cargo run --example listener`, with the talker of this folder or `ros2 topic pub /chatter std_msgs/String`.

use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Event, Files, Interface, Level, NodeContext, NodeCore, NodeDescription, Qos, Sink, StartError, Steady, Subscribe,
    Times,
};
use trench_msgs::Message;
use trench_msgs::std_msgs::String as Text;

const LISTENER: NodeDescription =
    NodeDescription { name: "listener", about: "Prints what /chatter says.", parameters, build };

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::integer("count", 0, "messages to read before the node ends; 0: for ever")
            .range(0.0, 1.0e9),
        ParameterDescriptor::bool("latched", false, "ask for what was said before").read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let subscribe = Subscribe {
        topic: "/chatter".to_owned(),
        type_info: Text::TYPE,
        qos: if parameters.bool("latched")? { Qos::LATCHED } else { Qos::RELIABLE },
    };
    Ok(Box::new(Listener {
        interface: Interface { subscriptions: vec![subscribe], ..Interface::default() },
        limit: parameters.usize("count")?,
        heard: 0,
        bad: 0,
    }))
}

struct Listener {
    interface: Interface,
    limit: usize,
    heard: usize,
    bad: usize,
}

impl NodeCore for Listener {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, _: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Message { source, cdr, .. } => match Text::decode(cdr) {
                Ok(text) => {
                    self.heard += 1;
                    println!("{} {}", source.sequence, text.data.trim_end());
                }
                Err(error) => {
                    self.bad += 1;
                    sink.log(Level::Warn, &format!("message {} dropped: {error}", source.sequence));
                }
            },
            Event::Matched { writers, .. } => sink.log(Level::Info, &format!("{writers} writer(s)")),
            Event::Shutdown => sink.log(Level::Info, &format!("heard {}, {} unreadable", self.heard, self.bad)),
            _ => {}
        }
        if self.limit > 0 && self.heard >= self.limit {
            sink.exit(0);
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        None
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.limit = parameters.usize("count")?;
        Ok(())
    }
}

fn main() -> ExitCode {
    trench_runtime::run(LISTENER)
}
