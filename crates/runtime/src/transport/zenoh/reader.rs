//! The network end of a subscription.

use super::attachment::Attachment;
use super::inbox::{Inbox, Outlet, wakes_by};
use crate::clock::steady_now;
use crate::transport::network::{Gid, NetworkReader, NetworkSample};
use rustdds::bytes::Bytes;
use std::borrow::Cow;
use trench_core::{Durability, Qos, Reliability, Source, Steady};
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh_ext::{AdvancedSubscriber, AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

/// Messages that wait until the event loop takes them: more than any burst that a node of a team sends between two
/// turns of the loop.
const UNREAD: usize = 4096;

/// Takes messages in the order of each writer.
pub(super) struct ZenohReader {
    /// Messages, and when they came.
    inbox: Inbox<(Steady, Sample)>,
    gid: Gid,
    _subscriber: AnySubscriber,
    _token: LivelinessToken,
}

wakes_by!(ZenohReader, inbox);

/// With the past of latched topics, or without. Kept, because dropping it ends the subscription.
#[expect(dead_code, reason = "kept alive, never looked at")]
enum AnySubscriber {
    Plain(Subscriber<()>),
    Latched(Box<AdvancedSubscriber<()>>),
}

impl ZenohReader {
    /// Opens a topic; `declare_token` tells the graph of it, once it is open.
    pub(super) fn open(
        session: &zenoh::Session,
        key: String,
        qos: Qos,
        gid: Gid,
        declare_token: impl FnOnce() -> zenoh::Result<LivelinessToken>,
    ) -> zenoh::Result<Self> {
        let (inbox, outlet) = Inbox::new(UNREAD)?;
        let put = move |outlet: &Outlet<(Steady, Sample)>, sample: Sample| {
            if sample.kind() == SampleKind::Put {
                outlet.put((steady_now(), sample));
            }
        };
        let builder = session.declare_subscriber(key).callback(move |sample| put(&outlet, sample));
        let subscriber = match qos.durability {
            Durability::Volatile => AnySubscriber::Plain(builder.wait()?),
            Durability::TransientLocal => {
                let past = HistoryConfig::default().detect_late_publishers().max_samples(qos.depth.max(1));
                let builder = builder.history(past).subscriber_detection();
                let recovery = RecoveryConfig::default().heartbeat();
                let reliable = qos.reliability == Reliability::Reliable;
                let builder = if reliable { builder.recovery(recovery) } else { builder };
                AnySubscriber::Latched(Box::new(builder.wait()?))
            }
        };
        Ok(Self { inbox, gid, _subscriber: subscriber, _token: declare_token()? })
    }
}

impl NetworkReader for ZenohReader {
    fn gid(&self) -> Gid {
        self.gid
    }

    fn clear_wakeup(&self) {
        self.inbox.clear_wakeup();
    }

    fn take(&self) -> Option<Result<NetworkSample, String>> {
        let (arrived, sample) = self.inbox.take()?;
        let Some(Attachment { count, gid }) = Attachment::of(sample.attachment()) else {
            return Some(Err("it does not say whose it is and which (an attachment of 33 bytes)".to_owned()));
        };
        let source = Source { gid, sequence: u64::try_from(count).unwrap_or(0) };
        Some(Ok(NetworkSample { source, cdr: bytes(sample.payload()), arrived }))
    }
}

/// The bytes in one piece.
pub(super) fn bytes(payload: &ZBytes) -> Bytes {
    match payload.to_bytes() {
        Cow::Borrowed(bytes) => Bytes::copy_from_slice(bytes),
        Cow::Owned(bytes) => bytes.into(),
    }
}
