//! A core that keeps a journal of itself.

use crate::journal::Journal;
use crate::record::{Input, Record};
use crate::start::kept;
use crate::witness::Witness;
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Interface, Level, NodeCore, Sink, Steady, Times};

/// A core with its journal: to whoever drives it, the core itself.
pub struct Journalled {
    witness: Witness,
    journal: Journal,
    /// The step under way. Not empty between events only where the core panicked: it is then the journal's last.
    step: Vec<u8>,
    last: Times,
    /// Why the journal ended, until the log was told.
    problem: Option<String>,
}

impl Journalled {
    /// Of a core that has not handled anything yet.
    #[must_use]
    pub fn new(core: Box<dyn NodeCore>, journal: Journal) -> Self {
        let witness = Witness::new(core);
        Self { witness, journal, step: Vec::new(), last: Times::default(), problem: None }
    }

    fn begin(&mut self, input: Input<'_>) {
        self.step.clear();
        Record::Input(input).append_to(&mut self.step);
    }

    fn commit(&mut self) {
        let step = std::mem::take(&mut self.step);
        if let Err(problem) = self.journal.append(self.last, step) {
            self.problem = Some(problem);
        }
    }
}

impl NodeCore for Journalled {
    fn interface(&self) -> &Interface {
        self.witness.interface()
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        self.last = at;
        self.begin(Input::of(event, self.journal.keeps_large()));
        self.witness.handle(at, event, Some(sink), &mut self.step);
        self.commit();
        if let Some(problem) = self.problem.take() {
            sink.log(Level::Error, &format!("the journal ends here: {problem}"));
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.witness.next_wakeup()
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.begin(Input::SetParameters(kept(parameters)));
        let outcome = self.witness.set_parameters(parameters, &mut self.step);
        self.commit();
        outcome
    }
}

impl Drop for Journalled {
    fn drop(&mut self) {
        if !self.step.is_empty() {
            self.commit();
        }
    }
}
