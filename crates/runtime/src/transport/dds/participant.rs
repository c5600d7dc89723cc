//! A process's place on the network: one DDS participant for all its nodes.

use super::announcements::{Announced, Announcements};
use super::graph::{Endpoint, Graph};
use super::pause::{FIRST_STOP, Pause};
use super::raw::{RawAdapter, RawMessage};
use super::status::StatusReader;
use super::{DdsClient, DdsName, DdsReader, DdsServer, DdsWriter, Images, qos};
use crate::transport::TransportError;
use crate::transport::network::{
    Gid, GraphWatch, Network, NetworkReader, NetworkWriter, ServiceClient, ServiceServer, TopicName,
};
use rustdds::dds::CreateError;
use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, GUID, Publisher, QosPolicies, QosPolicyBuilder, Subscriber, Topic,
};
use rustdds::{RTPSEntity, TopicKind};
use std::path::Path;
use std::time::{Duration, Instant};
use trench_core::Qos;
use trench_msgs::ServiceInfo;

/// The participant and what its nodes own.
pub(crate) struct Participant {
    /// Before the participant: this is dropped first, or the participant would wait for a thread that stands still.
    opening: Option<Opening>,
    /// Before the participant, too: nobody may hear of it after it has gone.
    _announcements: Option<Announcements>,
    participant: DomainParticipant,
    publisher: Publisher,
    subscriber: Subscriber,
    graph: Graph,
    /// Whether what is sent is protected: nothing of ours goes beside RustDDS then, which alone protects it.
    is_secured: bool,
}

/// How long it may take until a participant has announced itself; as a rule 0.1 s.
const ANNOUNCED: Duration = Duration::from_secs(1);

/// While endpoints are opened.
struct Opening {
    pause: Pause,
    /// How many were opened in this pause.
    endpoints: usize,
}

/// How many endpoints may be opened in one pause of discovery: RustDDS keeps 1024 notes of what it has to announce, two for
/// each endpoint, and forgets what is above.
const AT_ONCE: usize = 200;
/// How long discovery then works off these notes.
const BREATH: Duration = Duration::from_millis(30);

impl Participant {
    /// Joins a ROS domain, as the `enclave` in this folder if there is one.
    pub(crate) fn join(domain: u16, enclave: Option<&Path>) -> Result<Self, TransportError> {
        let fail = |error: CreateError| match enclave {
            None => TransportError::Participant { domain, reason: error.to_string() },
            Some(folder) => {
                TransportError::Enclave { domain, folder: folder.display().to_string(), reason: error.to_string() }
            }
        };
        let mut announced = Announced::listen(domain);
        let pause = Pause::begin();
        let participant = builder(domain, enclave).build().map_err(fail)?;
        // It stops before it announces the participant, and where it hears that, or of others.
        let start = Instant::now();
        let announcement = loop {
            let is_held = pause.wait(FIRST_STOP);
            let own = announced.own(participant.guid());
            if own.is_some() || !is_held || !announced.can_hear() || start.elapsed() > ANNOUNCED {
                break own;
            }
            pause.step();
        };
        let no_thread = |source| TransportError::System { what: "cannot start a thread", source };
        let announcements = announcement.map(Announcements::begin).transpose().map_err(no_thread)?;
        let opening = Some(Opening { pause, endpoints: 0 });
        let defaults = QosPolicyBuilder::new().build();
        let publisher = participant.create_publisher(&defaults).map_err(fail)?;
        let subscriber = participant.create_subscriber(&defaults).map_err(fail)?;
        let graph = Graph::new(&participant, &publisher)?;
        let is_secured = enclave.is_some();
        Ok(Self { opening, _announcements: announcements, participant, publisher, subscriber, graph, is_secured })
    }

    /// Changes of the ROS graph, for the event loop.
    pub(crate) fn status(&self) -> Box<dyn GraphWatch> {
        Box::new(StatusReader::new(self.participant.status_listener()))
    }

    fn dds_writer(&mut self, node: &str, name: &DdsName, qos: Qos) -> Result<DdsWriter, TransportError> {
        Ok(DdsWriter::new(self.data_writer(node, name, qos::writer(qos))?, self.is_secured))
    }

    fn dds_reader(&mut self, node: &str, name: &DdsName, qos: Qos) -> Result<DdsReader, TransportError> {
        Ok(DdsReader::new(self.data_reader(node, name, qos::reader(qos))?))
    }

    fn data_writer(
        &mut self,
        node: &str,
        name: &DdsName,
        qos: QosPolicies,
    ) -> Result<DataWriter<RawMessage, RawAdapter>, TransportError> {
        self.breathe();
        let topic = self.topic(name, &qos)?;
        let writer = patiently(|| self.publisher.create_datawriter_no_key(&topic, Some(qos.clone())))
            .map_err(|error| TransportError::endpoint(&name.topic, &error))?;
        self.graph.add(node, Endpoint::Writer(writer.guid()));
        Ok(writer)
    }

