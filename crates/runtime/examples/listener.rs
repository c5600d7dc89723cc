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
        ParameterDescriptor::bool("wakes", true, "false: messages are read at the timer's next wake-up").read_only(),
        ParameterDescriptor::double("period", 0.0, "s, between two wake-ups by a timer; 0: none")
            .range(0.0, 10.0)
            .read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let qos = if parameters.bool("latched")? { Qos::LATCHED } else { Qos::RELIABLE };
    let subscribe = Subscribe { wakes: parameters.bool("wakes")?, ..Subscribe::to::<Text>("/chatter", qos) };
    Ok(Box::new(Listener {
        interface: Interface { subscriptions: vec![subscribe], ..Interface::default() },
        limit: parameters.usize("count")?,
        period: Some(parameters.f64("period")?).filter(|period| *period > 0.0),
        next: None,
        heard: 0,
        bad: 0,
    }))
}

struct Listener {
    interface: Interface,
    limit: usize,
    period: Option<f64>,
    next: Option<Steady>,
    heard: usize,
    bad: usize,
}

impl NodeCore for Listener {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        if matches!(event, Event::Started | Event::Wakeup) {
            self.next = self.period.map(|period| at.steady.plus_seconds(period));
        }
        match event {
            Event::Wakeup => println!("wakeup {}", self.heard),
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
        self.next
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.limit = parameters.usize("count")?;
        Ok(())
    }
}

fn main() -> ExitCode {
    trench_runtime::run(LISTENER)
}
