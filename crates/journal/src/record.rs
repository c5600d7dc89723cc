//! What stands in a step: one input, then the outputs it led to.

use crate::start::Parameter;
use serde::{Deserialize, Serialize};
use trench_core::{Event, RequestId, Source};
use xxhash_rust::xxh3::xxh3_128;

/// Messages of more bytes than this are large: images.
const LARGE: usize = 1 << 16;

/// One thing that a core was told or did, or the end of the journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Record<'a> {
    /// What it was told: the first record of each step.
    #[serde(borrow)]
    Input(Input<'a>),
    /// What it did.
    Output(Output<'a>),
    /// The last record of a journal.
    End(End),
}

/// The bytes of a message, or what identifies them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Payload<'a> {
    /// CDR with its encapsulation header.
    Value(#[serde(with = "serde_bytes")] &'a [u8]),
    /// A large message that was not kept.
    Reference {
        /// Its length in bytes.
        length: usize,
        /// XXH3 of its bytes.
        hash: u128,
    },
}

/// An event by value, or a change of parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are those of trench_core::Event")]
pub enum Input<'a> {
    /// [`Event::Started`]
    Started,
    /// [`Event::Message`]
    Message {
        port: usize,
        gid: [u8; 16],
        sequence: u64,
        #[serde(borrow)]
        payload: Payload<'a>,
    },
    /// [`Event::Request`]
    Request {
        service: usize,
        id: u64,
        #[serde(with = "serde_bytes")]
        cdr: &'a [u8],
    },
    /// [`Event::Response`]
    Response {
        client: usize,
        #[serde(with = "serde_bytes")]
        cdr: Option<&'a [u8]>,
    },
    /// [`Event::Bytes`]
    Bytes {
        stream: usize,
        #[serde(with = "serde_bytes")]
        data: &'a [u8],
    },
    /// [`Event::StreamState`]
    StreamState { stream: usize, open: bool },
    /// [`Event::Matched`]
    Matched { port: usize, writers: usize },
    /// [`Event::Wakeup`]
    Wakeup,
    /// [`Event::Shutdown`]
    Shutdown,
    /// `NodeCore::set_parameters` with all values after the change; its times are those of the event before it.
    SetParameters(Vec<Parameter>),
    /// [`Event::Presence`]
    Presence { port: usize, gid: [u8; 16], is_there: bool },
}

/// A call of the sink, or an answer of the core.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are those of trench_core::Action")]
pub enum Output<'a> {
    /// A message on `Interface::publications[port]`; large ones by reference.
    Publish {
        port: usize,
        #[serde(borrow)]
        payload: Payload<'a>,
    },
    /// An answer to a request.
    Respond {
        service: usize,
        id: u64,
        #[serde(with = "serde_bytes")]
        cdr: &'a [u8],
    },
    /// A request.
    Call {
        client: usize,
        #[serde(with = "serde_bytes")]
        cdr: &'a [u8],
    },
    /// Bytes for a byte stream.
    Write {
        stream: usize,
        #[serde(with = "serde_bytes")]
        bytes: &'a [u8],
    },
    /// A log line; `level` has rcl_interfaces/Log's numbers.
    Log { level: u8, text: &'a str },
    /// State that is to outlive the process.
    Checkpoint(#[serde(with = "serde_bytes")] &'a [u8]),
    /// The end of the process.
    Exit(u8),
    /// `NodeCore::next_wakeup` gives another time than after the event before.
    NextWakeup(Option<u64>),
    /// The parameters of [`Input::SetParameters`] are in force.
    Accepted,
    /// They are not, for this reason.
    Refused(&'a str),
}

/// How a journal ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum End {
    /// With the node.
    Clean,
    /// The disk was too slow for what happened, or full: what follows is missing.
    Overflow,
}

impl<'a> Payload<'a> {
    /// Of a message, by value unless it is large and `keep_large` is false.
    pub(crate) fn of(cdr: &'a [u8], keep_large: bool) -> Self {
        if keep_large || cdr.len() <= LARGE {
            Self::Value(cdr)
        } else {
            Self::Reference { length: cdr.len(), hash: xxh3_128(cdr) }
        }
    }
}

impl<'a> Input<'a> {
    /// Of an event.
    pub(crate) fn of(event: Event<'a>, keep_large: bool) -> Self {
        match event {
            Event::Started => Self::Started,
            Event::Message { port, source: Source { gid, sequence }, cdr, .. } => {
                Self::Message { port, gid, sequence, payload: Payload::of(cdr, keep_large) }
            }
            Event::Request { service, id, cdr } => Self::Request { service, id: id.0, cdr },
            Event::Response { client, cdr } => Self::Response { client, cdr },
            Event::Bytes { stream, data } => Self::Bytes { stream, data },
            Event::StreamState { stream, open } => Self::StreamState { stream, open },
            Event::Matched { port, writers } => Self::Matched { port, writers },
            Event::Presence { port, gid, is_there } => Self::Presence { port, gid, is_there },
            Event::Wakeup => Self::Wakeup,
            Event::Shutdown => Self::Shutdown,
        }
    }

    /// The event; none where its message was not kept, and for a change of parameters.
    #[must_use]
    pub fn event(&self) -> Option<Event<'a>> {
        Some(match *self {
            Self::Started => Event::Started,
            Self::Message { port, gid, sequence, payload: Payload::Value(cdr) } => {
                Event::Message { port, source: Source { gid, sequence }, cdr, arrived: None }
            }
            Self::Request { service, id, cdr } => Event::Request { service, id: RequestId(id), cdr },
            Self::Response { client, cdr } => Event::Response { client, cdr },
            Self::Bytes { stream, data } => Event::Bytes { stream, data },
            Self::StreamState { stream, open } => Event::StreamState { stream, open },
            Self::Matched { port, writers } => Event::Matched { port, writers },
            Self::Presence { port, gid, is_there } => Event::Presence { port, gid, is_there },
            Self::Wakeup => Event::Wakeup,
            Self::Shutdown => Event::Shutdown,
            Self::Message { payload: Payload::Reference { .. }, .. } | Self::SetParameters(_) => return None,
        })
    }
}

impl Record<'_> {
    /// Appends the record to a step.
    pub(crate) fn append_to(&self, step: &mut Vec<u8>) {
        // A vector takes everything, and nothing here is of unknown length: it cannot fail.
        let written = postcard::to_extend(self, std::mem::take(step));
        *step = written.unwrap_or_default();
    }
}

/// The records of a step, in order. Ends behind the first bytes that are no record: [`Records::rest`] is then not empty.
#[derive(Debug, Clone)]
pub struct Records<'a> {
    rest: &'a [u8],
}

impl<'a> Records<'a> {
    /// In these bytes.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// The bytes not read yet.
    #[must_use]
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }
}

impl<'a> Iterator for Records<'a> {
    type Item = Record<'a>;

    fn next(&mut self) -> Option<Record<'a>> {
        let (record, rest) = postcard::take_from_bytes(self.rest).ok()?;
        self.rest = rest;
        Some(record)
    }
}
