//! The network end of a publication.

use super::attachment::Attachment;
use super::long::LongWay;
use crate::clock::steady_now;
use crate::transport::network::{Congested, Gid, ImageWay, Lane, NetworkWriter, Pace};
use rustdds::bytes::Bytes;
use std::collections::BTreeSet;
use std::io;
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};
use trench_core::{Durability, Qos, Reliability};
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};

/// Messages from this length on are cut into fragments on some link, bytes; Zenoh's batches hold 65535.
const LONG: usize = 60_000;

/// How often a latched writer that is silent says what it said last, so that readers see what they missed: as rmw_zenoh.
const HEARTBEAT: Duration = Duration::from_millis(500);

/// How long the last words of a process have: Zenoh does not tell when a link is empty.
const LAST_WORDS: Duration = Duration::from_millis(20);

/// Publishes in order. What a reader's link has no room for within 1 ms is lost to this reader, as with rmw_zenoh; a
/// frozen reader costs the others nothing.
pub(super) struct ZenohWriter {
    publisher: Arc<AnyPublisher>,
    gid: Gid,
    accepted: u64,
    images: ImageWay<Put>,
    /// Whether messages go the long way, from the first long one on: the order stays.
    long: bool,
    long_way: Arc<LongWay>,
    written: Option<Instant>,
    _token: LivelinessToken,
}

/// With the past of a latched topic, or without.
enum AnyPublisher {
    Plain(Publisher<'static>),
    Latched(AdvancedPublisher<'static>),
}

/// A message on its way.
pub(super) struct Put {
    publisher: Arc<AnyPublisher>,
    message: Bytes,
    attachment: ZBytes,
}

impl Put {
    pub(super) fn send(self) {
        let message = ZBytes::from(self.message);
        // It fails only once the session is closed, and nobody is left to hear of it.
        let _closed = match &*self.publisher {
            AnyPublisher::Plain(publisher) => publisher.put(message).attachment(self.attachment).wait(),
            AnyPublisher::Latched(publisher) => publisher.put(message).attachment(self.attachment).wait(),
        };
    }
}

impl ZenohWriter {
    /// Opens a topic; `declare_token` tells the graph of it, once it is open.
    pub(super) fn open(
        session: &zenoh::Session,
        key: String,
        qos: Qos,
        gid: Gid,
        long_way: Arc<LongWay>,
        declare_token: impl FnOnce() -> zenoh::Result<LivelinessToken>,
    ) -> zenoh::Result<Self> {
        let reliable = qos.reliability == Reliability::Reliable;
        let builder =
            session.declare_publisher(key).congestion_control(CongestionControl::Drop).reliability(if reliable {
                zenoh::qos::Reliability::Reliable
            } else {
                zenoh::qos::Reliability::BestEffort
            });
        let publisher = match qos.durability {
            // Images and scans let pass what moves robots, wherever both wait for the same link.
            Durability::Volatile => {
                let priority = if reliable { Priority::DEFAULT } else { Priority::DataLow };
                AnyPublisher::Plain(builder.priority(priority).wait()?)
            }
            Durability::TransientLocal => {
                let cache = CacheConfig::default().max_samples(qos.depth.max(1));
                let builder = builder.cache(cache).publisher_detection();
                let detection = MissDetectionConfig::default().sporadic_heartbeat(HEARTBEAT);
                let builder = if reliable { builder.sample_miss_detection(detection) } else { builder };
                AnyPublisher::Latched(builder.wait()?)
            }
        };
        let token = declare_token()?;
        Ok(Self {
            publisher: Arc::new(publisher),
            gid,
            accepted: 0,
            images: ImageWay::new(qos),
            long: false,
            long_way,
            written: None,
            _token: token,
        })
    }

    fn put(&mut self, message: Bytes, count: u64) -> Result<(), Congested> {
        self.accepted = count;
        self.written = Some(Instant::now());
        let attachment = Attachment { count: i64::try_from(count).unwrap_or(i64::MAX), gid: self.gid }.to_bytes();
        let length = message.len();
        let put = Put { publisher: Arc::clone(&self.publisher), message, attachment };
        if let Some(lane) = self.images.of(length, paced) {
            lane.put(put);
            return Ok(());
        }
        self.long |= length >= LONG;
        if !self.long {
            put.send();
            return Ok(());
        }
        if self.long_way.send(put) { Ok(()) } else { Err(Congested) }
    }
}

/// A lane on which one image follows the other when that has had its time at `rate` bit/s. Zenoh cuts them up and lets what
/// has another priority pass.
fn paced(rate: f64) -> io::Result<Lane<Put>> {
    let mut pace = Pace::new(rate);
    Lane::open(move |put: Put| {
        sleep(pace.wait(steady_now(), put.message.len()));
        put.send();
    })
}

impl NetworkWriter for ZenohWriter {
    fn gid(&self) -> Gid {
        self.gid
    }

    fn has_room(&self) -> bool {
        true
    }

    fn write(&mut self, message: Bytes) -> Result<u64, Congested> {
        self.put(message, self.accepted + 1)?;
        Ok(self.accepted)
    }

    fn write_counted(&mut self, message: Bytes, count: u64) -> Result<(), Congested> {
        self.put(message, count)
    }

    fn longest_counted(&self) -> usize {
        usize::MAX
    }

    fn flush(&mut self) -> bool {
        true
    }

    fn settle(&mut self, max_wait: Duration) {
        if let Some(written) = self.written {
            std::thread::sleep(LAST_WORDS.saturating_sub(written.elapsed()).min(max_wait));
        }
    }

    fn limit(&mut self, rate: f64) {
        self.images.limit(rate);
    }

    /// Zenoh knows who reads.
    fn readers_changed(&mut self, _readers: &BTreeSet<Gid>) {}
}
