//! What the exit code of a node says.

use std::process::ExitCode;

/// Every exit code of a node. A core may ask for others, from 10 on by convention.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// It was asked to end (SIGINT, SIGTERM, its own decision) and did.
    Clean = 0,
    /// The event loop failed: the operating system refused something while running.
    System = 1,
    /// The command line or ROS_DOMAIN_ID is not understood.
    Usage = 2,
    /// Parameters, or a file they name, are wrong.
    Configuration = 3,
    /// The network, shared memory or an endpoint cannot be opened.
    Transport = 4,
    /// Another process on this host is this node already.
    Taken = 5,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
