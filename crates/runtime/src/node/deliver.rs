//! Bringing what arrived to the core.

use super::{Node, Subscription, Wake};
use crate::stream::Change;
use crate::transport::dds::GraphChange;
use crate::transport::shared_memory::Host;
use std::io;
use std::time::Instant;
use trench_core::{Event, Level, RosTime, Sink, Steady};
use trench_msgs::Message;
use trench_msgs::rosgraph_msgs::Clock as ClockMessage;

/// Bytes read from a stream at once.
const CHUNK: usize = 4096;

impl Node {
    /// Hands an event to the core, with both times of now.
    fn handle(&mut self, event: Event<'_>) {
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
        self.handle(Event::Shutdown);
    }

    /// Brings what woke the loop.
    pub(crate) fn wake(&mut self, wake: Wake) {
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
            self.handle(Event::Wakeup);
        }
        for client in 0..self.ports.callers.len() {
            while self.ports.callers[client].expire(now) {
                self.handle(Event::Response { client, cdr: None });
            }
        }
        self.open_shared_memory(now, host);
        for stream in 0..self.ports.streams.len() {
            if let Some(change) = self.ports.streams[stream].open(now, &self.ports.registry) {
                self.stream_changed(stream, change);
            }
        }
    }

    /// When [`Node::tick`] is to be called next.
    pub(crate) fn next_tick(&self) -> Option<Steady> {
        let expiries = self.ports.callers.iter().filter_map(|caller| caller.next_deadline());
        let retries = self.ports.streams.iter().filter_map(|stream| stream.next_retry());
        let searches = self.readers().filter_map(Subscription::next_retry);
        self.core.next_wakeup().into_iter().chain(expiries).chain(retries).chain(searches).min()
    }

    /// Follows the ROS graph.
    pub(crate) fn graph_changed(&mut self, change: &GraphChange) {
        match change {
            GraphChange::Matched { reader, writers } => {
                self.ports.callers.iter_mut().for_each(|caller| caller.service.writers_changed(*reader, *writers));
                let port = self.subscriptions.iter().position(|subscription| subscription.network.guid() == *reader);
                if let Some(port) = port {
                    self.handle(Event::Matched { port, writers: *writers });
                }
            }
            GraphChange::Readers { writer, readers } => {
                self.ports.callers.iter_mut().for_each(|caller| caller.service.readers_changed(*writer, readers));
                let servers = self.ports.servers.iter_mut().chain(self.parameters.services());
                servers.for_each(|server| server.readers_changed(*writer, readers));
            }
            GraphChange::Writer { topic, type_name } => self.look_at_writer(topic, type_name),
            GraphChange::Incompatible { local, remote } => {
                let reader = self.subscriptions.iter().find(|subscription| subscription.network.guid() == *local);
                if let Some(topic) = reader.map(|reader| reader.topic().to_owned()) {
                    let text = format!("{topic}: the quality of service of writer {remote:?} does not suffice");
                    self.ports.warn(&text);
                }
            }
        }
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

    fn readers(&self) -> impl Iterator<Item = &Subscription> {
        self.subscriptions.iter().chain(&self.clock)
    }

    /// Opens shared memory where it has appeared; what is in there already is delivered at once.
    fn open_shared_memory(&mut self, now: Steady, host: &Host) {
        for port in 0..self.subscriptions.len() {
            match self.subscriptions[port].open_local(now, host, &self.ports.registry) {
                Ok(true) => {
                    let text = format!("{}: through shared memory", self.subscriptions[port].topic());
                    self.ports.log(Level::Debug, &text);
                    self.take_messages(port);
                }
                Ok(false) if self.subscriptions[port].is_due(now) => self.take_messages(port),
                Ok(false) => {}
                Err(problem) => self.ports.warn(&format!("{problem}; the network is used instead")),
            }
        }
        match self.clock.as_mut().map(|clock| clock.open_local(now, host, &self.ports.registry)) {
            Some(Ok(true)) => self.take_clock(),
            Some(Err(problem)) => self.ports.warn(&format!("{problem}; the network is used instead")),
            Some(Ok(false)) | None => {}
        }
    }

    fn look_at_writer(&mut self, topic: &str, type_name: &str) {
        let readers = self.subscriptions.iter_mut().chain(&mut self.clock);
        readers.filter(|reader| reader.network_name().topic() == topic).for_each(Subscription::look_for_writer);
        let foreign = self.subscriptions.iter().find(|subscription| {
            subscription.network_name().topic() == topic && subscription.network_name().type_name() != type_name
        });
        if let Some(subscription) = foreign {
            let text = format!(
                "{}: another process writes {type_name} there; this node reads {} and gets nothing of it",
                subscription.topic(),
                subscription.network_name().type_name()
            );
            self.ports.warn(&text);
        }
    }

    fn take_clock(&mut self) {
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

    fn take_messages(&mut self, port: usize) {
        let (core, ports) = (&mut self.core, &mut self.ports);
        let Some(subscription) = self.subscriptions.get_mut(port) else { return };
        let mut problems = Vec::new();
        subscription.drain(
            ports.clock.now().steady,
            |source, cdr| core.handle(ports.clock.now(), Event::Message { port, source, cdr }, ports),
            |problem| problems.push(problem),
        );
        let topic = subscription.topic().to_owned();
        let lost = subscription.take_lost();
        if lost > 0 {
            self.ports.warn(&format!("{topic}: {lost} message(s) lost: they came faster than this node reads"));
        }
        self.report(&topic, &problems);
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

    fn take_bytes(&mut self, stream: usize) {
        let mut buffer = [0; CHUNK];
        loop {
            let registry = &self.ports.registry;
            let line = &mut self.ports.streams[stream];
            match line.flush(registry).and_then(|()| line.read(&mut buffer)) {
                Ok(0) => return,
                Ok(count) => self.handle(Event::Bytes { stream, data: &buffer[..count] }),
                Err(error) => {
                    self.ports.broken.push((stream, error));
                    return self.close_broken_streams();
                }
            }
        }
    }

    fn close_broken_streams(&mut self) {
        for (stream, error) in std::mem::take(&mut self.ports.broken) {
            self.close_stream(stream, &error);
        }
    }

    fn close_stream(&mut self, stream: usize, error: &io::Error) {
        let now = self.ports.clock.now().steady;
        if let Some(change) = self.ports.streams[stream].close(now, error, &self.ports.registry) {
            self.stream_changed(stream, change);
        }
    }

    fn stream_changed(&mut self, stream: usize, change: Change) {
        match change {
            Change::Opened => self.handle(Event::StreamState { stream, open: true }),
            Change::Broke(reason) => {
                self.ports.log(Level::Error, &reason);
                self.handle(Event::StreamState { stream, open: false });
            }
            Change::Absent(reason) => self.ports.log(Level::Error, &reason),
        }
    }

    fn report(&mut self, topic: &str, problems: &[String]) {
        if let Some(first) = problems.first() {
            let count = problems.len();
            self.ports.warn(&format!("{topic}: {count} unreadable message(s) dropped, the first because: {first}"));
        }
    }
}
