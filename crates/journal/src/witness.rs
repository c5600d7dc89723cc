//! Writing down what a core does.

use crate::record::{Output, Payload, Record};
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Interface, Level, NodeCore, RequestId, Sink, Steady, Times};
use trench_msgs::Encode;

/// A core whose every output is also written down, as it stands in journals.
pub struct Witness {
    core: Box<dyn NodeCore>,
    next_wakeup: Option<Steady>,
}

impl Witness {
    /// Of a core that has not handled anything yet.
    #[must_use]
    pub fn new(core: Box<dyn NodeCore>) -> Self {
        Self { core, next_wakeup: None }
    }

    /// What the core is connected to.
    #[must_use]
    pub fn interface(&self) -> &Interface {
        self.core.interface()
    }

    /// When the core wants to be woken.
    #[must_use]
    pub fn next_wakeup(&self) -> Option<Steady> {
        self.core.next_wakeup()
    }

    /// Hands an event to the core; what it does goes to `sink`, if there is one, and behind `step`.
    pub fn handle(&mut self, at: Times, event: Event<'_>, sink: Option<&mut dyn Sink>, step: &mut Vec<u8>) {
        self.core.handle(at, event, &mut Tap { sink, step });
        self.note_wakeup(step);
    }

    /// Changes parameters; the outcome goes behind `step`.
    ///
    /// # Errors
    /// When the core refuses.
    pub fn set_parameters(&mut self, parameters: &Parameters, step: &mut Vec<u8>) -> Result<(), ConfigError> {
        let outcome = self.core.set_parameters(parameters);
        match &outcome {
            Ok(()) => Record::Output(Output::Accepted).append_to(step),
            Err(error) => Record::Output(Output::Refused(&error.to_string())).append_to(step),
        }
        self.note_wakeup(step);
        outcome
    }

    fn note_wakeup(&mut self, step: &mut Vec<u8>) {
        let next = self.core.next_wakeup();
        if next != self.next_wakeup {
            self.next_wakeup = next;
            Record::Output(Output::NextWakeup(next.map(|at| at.0))).append_to(step);
        }
    }
}

/// Writes down each call on its way to a sink.
struct Tap<'a, 'sink> {
    sink: Option<&'a mut (dyn Sink + 'sink)>,
    step: &'a mut Vec<u8>,
}

impl Tap<'_, '_> {
    fn note(&mut self, output: Output<'_>) {
        Record::Output(output).append_to(self.step);
    }
}

impl Sink for Tap<'_, '_> {
    fn publish_with(&mut self, port: usize, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) {
        let step = &mut *self.step;
        let mut is_noted = false;
        let mut noting = |out: &mut [u8]| {
            let length = fill(out);
            if !is_noted {
                is_noted = true;
                let payload = Payload::of(out.get(..length).unwrap_or_default(), false);
                Record::Output(Output::Publish { port, payload }).append_to(step);
            }
            length
        };
        if let Some(sink) = &mut self.sink {
            sink.publish_with(port, max_len, &mut noting);
        }
        // A transport without room does not ask for the message; the core published it all the same.
        if !is_noted {
            let mut out = vec![0; max_len];
            let length = fill(&mut out);
            let payload = Payload::of(out.get(..length).unwrap_or_default(), false);
            self.note(Output::Publish { port, payload });
        }
    }

    fn respond(&mut self, service: usize, id: RequestId, response: &dyn Encode) {
        self.note(Output::Respond { service, id: id.0, cdr: &response.to_cdr() });
        if let Some(sink) = &mut self.sink {
            sink.respond(service, id, response);
        }
    }

    fn call(&mut self, client: usize, request: &dyn Encode) {
        self.note(Output::Call { client, cdr: &request.to_cdr() });
        if let Some(sink) = &mut self.sink {
            sink.call(client, request);
        }
    }

    fn write_bytes(&mut self, stream: usize, bytes: &[u8]) {
        self.note(Output::Write { stream, bytes });
        if let Some(sink) = &mut self.sink {
            sink.write_bytes(stream, bytes);
        }
    }

    fn log(&mut self, level: Level, text: &str) {
        self.note(Output::Log { level: level as u8, text });
        if let Some(sink) = &mut self.sink {
            sink.log(level, text);
        }
    }

    fn checkpoint(&mut self, bytes: &[u8]) {
        self.note(Output::Checkpoint(bytes));
        if let Some(sink) = &mut self.sink {
            sink.checkpoint(bytes);
        }
    }

    fn exit(&mut self, code: u8) {
        self.note(Output::Exit(code));
        if let Some(sink) = &mut self.sink {
            sink.exit(code);
        }
    }
}
