//! What a core is connected to.

use trench_msgs::{Message, Service, ServiceInfo, TypeInfo, service_info};

/// Whether lost samples are sent again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reliability {
    /// They are not: for streams of which only the newest matters.
    BestEffort,
    /// They are.
    Reliable,
}

/// Whether late joiners get what was sent before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Durability {
    /// They do not.
    Volatile,
    /// They get the last `depth` samples: a "latched" topic.
    TransientLocal,
}

/// Quality of service of one end of a topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Qos {
    /// Whether lost samples are sent again.
    pub reliability: Reliability,
    /// Whether late joiners get what was sent before.
    pub durability: Durability,
    /// How many samples are kept (keep last).
    pub depth: usize,
}

impl Qos {
    /// Newest only, loss allowed: images, scans.
    pub const SENSOR: Self = Self { reliability: Reliability::BestEffort, durability: Durability::Volatile, depth: 1 };
    /// Every sample, in order.
    pub const RELIABLE: Self = Self { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 16 };
    /// Late joiners get the last sample.
    pub const LATCHED: Self =
        Self { reliability: Reliability::Reliable, durability: Durability::TransientLocal, depth: 1 };
}

/// Which transports a publication uses besides the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Local {
    /// The network alone.
    NetworkOnly,
    /// Shared memory to readers of this host, the network to all others. `max_len`: the largest message in bytes.
    SharedMemory {
        /// Bytes to reserve for one message.
        max_len: usize,
    },
    /// Shared memory alone, unless the process is told to send it over the network too (images for viewers).
    SharedMemoryOnly {
        /// Bytes to reserve for one message.
        max_len: usize,
    },
}

impl Local {
    /// What a message of a robot's state, a command or a measurement surely fits in, bytes.
    pub const SMALL_LEN: usize = 1024;
    /// For such messages.
    pub const SMALL: Self = Self::SharedMemory { max_len: Self::SMALL_LEN };
}

/// A topic that the core reads.
#[derive(Debug, Clone)]
pub struct Subscribe {
    /// Absolute (`/team_state`), relative to the namespace (`cmd_vel`) or private (`~/x`); remapped by the process.
    pub topic: String,
    /// Its type.
    pub type_info: &'static TypeInfo,
    /// What this end asks for.
    pub qos: Qos,
    /// Whether a message wakes the node. Without, it is handed over before the next event that does: for what a core
    /// only uses then, so that twenty robots that tell each other where they are do not wake each other for it.
    pub wakes: bool,
    /// Whether the next message makes up for one that was lost, so that a process on a slow link may do without repetition.
    pub comes_again: bool,
}

impl Subscribe {
    /// A topic of messages `M`.
    pub fn to<M: Message>(topic: impl Into<String>, qos: Qos) -> Self {
        Self::of_type(topic, M::TYPE, qos)
    }

    /// A topic of messages of this type.
    pub fn of_type(topic: impl Into<String>, type_info: &'static TypeInfo, qos: Qos) -> Self {
        Self { topic: topic.into(), type_info, qos, wakes: true, comes_again: true }
    }

    /// The same, where each message counts by itself: it is repeated until it has come, over slow links too.
    #[must_use]
    pub fn once(self) -> Self {
        Self { comes_again: false, ..self }
    }

    /// The same, read with the next event that wakes the node. That must come soon: by a tick, or a timer of the node.
    #[must_use]
    pub fn without_waking(self) -> Self {
        Self { wakes: false, ..self }
    }
}

/// A topic that the core writes.
#[derive(Debug, Clone)]
pub struct Advertise {
    /// As in [`Subscribe`].
    pub topic: String,
    /// Its type.
    pub type_info: &'static TypeInfo,
    /// What this end offers.
    pub qos: Qos,
    /// Whether readers of the same host get it through shared memory.
    pub local: Local,
}

impl Advertise {
    /// A topic of messages `M`.
    pub fn of<M: Message>(topic: impl Into<String>, qos: Qos, local: Local) -> Self {
        Self { topic: topic.into(), type_info: M::TYPE, qos, local }
    }
}

/// A topic that somebody in the graph writes.
#[derive(Debug, Clone, Copy)]
pub struct Discovered<'a> {
    /// Absolute.
    pub topic: &'a str,
    /// For example `nav_msgs/msg/Odometry`.
    pub type_name: &'a str,
    /// The type's RIHS01 hash; empty where the writer does not say it.
    pub type_hash: &'a str,
    /// What the writer offers.
    pub qos: Qos,
}

/// A service that the core answers, or calls.
#[derive(Debug, Clone)]
pub struct Serve {
    /// As a topic's name; `~/arm` is usual.
    pub name: String,
    /// Its type.
    pub service: ServiceInfo,
}

impl Serve {
    /// A service `S`.
    pub fn of<S: Service>(name: impl Into<String>) -> Self {
        Self { name: name.into(), service: service_info::<S>() }
    }
}

/// A line of bytes in and out.
#[derive(Debug, Clone)]
pub enum ByteStream {
    /// A serial device (or the slave of a pseudo-terminal). It may vanish and come back: the process reopens it.
    Serial {
        /// The device file.
        path: String,
        /// Bits per second.
        baud: u32,
    },
    /// A new pseudo-terminal, of which the core is the master; a link to the slave is made at `link`.
    PseudoTerminal {
        /// Where the link to the slave goes.
        link: String,
    },
    /// The keys pressed in the terminal that the process was started from, each at once and without its echo.
    Keyboard,
    /// What somebody writes to the process's standard input, a pipe; it breaks when they have gone.
    StandardInput,
}

/// All that a core is connected to. Indices into these lists are what [`crate::Event`] and [`crate::Sink`] name.
#[derive(Debug, Clone, Default)]
pub struct Interface {
    /// Topics read.
    pub subscriptions: Vec<Subscribe>,
    /// Topics written.
    pub publications: Vec<Advertise>,
    /// Services answered.
    pub services: Vec<Serve>,
    /// Services called.
    pub clients: Vec<Serve>,
    /// Byte streams.
    pub byte_streams: Vec<ByteStream>,
}
