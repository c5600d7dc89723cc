//! A service that the node calls.

use crate::transport::network::ServiceClient;
use rustdds::bytes::Bytes;
use std::collections::VecDeque;
use trench_core::Steady;

/// How long a server has to answer.
const PATIENCE_SECONDS: f64 = 5.0;

/// The calls under way.
pub(crate) struct Caller {
    pub(crate) service: Box<dyn ServiceClient>,
    calls: VecDeque<Call>,
}

struct Call {
    /// Kept until a server is there to hear it.
    unsent: Option<Bytes>,
    /// The request's count once it is sent.
    count: u64,
    deadline: Steady,
}

impl Caller {
    pub(crate) fn new(service: Box<dyn ServiceClient>) -> Self {
        Self { service, calls: VecDeque::new() }
    }

    /// Sends a request, as soon as a server is there.
    pub(crate) fn call(&mut self, request: Bytes, now: Steady) {
        let deadline = now.plus_seconds(PATIENCE_SECONDS);
        self.calls.push_back(Call { unsent: Some(request), count: 0, deadline });
        self.flush();
    }

    /// Sends what waits; true when nothing waits for room on the network any longer.
    pub(crate) fn flush(&mut self) -> bool {
        if self.service.is_ready() {
            for call in &mut self.calls {
                // A request that nobody has room for stays unanswered: it expires like any other.
                let sent = call.unsent.take().and_then(|request| self.service.call(request).ok());
                call.count = sent.unwrap_or(call.count);
            }
        }
        self.service.flush()
    }

    /// The response to one of the calls under way.
    pub(crate) fn take(&mut self) -> Option<Result<Bytes, String>> {
        loop {
            match self.service.take()? {
                Err(problem) => return Some(Err(problem)),
                Ok((count, response)) => {
                    let before = self.calls.len();
                    self.calls.retain(|call| call.count != count);
                    if self.calls.len() < before {
                        return Some(Ok(response));
                    }
                }
            }
        }
    }

    /// When the oldest call expires.
    pub(crate) fn next_deadline(&self) -> Option<Steady> {
        self.calls.front().map(|call| call.deadline)
    }

    /// Gives up the oldest call if its time is over.
    pub(crate) fn expire(&mut self, now: Steady) -> bool {
        let over = self.next_deadline().is_some_and(|deadline| deadline <= now);
        if over {
            self.calls.pop_front();
        }
        over
    }
}