    fn data_reader(
        &mut self,
        node: &str,
        name: &DdsName,
        qos: QosPolicies,
    ) -> Result<SimpleDataReader<RawMessage, RawAdapter>, TransportError> {
        self.breathe();
        let topic = self.topic(name, &qos)?;
        let reader = patiently(|| self.subscriber.create_simple_datareader_no_key(&topic, Some(qos.clone())))
            .map_err(|error| TransportError::endpoint(&name.topic, &error))?;
        self.graph.add(node, Endpoint::Reader(reader.guid()));
        Ok(reader)
    }

    /// Lets discovery go on for a moment where much was opened.
    fn breathe(&mut self) {
        let Some(opening) = &mut self.opening else { return };
        opening.endpoints += 1;
        if opening.endpoints > AT_ONCE {
            self.opening = None;
            std::thread::sleep(BREATH);
            let pause = Pause::begin();
            pause.wait(BREATH);
            self.opening = Some(Opening { pause, endpoints: 0 });
        }
    }

    fn topic(&self, name: &DdsName, qos: &QosPolicies) -> Result<Topic, TransportError> {
        self.participant
            .create_topic(name.topic.clone(), name.type_name.clone(), qos, TopicKind::NoKey)
            .map_err(|error| TransportError::endpoint(&name.topic, &error))
    }
}

#[cfg(feature = "dds-security")]
fn builder(domain: u16, enclave: Option<&Path>) -> DomainParticipantBuilder {
    use rustdds::DomainParticipantSecurityConfigFiles as Files;
    let builder = DomainParticipantBuilder::new(domain);
    // Keys of ROS 2's enclaves have no password.
    let secured = |folder: &Path| Files::with_ros_default_names(folder, String::new());
    match enclave.map(secured) {
        Some(files) => builder.builtin_security(files),
        None => builder,
    }
}

/// Without security in the build there is no enclave: [`crate::security`] refuses it.
#[cfg(not(feature = "dds-security"))]
fn builder(domain: u16, _enclave: Option<&Path>) -> DomainParticipantBuilder {
    DomainParticipantBuilder::new(domain)
}

/// How long RustDDS's thread may take to accept an endpoint.
const ACCEPTANCE: Duration = Duration::from_secs(5);

/// Opens an endpoint. RustDDS tells its thread of it through a channel of limited length and gives up where that is full:
/// many endpoints at once, on a busy machine, come faster than the thread takes them.
fn patiently<T>(open: impl Fn() -> Result<T, CreateError>) -> Result<T, CreateError> {
    let deadline = Instant::now() + ACCEPTANCE;
    loop {
        match open() {
            Err(error) if is_full(&error) && Instant::now() < deadline => std::thread::sleep(Duration::from_millis(2)),
            done => return done,
        }
    }
}

/// The only thing by which it can be told from a thread that has ended.
fn is_full(error: &CreateError) -> bool {
    error.to_string().contains("full channel")
}

impl Network for Participant {
    fn add_node(&mut self, namespace: &str, name: &str) -> Result<(), TransportError> {
        self.graph.add_node(namespace, name)
    }

    fn announce(&mut self) -> Result<(), TransportError> {
        self.graph.announce()?;
        self.opening = None;
        Ok(())
    }

    fn prepare_to_open(&mut self) {
        self.opening.get_or_insert_with(|| Opening { pause: Pause::begin(), endpoints: 0 });
    }

    fn is_prepared(&self) -> bool {
        self.opening.as_ref().is_some_and(|opening| opening.pause.wait(Duration::ZERO))
    }

    fn writer(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<Box<dyn NetworkWriter>, TransportError> {
        let writer = self.dds_writer(node, &DdsName::message(name.topic(), name.type_name()), qos)?;
        if self.is_secured {
            return Ok(Box::new(writer));
        }
        let images = Images::of(writer.guid(), qos, self.participant.clone());
        Ok(Box::new(writer.with_images(images)))
    }

    fn reader(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<Box<dyn NetworkReader>, TransportError> {
        Ok(Box::new(self.dds_reader(node, &DdsName::message(name.topic(), name.type_name()), qos)?))
    }

    fn share_reader(&mut self, node: &str, reader: Gid) {
        self.graph.add(node, Endpoint::Reader(GUID::from_bytes(reader)));
    }

    fn server(
        &mut self,
        node: &str,
        service: &str,
        info: ServiceInfo,
    ) -> Result<Box<dyn ServiceServer>, TransportError> {
        let requests = self.dds_reader(node, &DdsName::request(service, info.name), qos::SERVICE)?;
        let responses = self.dds_writer(node, &DdsName::response(service, info.name), qos::SERVICE)?;
        Ok(Box::new(DdsServer::new(requests, responses, self.participant.clone(), self.is_secured)))
    }

    fn client(
        &mut self,
        node: &str,
        service: &str,
        info: ServiceInfo,
    ) -> Result<Box<dyn ServiceClient>, TransportError> {
        let requests = self.dds_writer(node, &DdsName::request(service, info.name), qos::SERVICE)?;
        let responses = self.dds_reader(node, &DdsName::response(service, info.name), qos::SERVICE)?;
        Ok(Box::new(DdsClient::new(requests, responses)))
    }
}
