//! The shared-memory end of a subscription.

use super::{Header, identity};
use iceoryx2::port::DegradationAction;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::{FileDescriptorBased, Node, PortFactory, ServiceName, ipc};
use iceoryx2::sample::Sample;
use iceoryx2::service::builder::event::EventOpenError;
use iceoryx2::service::builder::publish_subscribe::PublishSubscribeOpenError;
use rustdds::mio1::unix::SourceFd;
use rustdds::mio1::{Interest, Registry, Token};
use trench_core::{Durability, Qos, Reliability, Source, Steady};

/// Reads messages where their writer wrote them.
pub(crate) struct SharedReader {
    subscriber: Subscriber<ipc::Service, [u8], Header>,
    /// What its writers wake it by; none where nobody waits for its messages, so that they cost no system call.
    listener: Option<Listener<ipc::Service>>,
}

/// A message in shared memory, which stays there as long as this lives.
pub(crate) struct SharedSample(Sample<ipc::Service, [u8], Header>);

impl SharedReader {
    pub(super) fn open(
        node: &Node<ipc::Service>,
        name: &ServiceName,
        qos: Qos,
        gid: [u8; 16],
        registry: &Registry,
        token: Option<Token>,
    ) -> Result<Option<Self>, String> {
        let topic = match node.service_builder(name).publish_subscribe::<[u8]>().user_header::<Header>().open() {
            Ok(topic) => topic,
            Err(PublishSubscribeOpenError::DoesNotExist) => return Ok(None),
            Err(error) => return Err(format!("{error:?}")),
        };
        let wakeups = match token.map(|token| (token, node.service_builder(name).event().open())) {
            Some((token, Ok(wakeups))) => Some((token, wakeups)),
            Some((_, Err(EventOpenError::DoesNotExist))) => return Ok(None),
            Some((_, Err(error))) => return Err(format!("{error:?}")),
            None => None,
        };
        let history = if qos.durability == Durability::TransientLocal { qos.depth } else { 0 };
        let limits = topic.static_config();
        // A best-effort reader wants the newest samples alone.
        let newest = if qos.reliability == Reliability::BestEffort { qos.depth } else { usize::MAX };
        let subscriber = topic
            .subscriber_builder()
            .buffer_size(limits.subscriber_max_buffer_size().min(newest.max(history)))
            .history_request(history.min(limits.history_size()))
            .name(&identity::name(gid)?)
            // A writer that cannot be reached here must be heard over the network: silence would be worse.
            .set_degradation_handler(|_cause, _where| DegradationAction::DegradeAndFail)
            .create()
            .map_err(|error| format!("{error:?}"))?;
        let mut listener = None;
        if let Some((token, wakeups)) = wakeups {
            let made = wakeups.listener_builder().create().map_err(|error| format!("{error:?}"))?;
            registry
                .register(&mut SourceFd(&descriptor(&made)), token, Interest::READABLE)
                .map_err(|error| format!("cannot wait for it: {error}"))?;
            listener = Some(made);
        }
        Ok(Some(Self { subscriber, listener }))
    }

    /// Acknowledges the wake-up; to be called before taking, or a later arrival may go unnoticed.
    pub(crate) fn clear_wakeup(&self) {
        let _spurious = self.listener.as_ref().map(|listener| listener.try_wait(|_| {}));
    }

    /// The next message; `None` when all are taken.
    pub(crate) fn take(&self) -> Option<Result<SharedSample, String>> {
        match self.subscriber.receive() {
            Ok(sample) => sample.map(|sample| Ok(SharedSample(sample))),
            Err(error) => Some(Err(format!("{error:?}"))),
        }
    }
}

impl SharedSample {
    /// Writer and count.
    pub(crate) fn source(&self) -> Source {
        Source { gid: self.0.user_header().gid, sequence: self.0.user_header().sequence }
    }

    /// When it was written.
    pub(crate) fn written(&self) -> Steady {
        Steady(self.0.user_header().written)
    }

    /// The message, read in place.
    pub(crate) fn cdr(&self) -> &[u8] {
        let payload = self.0.payload();
        let length = usize::try_from(self.0.user_header().length).unwrap_or(usize::MAX);
        &payload[..length.min(payload.len())]
    }
}

fn descriptor(listener: &Listener<ipc::Service>) -> i32 {
    #[expect(unsafe_code, reason = "the descriptor is only waited for, and never outlives the listener")]
    unsafe {
        listener.file_descriptor().native_handle()
    }
}
