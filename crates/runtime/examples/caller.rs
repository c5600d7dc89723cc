//! The smallest node that calls a service: it resets the talker's count, prints the answer and ends; with exit code 10
//! when no talker answers.

use std::process::ExitCode;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Event, Files, Interface, NodeContext, NodeCore, NodeDescription, Serve, Sink, StartError, Steady, Times,
};
use trench_msgs::std_srvs::{Trigger, TriggerRequest, TriggerResponse};
use trench_msgs::{Message, service_info};

const CALLER: NodeDescription =
    NodeDescription { name: "caller", about: "Resets the talker.", parameters: Vec::new, build };

fn build(_: &NodeContext, _: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let reset = Serve { name: "/talker/reset".to_owned(), service: service_info::<Trigger>() };
    Ok(Box::new(Caller { interface: Interface { clients: vec![reset], ..Interface::default() } }))
}

struct Caller {
    interface: Interface,
}

impl NodeCore for Caller {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, _: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => sink.call(0, &TriggerRequest::default()),
            Event::Response { cdr, .. } => match cdr.map(TriggerResponse::decode) {
                Some(Ok(response)) => {
                    println!("{}", response.message);
                    sink.exit(0);
                }
                Some(Err(_)) | None => sink.exit(10),
            },
            _ => {}
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
    trench_runtime::run(CALLER)
}
