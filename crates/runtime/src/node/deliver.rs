//! Bringing what arrived to the core.

use super::{Node, Publication, Subscription, Wake};
use crate::transport::shared_memory::Host;
use std::time::Instant;
use trench_core::{Event, RosTime, Steady};
use trench_msgs::Message;
use trench_msgs::rosgraph_msgs::Clock as ClockMessage;

impl Node {
    /// Hands an event to the core, with both times of now.
    pub(super) fn handle(&mut self, event: Event<'_>) {
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

    /// Brings what woke the loop, and before it what has come without waking.
    pub(crate) fn wake(&mut self, wake: Wake) {
        self.take_waiting();
        match wake {
            Wake::Clock => self.take_clock(),
            Wake::Messages(port) => self.take_messages(port),
            Wake::Requests(service) => self.take_requests(service),
            Wake::Responses(client) => self.take_responses(client),
            Wake::Stream(stream) => self.take_bytes(stream),
            Wake::Parameters(service) => self.take_parameter_requests(service),
        }
    }

    /// What time brings: a wake-up that is due, calls that expired, streams to be opened.
    pub(crate) fn tick(&mut self, now: Steady, host: &Host) {
        if self.core.next_wakeup().is_some_and(|at| at <= now) {
            self.take_waiting();
            self.handle(Event::Wakeup);
        }
        for client in 0..self.ports.callers.len() {
            while self.ports.callers[client].expire(now) {
                self.handle(Event::Response { client, cdr: None });
            }
        }
        self.open_shared_memory(now, host);
        self.open_streams(now);
    }

    /// When [`Node::tick`] is to be called next.
    pub(crate) fn next_tick(&self) -> Option<Steady> {
        let expiries = self.ports.callers.iter().filter_map(|caller| caller.next_deadline());
        let retries = self.ports.streams.iter().filter_map(|stream| stream.next_retry());
        let searches = self.readers().filter_map(Subscription::next_retry);
        self.core.next_wakeup().into_iter().chain(expiries).chain(retries).chain(searches).min()
    }

    /// The code that the core asked to end with, if it did.
    pub(crate) fn exit(&self) -> Option<u8> {
        self.ports.exit
    }

    /// Sends what waits for room on the network; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        self.parameters.flush() & self.ports.flush()
    }

    /// Gives last words time to leave, at most until `deadline`.
    pub(crate) fn settle(&mut self, deadline: Instant) {
        self.ports.settle(deadline);
    }

    pub(super) fn take_clock(&mut self) {
        let Some(clock) = &mut self.clock else { return };
        let ports = &mut self.ports;
        let mut problems = Vec::new();
        clock.drain(
            ports.clock.now().steady,
            |_, cdr| {
                if let Ok(message) = ClockMessage::decode(cdr) {
                    ports.clock.set(RosTime::from(&message.clock));
                }
            },
            |problem| problems.push(problem),
        );
        self.report("/clock", &problems);
    }

    /// Takes the messages of topics that do not wake the node.
    fn take_waiting(&mut self) {
        for port in 0..self.subscriptions.len() {
            if !self.subscriptions[port].wakes() {
                self.take_messages(port);
            }
        }
    }

    pub(super) fn take_messages(&mut self, port: usize) {
        let (core, ports) = (&mut self.core, &mut self.ports);
        let Some(subscription) = self.subscriptions.get_mut(port) else { return };
        let mut problems = Vec::new();
        subscription.drain(
            ports.clock.now().steady,
            |source, cdr| core.handle(ports.clock.now(), Event::Message { port, source, cdr }, ports),
            |problem| problems.push(problem),
        );
        let lost = subscription.take_lost();
        if lost > 0 || !problems.is_empty() {
            let topic = subscription.topic().to_owned();
            if lost > 0 {
                self.ports.warn(&format!("{topic}: {lost} message(s) lost: they came faster than this node reads"));
            }
            self.report(&topic, &problems);
        }
        self.close_broken_streams();
    }

    fn take_requests(&mut self, service: usize) {
        self.ports.servers[service].requests.clear_wakeup();
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
        self.ports.callers[client].service.responses.clear_wakeup();
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

    fn report(&mut self, topic: &str, problems: &[String]) {
        if let Some(first) = problems.first() {
            let count = problems.len();
            self.ports.warn(&format!("{topic}: {count} unreadable message(s) dropped, the first because: {first}"));
        }
    }
}
