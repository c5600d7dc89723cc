//! `trench stop`: the emergency stop from a terminal. Becomes a node that says stop on /emergency_stop, again and again.

use clap::Args;
use std::io::IsTerminal;
use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, ByteStream, Event, Files, Interface, Level, Local, NodeContext, NodeCore, NodeDescription, Qos, Serve,
    Sink, StartError, Steady, Times,
};
use trench_msgs::Message;
use trench_msgs::std_msgs::Bool;
use trench_msgs::std_srvs::{Trigger, TriggerRequest, TriggerResponse};

/// Between two words, s.
const PERIOD: f64 = 0.05;

const KEYS: &str = "any key stops, r takes the stop back and resets the bridge, q ends this program";

/// Stops all robots at once, and keeps saying so. In a terminal any key stops, r takes the stop back and resets the bridge,
/// q ends the program; the stop stays in force until a reset.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Stops nobody before a key is pressed.
    #[arg(long)]
    wait: bool,
    /// Further arguments of the node, for example `--ros-args -r /emergency_stop:=/stop`.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

/// Becomes the node; the exit code is the node's.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    let command_line = ["--ros-args", "-p"].map(str::to_owned).into_iter();
    let wait = [format!("wait:={}", arguments.wait), format!("keyboard:={}", std::io::stdin().is_terminal())];
    let [wait, keyboard] = wait;
    let own = command_line.chain([wait, "-p".to_owned(), keyboard, "--".to_owned()]);
    trench_runtime::run_with_arguments(description(), own.chain(arguments.node_arguments.iter().cloned())).into()
}

fn description() -> NodeDescription {
    NodeDescription { name: "emergency_stop", about: "Says stop on /emergency_stop", parameters, build }
}

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::bool("wait", false, "stop nobody before a key is pressed").read_only(),
        ParameterDescriptor::bool("keyboard", false, "listen to the keyboard").read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let keyboard = parameters.bool("keyboard")?.then_some(ByteStream::Keyboard);
    let interface = Interface {
        publications: vec![Advertise::of::<Bool>("/emergency_stop", Qos::RELIABLE, Local::NetworkOnly)],
        clients: vec![Serve::of::<Trigger>("/rf_bridge/reset")],
        byte_streams: keyboard.into_iter().collect(),
        ..Interface::default()
    };
    Ok(Box::new(Stop { interface, stops: !parameters.bool("wait")?, next: Steady::default() }))
}

struct Stop {
    interface: Interface,
    stops: bool,
    next: Steady,
}

impl Stop {
    fn press(&mut self, key: u8, sink: &mut dyn Sink) {
        match key {
            b'q' => sink.exit(0),
            b'r' => {
                self.stops = false;
                self.speak(sink);
                sink.call(0, &TriggerRequest::default());
            }
            _ => {
                if !std::mem::replace(&mut self.stops, true) {
                    sink.log(Level::Warn, "stop");
                }
                self.speak(sink);
            }
        }
    }

    fn speak(&self, sink: &mut dyn Sink) {
        sink.publish(0, &Bool { data: self.stops });
    }
}

impl NodeCore for Stop {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => sink.log(Level::Info, if self.stops { "stop" } else { KEYS }),
            Event::Bytes { data, .. } => data.iter().for_each(|key| self.press(*key, sink)),
            Event::Response { cdr, .. } => {
                let answer = cdr.and_then(|cdr| TriggerResponse::decode(cdr).ok());
                let text = answer.map_or_else(|| "the bridge does not answer".to_owned(), |answer| answer.message);
                sink.log(Level::Info, &text);
            }
            _ => {}
        }
        if at.steady >= self.next {
            self.next = at.steady.plus_seconds(PERIOD);
            self.speak(sink);
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        Some(self.next)
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        // Both are fixed at the start.
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_config::params::{Source, resolve};
    use trench_core::{Action, Outbox};

    struct NoFiles;

    impl Files for NoFiles {
        fn read(&self, key: &str, _: &str) -> Result<String, ConfigError> {
            Err(Parameters::default().error(key, "no files here", "none needed"))
        }
    }

    fn at(milliseconds: u64) -> Times {
        Times { steady: Steady(milliseconds * 1_000_000), ..Times::default() }
    }

    #[test]
    fn says_stop_again_and_again_until_it_is_taken_back() {
        let sources = ["wait", "keyboard"].map(|name| Source::Override { node: None, name, value: "true" });
        let parameters = resolve(&sources, "/", "emergency_stop", &parameters()).unwrap();
        let mut core = build(&NodeContext::default(), &parameters, &NoFiles).unwrap();
        let mut out = Outbox::default();
        let mut said = |core: &mut Box<dyn NodeCore>, milliseconds, event: Event<'_>| -> Vec<bool> {
            out.take();
            core.handle(at(milliseconds), event, &mut out);
            let called = out.actions.iter().any(|action| matches!(action, Action::Call { .. }));
            assert_eq!(called, matches!(event, Event::Bytes { data: b"r", .. }));
            out.published::<Bool>(0).iter().map(|word| word.data).collect()
        };
        assert_eq!(said(&mut core, 100, Event::Started), [false], "a new publisher speaks at once");
        assert_eq!(said(&mut core, 150, Event::Wakeup), [false]);
        assert_eq!(said(&mut core, 160, Event::Bytes { stream: 0, data: b" " }), [true]);
        assert_eq!(said(&mut core, 200, Event::Wakeup), [true]);
        assert_eq!(said(&mut core, 250, Event::Wakeup), [true]);
        assert_eq!(said(&mut core, 260, Event::Bytes { stream: 0, data: b"r" }), [false]);
        assert_eq!(said(&mut core, 300, Event::Wakeup), [false]);
    }
}
