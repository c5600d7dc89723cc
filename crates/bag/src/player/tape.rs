//! The messages that are played, one ahead.

use crate::{BagError, BagMessage, BagReader, Messages};
use std::sync::Arc;
use trench_core::Durability;

/// The part of a bag that is played, and the next message of it, read ahead: when it is due nothing is left to do but
/// to send it.
pub(super) struct Tape {
    bag: Arc<BagReader>,
    /// The publication of each topic; nothing for those that are not played.
    ports: Vec<Option<usize>>,
    /// First and last log time that are played, ns.
    span: (u64, u64),
    messages: Messages<Arc<BagReader>>,
    next: Option<BagMessage>,
    /// Why the tape broke.
    problem: Option<BagError>,
}

impl Tape {
    /// At the beginning of `span`.
    pub(super) fn new(bag: Arc<BagReader>, ports: Vec<Option<usize>>, span: (u64, u64)) -> Self {
        let messages = bag.messages_from(span.0);
        let mut tape = Self { bag, ports, span, messages, next: None, problem: None };
        tape.advance();
        tape
    }

    /// First and last log time that are played, ns.
    pub(super) fn span(&self) -> (u64, u64) {
        self.span
    }

    /// When the next message was logged, ns; nothing at the end.
    pub(super) fn next_time(&self) -> Option<u64> {
        self.next.as_ref().map(|message| message.log_time)
    }

    /// Takes the next message with its publication.
    pub(super) fn take(&mut self) -> Option<(usize, BagMessage)> {
        let message = self.next.take()?;
        let port = self.port(&message)?;
        self.advance();
        Some((port, message))
    }

    /// Why the tape ended before its end, said once.
    pub(super) fn take_problem(&mut self) -> Option<BagError> {
        self.problem.take()
    }

    /// Goes to a log time, ns, or to the beginning where that is later. Gives what late readers of latched topics get:
    /// the last message of each before that time.
    pub(super) fn seek(&mut self, time: u64) -> Vec<(usize, BagMessage)> {
        let time = time.max(self.span.0);
        self.messages = self.bag.messages_from(time);
        self.next = None;
        self.advance();
        self.latched_before(time)
    }

    /// As [`Tape::seek`] to the beginning, without moving.
    pub(super) fn latched_before(&self, time: u64) -> Vec<(usize, BagMessage)> {
        let topics = self.bag.topics();
        let is_latched: Vec<bool> =
            topics.iter().map(|topic| topic.qos().durability == Durability::TransientLocal).collect();
        let mut last: Vec<Option<BagMessage>> = vec![None; topics.len()];
        let starts_later = self.bag.span().is_some_and(|(first, _)| first < time);
        let earlier = self.bag.messages().map_while(Result::ok).take_while(|message| message.log_time < time);
        for message in earlier.filter(|_| starts_later) {
            let topic = message.topic;
            if is_latched.get(topic) == Some(&true)
                && let Some(slot) = last.get_mut(topic)
            {
                *slot = Some(message);
            }
        }
        last.into_iter().flatten().filter_map(|message| Some((self.port(&message)?, message))).collect()
    }

    fn port(&self, message: &BagMessage) -> Option<usize> {
        self.ports.get(message.topic).copied().flatten()
    }

    fn advance(&mut self) {
        loop {
            self.next = match self.messages.next() {
                Some(Ok(message)) if message.log_time > self.span.1 => None,
                Some(Ok(message)) if self.port(&message).is_none() => continue,
                Some(Ok(message)) => Some(message),
                Some(Err(error)) => {
                    self.problem = Some(error);
                    None
                }
                None => None,
            };
            return;
        }
    }
}
