//! The smallest node that writes: it counts on `/chatter`, and its service `~/reset` starts the count anew.
//!
//! `cargo run --example talker -- --ros-args -p rate:=10.0`, and listen with `ros2 topic echo /chatter`.

use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, Level, Local, NodeContext, NodeCore, NodeDescription, Qos, Serve, Sink,
    StartError, Steady, Times,
};
use trench_msgs::std_msgs::String as Text;
use trench_msgs::std_srvs::{Trigger, TriggerResponse};
use trench_msgs::{Message, service_info};

const TALKER: NodeDescription = NodeDescription { name: "talker", about: "Counts on /chatter.", parameters, build };

const LOCAL: &str = "network, shared_memory (and the network) or shared_memory_only";

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::double("rate", 1.0, "messages a second").range(0.1, 1.0e5),
        ParameterDescriptor::integer("count", 0, "messages to send before the node ends; 0: for ever")
            .range(0.0, 1.0e9),
        ParameterDescriptor::integer("pause_after", 0, "messages to send before the node falls silent; 0: never")
            .range(0.0, 1.0e9)
            .read_only(),
        ParameterDescriptor::bool("latched", false, "late joiners get the last message").read_only(),
        ParameterDescriptor::integer("padding", 0, "bytes to add to each message").range(0.0, 1.0e7).read_only(),
        ParameterDescriptor::string("local", "shared_memory", LOCAL).read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let padding = parameters.usize("padding")?;
    let max_len = padding + 64;
    let local = match parameters.str("local")? {
        "network" => Local::NetworkOnly,
        "shared_memory" => Local::SharedMemory { max_len },
        "shared_memory_only" => Local::SharedMemoryOnly { max_len },
        _ => return Err(parameters.error("local", "is no way to a reader", LOCAL).into()),
    };
    let advertise = Advertise {
        topic: "/chatter".to_owned(),
        type_info: Text::TYPE,
        qos: if parameters.bool("latched")? { Qos::LATCHED } else { Qos::RELIABLE },
        local,
    };
    let reset = Serve { name: "~/reset".to_owned(), service: service_info::<Trigger>() };
    Ok(Box::new(Talker {
        interface: Interface { publications: vec![advertise], services: vec![reset], ..Interface::default() },
        padding: " ".repeat(padding),
        period: 1.0 / parameters.f64("rate")?,
        limit: parameters.usize("count")?,
        pause_after: parameters.usize("pause_after")?,
        sent: 0,
        next: None,
    }))
}

struct Talker {
    interface: Interface,
    padding: String,
    period: f64,
    limit: usize,
    pause_after: usize,
    sent: usize,
    next: Option<Steady>,
}

impl Talker {
    fn say(&mut self, at: Times, sink: &mut dyn Sink) {
        self.sent += 1;
        sink.publish(0, &Text { data: format!("{}{}", self.sent, self.padding) });
        sink.log(Level::Debug, &format!("said {}", self.sent));
        let due = self.next.unwrap_or(at.steady);
        // A burst of what was missed keeps the rate; a long pause is not made up for.
        let late = at.steady.seconds_since(due);
        self.next = Some(if late > 1.0 { at.steady } else { due }.plus_seconds(self.period));
        if self.sent == self.limit {
            sink.exit(0);
        }
        if self.sent == self.pause_after {
            self.next = None;
        }
    }
}

impl NodeCore for Talker {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.next = Some(at.steady),
            Event::Wakeup => self.say(at, sink),
            Event::Request { service, id, .. } => {
                self.sent = 0;
                let response = TriggerResponse { success: true, message: "counting from 1".to_owned() };
                sink.respond(service, id, &response);
            }
            Event::Shutdown => sink.log(Level::Info, &format!("sent {} messages", self.sent)),
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.next
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.limit = parameters.usize("count")?;
        self.period = 1.0 / parameters.f64("rate")?;
        Ok(())
    }
}

fn main() -> ExitCode {
    trench_runtime::run(TALKER)
}
