//! What a core is told.

use crate::Steady;

/// Who sent a message, and which of its messages it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Source {
    /// The writer's network GID, also where the message came through shared memory.
    pub gid: [u8; 16],
    /// The writer's count of this message, from 1.
    pub sequence: u64,
}

/// Names one pending service request within a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RequestId(pub u64);

/// One input of a core. Closed: whatever reaches a core is one of these, and a journal that holds them all replays it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event<'a> {
    /// Once, before everything else, when all ports are open.
    Started,
    /// A message on `Interface::subscriptions[port]`: CDR with its encapsulation header, read in place.
    Message {
        /// Index into `Interface::subscriptions`.
        port: usize,
        /// Writer and count.
        source: Source,
        /// The bytes.
        cdr: &'a [u8],
        /// When a process of this host wrote it, or the network brought it here, if that is known. Journals do not keep
        /// it: it is for those who watch, whose outputs nobody replays.
        arrived: Option<Steady>,
    },
    /// A request to `Interface::services[service]`, to be answered through `Sink::respond` with the same id.
    Request {
        /// Index into `Interface::services`.
        service: usize,
        /// Goes back with the response.
        id: RequestId,
        /// The request message.
        cdr: &'a [u8],
    },
    /// The answer to a request made by `Sink::call`.
    Response {
        /// Index into `Interface::clients`.
        client: usize,
        /// The response message, or nothing when no server answered within the process's time limit (5 s).
        cdr: Option<&'a [u8]>,
    },
    /// Bytes read from `Interface::byte_streams[stream]`, however the line cut them.
    Bytes {
        /// Index into `Interface::byte_streams`.
        stream: usize,
        /// The bytes.
        data: &'a [u8],
    },
    /// A byte stream opened (`true`) or broke (`false`).
    StreamState {
        /// Index into `Interface::byte_streams`.
        stream: usize,
        /// Whether bytes can be exchanged.
        open: bool,
    },
    /// The number of matched writers of a subscription changed.
    Matched {
        /// Index into `Interface::subscriptions`.
        port: usize,
        /// How many writers there are now.
        writers: usize,
    },
    /// A writer of a subscription was matched, or it has gone: it ended, or the network lost it, and may find it again.
    /// [`Event::Matched`] follows. In lock-step runs nobody comes or goes.
    Presence {
        /// Index into `Interface::subscriptions`.
        port: usize,
        /// The `gid` of its [`Source`].
        gid: [u8; 16],
        /// Whether it came.
        is_there: bool,
    },
    /// The time asked for by `NodeCore::next_wakeup` has come.
    Wakeup,
    /// The process is about to end: last words (zero commands, for example).
    Shutdown,
}
