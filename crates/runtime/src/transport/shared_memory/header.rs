//! What stands beside each message in shared memory.

use iceoryx2::prelude::ZeroCopySend;

/// Says whose message it is, so that the reader can drop its copy from the network.
#[derive(Debug, Clone, Copy, Default, ZeroCopySend)]
#[repr(C)]
pub(super) struct Header {
    /// The writer's identity on the network.
    pub(super) gid: [u8; 16],
    /// The writer's count of this message, the same as on the network.
    pub(super) sequence: u64,
    /// The bytes in use: a loan can be longer than its message.
    pub(super) length: u64,
    /// When it was written, by the clock that all processes of a host share, ns.
    pub(super) written: u64,
}
