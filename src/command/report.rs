//! `trench report`: what `trench launch` runs to tell /diagnostics of its processes. Becomes a node that reads reports, a line each,
//! from its standard input, and ends when that ends.

mod statuses;

use clap::Args;
use statuses::Statuses;
use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, ByteStream, Event, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, Sink,
    StartError, Steady, Times, resolve_name,
};
use trench_launch::Report;
use trench_msgs::diagnostic_msgs::DiagnosticArray;

/// Between two messages in which nothing is new, s.
const PERIOD: f64 = 1.0;
/// How long after its last word it ends, s: readers lose what they have not read yet when its writer goes.
const LINGER: f64 = 0.15;
/// A line that is longer than any report, in bytes.
const LONGEST: usize = 65_536;

/// Says on /diagnostics what is read on standard input. `trench launch` runs it.
#[derive(Args)]
#[command(hide = true)]
pub(crate) struct Arguments {
    /// Arguments of the node.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

/// Becomes the node; the exit code is the node's.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::Watcher);
    trench_runtime::run_with_arguments(description(), arguments.node_arguments.iter().cloned()).into()
}

fn description() -> NodeDescription {
    NodeDescription { name: "launch", about: "Tells /diagnostics what happens to processes", parameters, build }
}

fn parameters() -> Vec<ParameterDescriptor> {
    vec![ParameterDescriptor::string("file", "", "the launch file").read_only()]
}

fn build(context: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let name = resolve_name("~", &context.namespace, &context.name);
    Ok(Box::new(Teller {
        interface: Interface {
            publications: vec![Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly)],
            byte_streams: vec![ByteStream::StandardInput],
            ..Interface::default()
        },
        statuses: Statuses::new(name, parameters.str("file")?),
        unread: Vec::new(),
        next: Steady::default(),
        ends: None,
    }))
}

struct Teller {
    interface: Interface,
    statuses: Statuses,
    /// The beginning of a line.
    unread: Vec<u8>,
    next: Steady,
    /// When it ends, once the launcher is gone.
    ends: Option<Steady>,
}

impl Teller {
    /// Takes what whole lines say; gives whether they say anything.
    fn read(&mut self, at: Steady, data: &[u8]) -> bool {
        self.unread.extend_from_slice(data);
        let Some(end) = self.unread.iter().rposition(|byte| *byte == b'\n') else {
            self.unread.truncate(LONGEST);
            return false;
        };
        let rest = self.unread.split_off(end + 1);
        let lines = std::mem::replace(&mut self.unread, rest);
        let reports: Vec<Report> = String::from_utf8_lossy(&lines).lines().filter_map(Report::parse).collect();
        let is_news = !reports.is_empty();
        reports.into_iter().for_each(|report| self.statuses.take(at, report));
        is_news
    }
}

impl NodeCore for Teller {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        let is_news = match event {
            Event::Bytes { data, .. } => self.read(at.steady, data),
            Event::StreamState { open: false, .. } => {
                self.statuses.launcher_is_gone();
                self.ends = Some(at.steady.plus_seconds(LINGER));
                true
            }
            _ => false,
        };
        if self.ends.is_some_and(|ends| at.steady >= ends) {
            sink.exit(0);
        }
        if is_news || at.steady >= self.next {
            self.next = at.steady.plus_seconds(PERIOD);
            sink.publish(0, &self.statuses.message(at));
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.ends.into_iter().chain([self.next]).min()
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::{Action, Outbox};
    use trench_launch::Severity;

    fn line(label: &str, severity: Severity, lasts: bool, text: &str) -> String {
        let [label, name, text] = [label, &format!("/{label}"), text].map(str::to_owned);
        Report { name, label, severity, lasts, starts: 1, pid: Some(7), text }.line()
    }

    /// What is published at a time, in ms, if anything: level, name and text of each status.
    fn said(core: &mut Teller, ms: u64, event: Event<'_>) -> Vec<String> {
        let mut out = Outbox::default();
        core.handle(Times { steady: Steady(ms * 1_000_000), ..Times::default() }, event, &mut out);
        let messages = out.published::<DiagnosticArray>(0);
        let statuses = messages.iter().flat_map(|message| &message.status);
        statuses.map(|status| format!("{} {}: {}", status.level, status.name, status.message)).collect()
    }

    fn core() -> Teller {
        let statuses = Statuses::new("/launch".to_owned(), "a.launch.yaml");
        Teller {
            interface: Interface::default(),
            statuses,
            unread: Vec::new(),
            next: Steady(1_000_000_000),
            ends: None,
        }
    }

    #[test]
    fn reports_are_told_at_once_whole_and_again_every_second() {
        let mut core = core();
        let text = line("a", Severity::Fine, true, "runs") + &line("b", Severity::Fine, true, "runs");
        let (begin, end) = text.as_bytes().split_at(text.len() - 9);
        let first = ["0 /a: process: runs", "0 /launch: processes: all as it should be"];
        assert_eq!(said(&mut core, 10, Event::Bytes { stream: 0, data: begin }), first);
        let both = ["0 /a: process: runs", "0 /b: process: runs", "0 /launch: processes: all as it should be"];
        assert_eq!(said(&mut core, 20, Event::Bytes { stream: 0, data: end }), both);
        assert!(said(&mut core, 500, Event::Wakeup).is_empty());
        assert!(said(&mut core, 500, Event::Bytes { stream: 0, data: b"no report\n" }).is_empty());
        assert_eq!(said(&mut core, 1020, Event::Wakeup), both);
    }

    #[test]
    fn what_passes_is_told_for_a_while_and_what_lasts_for_ever() {
        let mut core = core();
        let died = line("a", Severity::Warning, false, "has died and was started again");
        let text = died + &line("b", Severity::Error, true, "given up");
        let told = [
            "1 /a: process: has died and was started again",
            "2 /b: process: given up",
            "2 /launch: processes: a, b: not as it should be",
        ];
        assert_eq!(said(&mut core, 0, Event::Bytes { stream: 0, data: text.as_bytes() }), told);
        assert_eq!(said(&mut core, 4_999, Event::Wakeup), told);
        let after = ["0 /a: process: runs", "2 /b: process: given up", "2 /launch: processes: b: not as it should be"];
        assert_eq!(said(&mut core, 6_000, Event::Wakeup), after);
        assert_eq!(said(&mut core, 600_000, Event::Wakeup), after);
    }

    #[test]
    fn what_is_no_node_has_a_name_of_its_own_for_everybody() {
        let report = Report {
            name: "view-2".to_owned(),
            ..Report::parse(line("a", Severity::Fine, true, "runs").trim_end()).unwrap()
        };
        let told = ["0 /launch/view-2: process: runs", "0 /launch: processes: all as it should be"];
        assert_eq!(said(&mut core(), 0, Event::Bytes { stream: 0, data: report.line().as_bytes() }), told);
    }

    #[test]
    fn the_death_of_the_launcher_is_its_last_word() {
        let mut core = core();
        said(&mut core, 0, Event::Bytes { stream: 0, data: line("a", Severity::Fine, true, "runs").as_bytes() });
        let told = ["0 /a: process: runs", "2 /launch: processes: the launcher was killed: its processes end"];
        assert_eq!(said(&mut core, 10, Event::StreamState { stream: 0, open: false }), told);
        assert_eq!(core.next_wakeup(), Some(Steady(160_000_000)));
        let mut out = Outbox::default();
        core.handle(Times { steady: Steady(160_000_000), ..Times::default() }, Event::Wakeup, &mut out);
        assert!(matches!(out.actions[..], [Action::Exit(0)]), "{:?}", out.actions);
    }
}
