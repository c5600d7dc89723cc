//! The trait of all node cores.

use crate::{Discovered, Event, Interface, RosTime, Sink, Steady, Subscribe, Times};
use trench_config::{ConfigError, Parameters};

/// What a core knows of the process it lives in when it is made.
#[derive(Debug, Clone, Default)]
pub struct NodeContext {
    /// The node's namespace, absolute: `/` or `/robot1`.
    pub namespace: String,
    /// The node's name.
    pub name: String,
    /// What the last life of this node left through [`Sink::checkpoint`], if anything.
    pub checkpoint: Option<Vec<u8>>,
    /// The host's seed for what must differ between runs (identifiers, epochs); fixed in simulation and replay.
    pub seed: u64,
    /// The host's wall clock when the node was made, whatever clock its times are of: for what must go up from one life to
    /// the next. Zero in simulation.
    pub wall: RosTime,
}

/// Why a core refuses to start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// Its parameters, or a file they name, are wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

/// A node without its process.
pub trait NodeCore: Send {
    /// What it is connected to. Fixed for the life of the core, but for what [`NodeCore::discovered`] adds.
    fn interface(&self) -> &Interface;

    /// Handles one event: the only way in, and `sink` the only way out.
    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink);

    /// When it wants [`Event::Wakeup`], if at all. Asked after every event; a time that has passed means at once.
    fn next_wakeup(&self) -> Option<Steady>;

    /// Somebody in the graph writes a topic that the interface does not name: the subscription that the core wants to
    /// it, if any, now the last of [`Interface::subscriptions`]. Asked once a writer. For tools that read whatever there
    /// is; a node that acts on what it reads knows its topics beforehand, and neither lock-step runs nor journals ask.
    fn discovered(&mut self, topic: Discovered<'_>) -> Option<Subscribe> {
        let _nobody_asked_for = topic;
        None
    }

    /// Takes a change of parameters while running: all of `parameters` are the values after the change. Refused as a
    /// whole with a reason for the operator, leaving the old ones in force.
    ///
    /// # Errors
    /// When a value is not admissible, with what would be right.
    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError>;
}
