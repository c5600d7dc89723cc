//! What turns a node core into a process: transports, clocks, parameters, log, diagnostics, signals.
