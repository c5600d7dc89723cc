//! The shared-memory end of a publication.

use super::Header;
use super::host::Topic;
use super::limits::{Limits, NODES};
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::prelude::{AllocationStrategy, Node, ServiceName, ipc};
use iceoryx2::service::port_factory::event;
use trench_core::{Durability, Qos, Source};

/// Writes messages into memory that the readers see.
pub(crate) struct SharedWriter {
    publisher: Publisher<ipc::Service, [u8], Header>,
    notifier: Notifier<ipc::Service>,
}

impl SharedWriter {
    pub(super) fn new(node: &Node<ipc::Service>, name: &ServiceName, max_len: usize, qos: Qos) -> Result<Self, String> {
        let publisher = topic(node, name, Limits::of(max_len, qos), qos)?
            .publisher_builder()
            .initial_max_slice_len(max_len.max(1))
            .allocation_strategy(AllocationStrategy::PowerOfTwo)
            .create()
            .map_err(|error| format!("{error:?}"))?;
        let notifier = wakeups(node, name)?.notifier_builder().create().map_err(|error| format!("{error:?}"))?;
        Ok(Self { publisher, notifier })
    }

    /// Publishes what `fill` writes into at most `max_len` loaned bytes, giving its length; `copy` sees the message
    /// once more before the readers do.
    pub(crate) fn publish_with(
        &self,
        source: Source,
        max_len: usize,
        fill: &mut dyn FnMut(&mut [u8]) -> usize,
        copy: impl FnOnce(&[u8]),
    ) -> Result<(), String> {
        let loan = self.publisher.loan_slice_uninit(max_len.max(1)).map_err(|error| format!("{error:?}"))?;
        #[expect(
            unsafe_code,
            reason = "the loan is mapped shared memory: every byte has a value, and every value is a u8"
        )]
        let mut sample = unsafe { loan.assume_init() };
        let length = fill(&mut sample.payload_mut()[..max_len]).min(max_len);
        *sample.user_header_mut() = Header { gid: source.gid, sequence: source.sequence, length: length as u64 };
        copy(&sample.payload()[..length]);
        sample.send().map_err(|error| format!("{error:?}"))?;
        // A reader that died without a word cannot be woken; the others have been.
        let _partly = self.notifier.notify();
        Ok(())
    }
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
