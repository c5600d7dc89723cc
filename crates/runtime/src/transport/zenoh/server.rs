//! The serving end of a service: a queryable.

use super::attachment::Attachment;
use super::inbox::{Inbox, wakes_by};
use super::reader::bytes;
use crate::transport::network::{Gid, NotSent, PendingRequest, ServiceServer};
use rustdds::bytes::Bytes;
use std::collections::{BTreeMap, BTreeSet};
use zenoh::Wait;
use zenoh::liveliness::LivelinessToken;
use zenoh::query::{Query, Queryable};

/// Requests that wait for the loop, and as many for their answers.
const WAITING: usize = 1024;

/// Takes requests and sends responses.
pub(super) struct ZenohServer {
    inbox: Inbox<Query>,
    pending: BTreeMap<PendingRequest, Query>,
    _queryable: Queryable<()>,
    _token: LivelinessToken,
}

wakes_by!(ZenohServer, inbox);

impl ZenohServer {
    /// Opens a service; `declare_token` tells the graph of it, once it is open.
    pub(super) fn open(
        session: &zenoh::Session,
        key: String,
        declare_token: impl FnOnce() -> zenoh::Result<LivelinessToken>,
    ) -> zenoh::Result<Self> {
        let (inbox, outlet) = Inbox::new(WAITING)?;
        let queryable =
            session.declare_queryable(key).complete(true).callback(move |query| outlet.put(query)).wait()?;
        Ok(Self { inbox, pending: BTreeMap::new(), _queryable: queryable, _token: declare_token()? })
    }
}

impl ServiceServer for ZenohServer {
    fn clear_wakeup(&self) {
        self.inbox.clear_wakeup();
    }

    fn take(&mut self) -> Option<Result<(PendingRequest, Bytes), String>> {
        let query = self.inbox.take()?;
        let (Some(Attachment { count, gid }), Some(payload)) = (Attachment::of(query.attachment()), query.payload())
        else {
            let problem = format!("{}: a request without its bytes or without its sender", query.key_expr());
            return Some(Err(problem));
        };
        let (request, cdr) = (PendingRequest { client: gid, count }, bytes(payload));
        // Who asks that much and is never answered will not miss the oldest.
        if self.pending.len() >= WAITING {
            self.pending.pop_first();
        }
        self.pending.insert(request, query);
        Some(Ok((request, cdr)))
    }

    fn respond(&mut self, request: PendingRequest, response: Bytes) -> Result<(), NotSent> {
        if let Some(query) = self.pending.remove(&request) {
            let attachment = Attachment { count: request.count, gid: request.client }.to_bytes();
            let reply = query.reply(query.key_expr().clone(), response).attachment(attachment).express(true);
            // A client that has gone does not miss its answer.
            let _gone = reply.wait();
        }
        Ok(())
    }

    /// Zenoh brings a response to whoever asked.
    fn readers_changed(&mut self, _writer: &Gid, _readers: &BTreeSet<Gid>) {}

    fn flush(&mut self) -> bool {
        true
    }
}
