//! The shared-memory end of a publication.

use super::host::Topic;
use super::limits::{Limits, NODES};
use super::{Header, identity};
use crate::clock::steady_now;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::prelude::{AllocationStrategy, CallbackProgression, Node, PortFactory, ServiceName, ipc};
use iceoryx2::service::port_factory::event;
use std::collections::BTreeSet;
use trench_core::{Durability, Qos, Source};

/// Writes messages into memory that the readers see.
pub(crate) struct SharedWriter {
    topic: Topic,
    publisher: Publisher<ipc::Service, [u8], Header>,
    /// The longest message that there is room for, bytes.
    longest: usize,
    wakeups: event::PortFactory<ipc::Service>,
    notifier: Notifier<ipc::Service>,
}

impl SharedWriter {
    pub(super) fn new(node: &Node<ipc::Service>, name: &ServiceName, max_len: usize, qos: Qos) -> Result<Self, String> {
        let topic = topic(node, name, Limits::of(max_len, qos), qos)?;
        let longest = max_len.max(1);
        let publisher = publisher(&topic, longest, AllocationStrategy::Static)?;
        let wakeups = wakeups(node, name)?;
        let notifier = wakeups.notifier_builder().create().map_err(|error| format!("{error:?}"))?;
        Ok(Self { topic, publisher, longest, wakeups, notifier })
    }

    /// How many messages wait for a busy reader before the oldest is overwritten.
    pub(crate) fn buffered(&self) -> usize {
        self.topic.static_config().subscriber_max_buffer_size()
    }

    /// How many readers there are.
    pub(crate) fn readers(&self) -> usize {
        self.topic.dynamic_config().number_of_subscribers()
    }

    /// The readers' identities on the network.
    pub(crate) fn gids(&self) -> BTreeSet<[u8; 16]> {
        let mut gids = BTreeSet::new();
        self.topic.dynamic_config().list_subscribers(|reader| {
            gids.extend(identity::gid(&reader.subscriber_name));
            CallbackProgression::Continue
        });
        gids
    }

    /// Publishes what `fill` writes into at most `max_len` loaned bytes, giving its length; `copy` sees the message
    /// once more before the readers do. Gives whether all readers that wait for messages were woken: one that died without
    /// a word cannot be, nor one whose files were taken away.
    pub(crate) fn publish_with(
        &mut self,
        source: Source,
        max_len: usize,
        fill: &mut dyn FnMut(&mut [u8]) -> usize,
        copy: impl FnOnce(&[u8]),
    ) -> Result<bool, String> {
        if max_len > self.longest {
            // What grows keeps books for 256 memories of its kind: 9 MB a topic of small messages, which most never need.
            self.publisher = publisher(&self.topic, max_len, AllocationStrategy::PowerOfTwo)?;
            self.longest = usize::MAX;
        }
        let loan = self.publisher.loan_slice_uninit(max_len.max(1)).map_err(|error| format!("{error:?}"))?;
        #[expect(
            unsafe_code,
            reason = "the loan is mapped shared memory: every byte has a value, and every value is a u8"
        )]
        let mut sample = unsafe { loan.assume_init() };
        let length = fill(&mut sample.payload_mut()[..max_len]).min(max_len);
        let written = steady_now().0;
        *sample.user_header_mut() =
            Header { gid: source.gid, sequence: source.sequence, length: length as u64, written };
        copy(&sample.payload()[..length]);
        sample.send().map_err(|error| format!("{error:?}"))?;
        let waiting = self.wakeups.dynamic_config().number_of_listeners();
        if waiting == 0 {
            return Ok(true);
        }
        let woken = self.notifier.notify().map_err(|error| format!("cannot wake the readers: {error:?}"))?;
        Ok(woken >= waiting)
    }
}

fn publisher(
    topic: &Topic,
    longest: usize,
    strategy: AllocationStrategy,
) -> Result<Publisher<ipc::Service, [u8], Header>, String> {
    let builder = topic.publisher_builder().initial_max_slice_len(longest).allocation_strategy(strategy);
    builder.create().map_err(|error| format!("{error:?}"))
}

/// Makes the service of a topic or joins it as the first writer made it.
fn topic(node: &Node<ipc::Service>, name: &ServiceName, limits: Limits, qos: Qos) -> Result<Topic, String> {
    let history = if qos.durability == Durability::TransientLocal { qos.depth } else { 0 };
    let builder = || node.service_builder(name).publish_subscribe::<[u8]>().user_header::<Header>();
    builder()
        .max_publishers(limits.writers)
        .max_subscribers(limits.readers)
        .max_nodes(NODES)
        .subscriber_max_buffer_size(limits.buffered.max(history))
        .subscriber_max_borrowed_samples(limits.borrowed)
        .history_size(history)
        .enable_safe_overflow(true)
        .open_or_create()
        .or_else(|_| builder().open())
        .map_err(|error| format!("{error:?}"))
}

fn wakeups(node: &Node<ipc::Service>, name: &ServiceName) -> Result<event::PortFactory<ipc::Service>, String> {
    let builder = node.service_builder(name).event();
    builder
        .max_notifiers(NODES)
        .max_listeners(NODES)
        .max_nodes(NODES)
        .open_or_create()
        .map_err(|error| format!("{error:?}"))
}
