//! Where a core's outputs go.

use super::publication::PublishProblem;
use super::{Caller, Publication};
use crate::checkpoint::Checkpoint;
use crate::clock::Clock;
use crate::log::Logger;
use crate::stream::Stream;
use crate::transport::network::{PendingRequest, ServiceServer};
use rustdds::mio1::Registry;
use std::collections::BTreeMap;
use std::io;
use std::time::{Duration, Instant};
use trench_core::{Level, RequestId, Sink};
use trench_msgs::Encode;

/// All that a node writes to. A separate structure from the core, so that the core can be handed it.
pub(crate) struct Ports {
    pub(crate) clock: Clock,
    pub(crate) logger: Logger,
    pub(crate) publications: Vec<Publication>,
    pub(crate) servers: Vec<Box<dyn ServiceServer>>,
    pub(crate) callers: Vec<Caller>,
    pub(crate) streams: Vec<Stream>,
    pub(crate) checkpoint: Checkpoint,
    pub(crate) registry: Registry,
    pub(crate) pending: BTreeMap<RequestId, PendingRequest>,
    pub(crate) next_request: u64,
    /// Streams that failed while the core wrote to them; the loop closes them once the event is handled.
    pub(crate) broken: Vec<(usize, io::Error)>,
    /// Set once the core asked to end.
    pub(crate) exit: Option<u8>,
}

impl Ports {
    /// Remembers whom to answer.
    pub(crate) fn remember(&mut self, request: PendingRequest) -> RequestId {
        self.next_request += 1;
        let id = RequestId(self.next_request);
        self.pending.insert(id, request);
        id
    }

    /// Sends what waits for room on the network; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        let mut done = self.logger.flush();
        for publication in &mut self.publications {
            done &= publication.flush();
        }
        for server in &mut self.servers {
            done &= server.flush();
        }
        for caller in &mut self.callers {
            done &= caller.flush();
        }
        done
    }

    /// Gives last words time to leave, at most until `deadline`.
    pub(crate) fn settle(&mut self, deadline: Instant) {
        while !self.streams.iter_mut().all(|stream| stream.is_sent(&self.registry)) && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(1));
        }
        for publication in &mut self.publications {
            publication.settle(deadline.saturating_duration_since(Instant::now()));
        }
    }

    /// Reports something of the runtime's own in the node's name.
    pub(crate) fn warn(&mut self, text: &str) {
        self.logger.log(self.clock.now().ros, Level::Warn, text);
    }
}

impl Sink for Ports {
    fn publish_with(&mut self, port: usize, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) {
        let Some(publication) = self.publications.get_mut(port) else { return };
        let before = publication.alone_with();
        let result = publication.publish_with(self.clock.now().steady, max_len, fill);
        let (topic, now) = (publication.topic(), publication.alone_with());
        let turned = (now != before).then(|| match now {
            Some(readers) => format!("{topic}: the network rests, {readers} reader(s) share memory"),
            None => format!("{topic}: over the network too"),
        });
        let text = match result {
            Ok(()) => return turned.into_iter().for_each(|text| self.log(Level::Debug, &text)),
            Err(PublishProblem::SharedMemory(problem)) => format!("{}: shared memory: {problem}", publication.topic()),
            // Told at 1, 2, 4, ...: a reader this far behind stays so for a while.
            Err(PublishProblem::Congested) if publication.refused().is_power_of_two() => format!(
                "{}: {} messages not sent: a reader is more than 8192 messages behind",
                publication.topic(),
                publication.refused()
            ),
            Err(PublishProblem::Congested) => return,
        };
        self.log(Level::Error, &text);
    }

    fn respond(&mut self, service: usize, id: RequestId, response: &dyn Encode) {
        let (Some(server), Some(request)) = (self.servers.get_mut(service), self.pending.remove(&id)) else { return };
        if let Err(reason) = server.respond(request, response.to_cdr().into()) {
            self.warn(&format!("a response was not sent: {reason}"));
        }
    }

    fn call(&mut self, client: usize, request: &dyn Encode) {
        if let Some(caller) = self.callers.get_mut(client) {
            caller.call(request.to_cdr().into(), self.clock.now().steady);
        }
    }

    fn write_bytes(&mut self, stream: usize, bytes: &[u8]) {
        if let Some(target) = self.streams.get_mut(stream)
            && let Err(error) = target.write(bytes, &self.registry)
        {
            self.broken.push((stream, error));
        }
    }

    fn log(&mut self, level: Level, text: &str) {
        self.logger.log(self.clock.now().ros, level, text);
    }

    fn checkpoint(&mut self, bytes: &[u8]) {
        if let Err(error) = self.checkpoint.write(bytes) {
            let text = format!("cannot keep state in {}: {error}", self.checkpoint.path().display());
            self.log(Level::Error, &text);
        }
    }

    fn exit(&mut self, code: u8) {
        self.exit.get_or_insert(code);
    }
}
