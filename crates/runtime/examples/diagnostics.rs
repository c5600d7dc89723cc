//! Prints what nodes say of their clocks on /diagnostics, a line a report.

use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Event, Files, Interface, NodeContext, NodeCore, NodeDescription, Qos, Sink, StartError, Steady, Subscribe, Times,
};
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};

const DIAGNOSTICS: NodeDescription =
    NodeDescription { name: "diagnostics", about: "Prints reports on clocks.", parameters, build };

fn parameters() -> Vec<ParameterDescriptor> {
    Vec::new()
}

fn build(_: &NodeContext, _: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let reports = Subscribe::to::<DiagnosticArray>("/diagnostics", Qos::RELIABLE);
    Ok(Box::new(Printer { interface: Interface { subscriptions: vec![reports], ..Interface::default() } }))
}

struct Printer {
    interface: Interface,
}

impl NodeCore for Printer {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, _: Times, event: Event<'_>, _: &mut dyn Sink) {
        if let Event::Message { cdr, .. } = event
            && let Ok(reports) = DiagnosticArray::decode(cdr)
        {
            reports.status.iter().filter(|status| status.name.ends_with(": clock")).for_each(print);
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        None
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

fn print(status: &DiagnosticStatus) {
    let values: Vec<&str> = status.values.iter().map(|value| value.value.as_str()).collect();
    let known = match values[..] {
        [offset, bound] => format!(" offset {offset} known to {bound}"),
        _ => String::new(),
    };
    println!("level {} {}: {}{known}", status.level, status.name, status.message);
}

fn main() -> ExitCode {
    trench_runtime::run(DIAGNOSTICS)
}
