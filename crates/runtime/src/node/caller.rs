//! A service that the node calls.

use crate::transport::dds::ServiceClient;
use rustdds::bytes::Bytes;
use std::collections::VecDeque;
use trench_core::Steady;

/// How long a server has to answer.
const PATIENCE_SECONDS: f64 = 5.0;

/// The calls under way.
pub(crate) struct Caller {
    pub(crate) service: ServiceClient,
    pending: VecDeque<(u64, Steady)>,
}

impl Caller {
    pub(crate) fn new(service: ServiceClient) -> Self {
        Self { service, pending: VecDeque::new() }
    }

    /// Sends a request.
    pub(crate) fn call(&mut self, request: Bytes, now: Steady) {
        match self.service.call(request) {
            Ok(count) => self.pending.push_back((count, now.plus_seconds(PATIENCE_SECONDS))),
            // Nobody acknowledges requests any more: that call fails at once, as count 0, which no response names.
            Err(_congested) => self.pending.push_front((0, now)),
        }
    }

    /// The response to one of the calls under way.
    pub(crate) fn take(&mut self) -> Option<Result<Bytes, String>> {
        loop {
            match self.service.take()? {
                Err(problem) => return Some(Err(problem)),
                Ok((count, response)) => {
                    let before = self.pending.len();
                    self.pending.retain(|(pending, _)| *pending != count);
                    if self.pending.len() < before {
                        return Some(Ok(response));
                    }
                }
            }
        }
    }

    /// When the oldest call expires.
    pub(crate) fn next_deadline(&self) -> Option<Steady> {
        self.pending.front().map(|(_, deadline)| *deadline)
    }

    /// Gives up the oldest call if its time is over.
    pub(crate) fn expire(&mut self, now: Steady) -> bool {
        let over = self.next_deadline().is_some_and(|deadline| deadline <= now);
        if over {
            self.pending.pop_front();
        }
        over
    }
}
