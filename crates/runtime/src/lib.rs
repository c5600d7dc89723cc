//! What turns a node core into a process: transports, clocks, parameters, log, diagnostics, signals.
//!
//! ```text
//! fn main() -> std::process::ExitCode {
//!     trench_runtime::run(DESCRIPTION)
//! }
//! ```
//!
//! Architecture invariant: one thread runs the core and everything it calls; it waits in one place and never blocks
//! elsewhere.

mod checkpoint;
mod clock;
mod exit;
mod found;
mod help;
mod interrupted;
mod journals;
mod latency_request;
mod lease;
mod log;
mod memory;
mod node;
mod parameters;
mod priority;
mod process;
mod reference;
mod rhythm;
mod run;
mod security;
mod signals;
mod stream;
mod timer;
mod topics;
mod transport;
mod watchdog;

pub use exit::Exit;
pub use parameters::to_message as parameter_message;
pub use priority::{Turn, wait_turn};
pub use run::{run, run_alone, run_with_arguments, run_without_journal};
pub use transport::{RouterError, TransportError, forget_shared_memory, route};
