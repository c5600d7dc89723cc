//! The calling end of a service: queries.

use super::attachment::Attachment;
use super::inbox::{Inbox, Outlet, wakes_by};
use super::reader::bytes;
use crate::transport::network::{Congested, Gid, ServiceClient};
use rustdds::bytes::Bytes;
use std::collections::BTreeSet;
use std::time::Duration;
use zenoh::Wait;
use zenoh::key_expr::KeyExpr;
use zenoh::liveliness::LivelinessToken;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::{ConsolidationMode, QueryTarget, Reply};

/// Responses that wait for the loop.
const WAITING: usize = 64;

/// When Zenoh forgets a query: after the node has given up the call.
const FORGOTTEN: Duration = Duration::from_secs(10);

/// Requests, and with them their responses, go before the messages of topics: they are few and short, whoever asks another host's
/// time knows it the better the sooner the answer comes, and what waits behind images is dropped with them.
const PRIORITY: Priority = Priority::InteractiveHigh;

/// Sends requests and takes their responses.
pub(super) struct ZenohClient {
    session: zenoh::Session,
    key: KeyExpr<'static>,
    gid: Gid,
    inbox: Inbox<Reply>,
    outlet: Outlet<Reply>,
    calls: u64,
    servers: usize,
    _token: LivelinessToken,
}

wakes_by!(ZenohClient, inbox);

impl ZenohClient {
    /// Opens a service; `declare_token` tells the graph of it.
    pub(super) fn open(
        session: &zenoh::Session,
        key: String,
        gid: Gid,
        declare_token: impl FnOnce() -> zenoh::Result<LivelinessToken>,
    ) -> zenoh::Result<Self> {
        let (inbox, outlet) = Inbox::new(WAITING)?;
        let (session, key) = (session.clone(), KeyExpr::try_from(key)?);
        Ok(Self { session, key, gid, inbox, outlet, calls: 0, servers: 0, _token: declare_token()? })
    }
}

impl ServiceClient for ZenohClient {
    fn clear_wakeup(&self) {
        self.inbox.clear_wakeup();
    }

    fn is_ready(&self) -> bool {
        self.servers > 0
    }

    fn call(&mut self, request: Bytes) -> Result<u64, Congested> {
        self.calls += 1;
        let attachment = Attachment { count: i64::try_from(self.calls).unwrap_or(i64::MAX), gid: self.gid };
        let outlet = self.outlet.clone();
        self.session
            .get(self.key.clone())
            .payload(request)
            .attachment(attachment.to_bytes())
            .target(QueryTarget::AllComplete)
            .consolidation(ConsolidationMode::None)
            .congestion_control(CongestionControl::Drop)
            .priority(PRIORITY)
            .express(true)
            .timeout(FORGOTTEN)
            .callback(move |reply| outlet.put(reply))
            .wait()
            .map(|()| self.calls)
            .map_err(|_closed| Congested)
    }

    fn take(&mut self) -> Option<Result<(u64, Bytes), String>> {
        loop {
            let reply = self.inbox.take()?;
            let sample = match reply.into_result() {
                Ok(sample) => sample,
                Err(error) => {
                    let problem = String::from_utf8_lossy(&error.payload().to_bytes()).into_owned();
                    return Some(Err(format!("{}: {problem}", self.key)));
                }
            };
            let ours = Attachment::of(sample.attachment()).filter(|attachment| attachment.gid == self.gid);
            if let Some(count) = ours.and_then(|attachment| u64::try_from(attachment.count).ok()) {
                return Some(Ok((count, bytes(sample.payload()))));
            }
        }
    }

    fn readers_changed(&mut self, _writer: &Gid, _readers: &BTreeSet<Gid>) {}

    fn writers_changed(&mut self, reader: &Gid, writers: usize) {
        if *reader == self.gid {
            self.servers = writers;
        }
    }

    fn flush(&mut self) -> bool {
        true
    }
}
