//! A sink that keeps what it is given: the simulator delivers it, the bag checker and tests compare it.

use crate::{Level, RequestId, Sink};
use trench_msgs::{Encode, Message};

/// One thing a core wanted done.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// A message on `Interface::publications[port]`.
    Publish {
        /// Index into `Interface::publications`.
        port: usize,
        /// The message with its encapsulation header.
        cdr: Vec<u8>,
    },
    /// An answer to a request.
    Respond {
        /// Index into `Interface::services`.
        service: usize,
        /// The request's id.
        id: RequestId,
        /// The response.
        cdr: Vec<u8>,
    },
    /// A request to a service of `Interface::clients`.
    Call {
        /// Index into `Interface::clients`.
        client: usize,
        /// The request.
        cdr: Vec<u8>,
    },
    /// Bytes for a byte stream.
    Write {
        /// Index into `Interface::byte_streams`.
        stream: usize,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// A log line.
    Log {
        /// Its importance.
        level: Level,
        /// Its text.
        text: String,
    },
    /// State that is to outlive the process.
    Checkpoint(Vec<u8>),
    /// The end of the process.
    Exit(u8),
}

/// Keeps every call in order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outbox {
    /// What was asked, in order.
    pub actions: Vec<Action>,
}

impl Outbox {
    /// Takes out all actions, leaving the outbox empty.
    pub fn take(&mut self) -> Vec<Action> {
        std::mem::take(&mut self.actions)
    }

    /// All messages published on `port` that decode as `M`, in order.
    #[must_use]
    pub fn published<M: Message>(&self, port: usize) -> Vec<M> {
        self.actions
            .iter()
            .filter_map(|action| match action {
                Action::Publish { port: on, cdr } if *on == port => M::decode(cdr).ok(),
                _ => None,
            })
            .collect()
    }

    /// The last message published on `port`, if it decodes as `M`.
    #[must_use]
    pub fn last<M: Message>(&self, port: usize) -> Option<M> {
        self.published(port).pop()
    }

    /// All bytes written to `stream`, joined.
    #[must_use]
    pub fn written(&self, stream: usize) -> Vec<u8> {
        let mut joined = Vec::new();
        for action in &self.actions {
            if let Action::Write { stream: to, bytes } = action
                && *to == stream
            {
                joined.extend_from_slice(bytes);
            }
        }
        joined
    }
}

impl Sink for Outbox {
    fn publish_with(&mut self, port: usize, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) {
        let mut cdr = vec![0; max_len];
        let written = fill(&mut cdr);
        cdr.truncate(written);
        self.actions.push(Action::Publish { port, cdr });
    }

    fn respond(&mut self, service: usize, id: RequestId, response: &dyn Encode) {
        self.actions.push(Action::Respond { service, id, cdr: response.to_cdr() });
    }

    fn call(&mut self, client: usize, request: &dyn Encode) {
        self.actions.push(Action::Call { client, cdr: request.to_cdr() });
    }

    fn write_bytes(&mut self, stream: usize, bytes: &[u8]) {
        self.actions.push(Action::Write { stream, bytes: bytes.to_vec() });
    }

    fn log(&mut self, level: Level, text: &str) {
        self.actions.push(Action::Log { level, text: text.to_owned() });
    }

    fn checkpoint(&mut self, bytes: &[u8]) {
        self.actions.push(Action::Checkpoint(bytes.to_vec()));
    }

    fn exit(&mut self, code: u8) {
        self.actions.push(Action::Exit(code));
    }
}
