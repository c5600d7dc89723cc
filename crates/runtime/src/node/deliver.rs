//! Bringing what arrived to the core.

use super::{ClockReference, Node, NodeWake, Publication};
use std::time::Instant;
use trench_core::{Event, Level, RosTime, Sink, Steady};

impl Node {
    /// Hands an event to the core, with both times of now.
    pub(crate) fn handle(&mut self, event: Event<'_>) {
        self.core.handle(self.ports.clock.now(), event, &mut self.ports);
        self.close_broken_streams();
    }

    /// The first event of a life.
    pub(crate) fn start(&mut self) {
        self.tell_parameters();
        self.handle(Event::Started);
    }

    /// The last one.
    pub(crate) fn shut_down(&mut self) {
        self.ports.publications.iter_mut().for_each(Publication::say_last_words);
        self.handle(Event::Shutdown);
    }

    /// Brings what woke the loop.
    pub(crate) fn wake(&mut self, wake: NodeWake) {
        match wake {
            NodeWake::Requests(service) => self.take_requests(service),
            NodeWake::Responses(client) => self.take_responses(client),
            NodeWake::ClockAnswers => self.take_clock_answers(),
            NodeWake::ClockQuestions => self.take_clock_questions(),
            NodeWake::Stream(stream) => self.take_bytes(stream),
            NodeWake::Parameters(service) => self.take_parameter_requests(service),
        }
    }

    /// What time brings: a wake-up that is due, calls that expired, streams to be opened.
    pub(crate) fn tick(&mut self, now: Steady) {
        if self.is_due(now) {
            self.handle(Event::Wakeup);
        }
        for client in 0..self.ports.callers.len() {
            while self.ports.callers[client].expire(now) {
                self.handle(Event::Response { client, cdr: None });
            }
        }
        self.ask_clock(now);
        self.tell_notices(now);
        self.open_streams(now);
    }

    /// Whether the core wants to wake up.
    pub(crate) fn is_due(&self, now: Steady) -> bool {
        self.core.next_wakeup().is_some_and(|at| at <= now)
    }

    /// When [`Node::tick`] is to be called next.
    pub(crate) fn next_tick(&self) -> Option<Steady> {
        let expiries = self.ports.callers.iter().filter_map(|caller| caller.next_deadline());
        let retries = self.ports.streams.iter().filter_map(|stream| stream.next_retry());
        let question = self.reference.as_ref().map(ClockReference::next);
        self.core.next_wakeup().into_iter().chain(expiries).chain(retries).chain(question).min()
    }

    /// The code that the core asked to end with, if it did.
    pub(crate) fn exit(&self) -> Option<u8> {
        self.ports.exit
    }

    /// Sends what waits for room on the network; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        self.flush_clock() & self.parameters.flush() & self.ports.flush()
    }

    /// Gives last words time to leave, at most until `deadline`.
    pub(crate) fn settle(&mut self, deadline: Instant) {
        self.ports.settle(deadline);
    }

    /// Takes a time from /clock.
    pub(crate) fn set_clock(&mut self, time: RosTime) {
        self.ports.clock.set(time);
    }

    fn take_requests(&mut self, service: usize) {
        self.ports.servers[service].clear_wakeup();
        while let Some(taken) = self.ports.servers[service].take() {
            match taken {
                Ok((request, cdr)) => {
                    let id = self.ports.remember(request);
                    self.handle(Event::Request { service, id, cdr: &cdr });
                }
                Err(problem) => self.ports.warn(&problem),
            }
        }
    }

    fn take_responses(&mut self, client: usize) {
        self.ports.callers[client].service.clear_wakeup();
        while let Some(taken) = self.ports.callers[client].take() {
            match taken {
                Ok(cdr) => self.handle(Event::Response { client, cdr: Some(&cdr) }),
                Err(problem) => self.ports.warn(&problem),
            }
        }
    }

    /// Says in the node's name what the process could not do for it.
    pub(crate) fn warn(&mut self, text: &str) {
        self.ports.warn(text);
    }

    /// Tells developers something of the runtime's own in the node's name.
    pub(crate) fn debug(&mut self, text: &str) {
        self.ports.log(Level::Debug, text);
    }
}
