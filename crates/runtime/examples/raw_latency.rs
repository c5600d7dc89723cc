//! The measurement of the example `latency` without Trench: iceoryx2, RustDDS and Zenoh as their own users would use them.
//! Start it twice: `raw_latency iceoryx2 probe`, then `raw_latency iceoryx2 source`; `--bytes N --rate R --count N`.

use clap::{Parser, ValueEnum};
use rustix::time::{ClockId, clock_gettime};
use std::error::Error;
use std::time::{Duration, Instant};

#[derive(Parser)]
struct Arguments {
    peer: Peer,
    role: Role,
    #[arg(long, default_value_t = 64)]
    bytes: usize,
    #[arg(long, default_value_t = 200.0)]
    rate: f64,
    #[arg(long, default_value_t = 1000)]
    count: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum Peer {
    Iceoryx2,
    Rustdds,
    Zenoh,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Role {
    Source,
    Probe,
}

type Anything = Result<(), Box<dyn Error>>;

fn main() -> Anything {
    let arguments = Arguments::parse();
    match arguments.peer {
        Peer::Iceoryx2 => iceoryx2_peer(&arguments),
        Peer::Rustdds => rustdds_peer(&arguments),
        Peer::Zenoh => zenoh_peer(&arguments),
    }
}

/// The monotonic clock, which all processes of a host share, ns.
fn now() -> u64 {
    let time = clock_gettime(ClockId::Monotonic);
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

/// Writes a stamp into the front of a message.
fn stamp(message: &mut [u8]) {
    message[..8].copy_from_slice(&now().to_le_bytes());
}

/// Calls `send` with a message at the rate asked for, until the process is killed.
fn pace(arguments: &Arguments, mut send: impl FnMut() -> Anything) -> Anything {
    let mut due = Instant::now();
    loop {
        due += Duration::from_secs_f64(1.0 / arguments.rate);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
        send()?;
    }
}

/// What came in.
struct Taken {
    nanoseconds: Vec<u64>,
    count: usize,
    /// When the first came, ns.
    first: Option<u64>,
}

impl Taken {
    fn new(arguments: &Arguments) -> Self {
        Self { nanoseconds: Vec::new(), count: arguments.count, first: None }
    }

    fn take(&mut self, message: &[u8]) {
        let stamp = message.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
        let now = now();
        let first = *self.first.get_or_insert(now);
        self.nanoseconds.push(now.saturating_sub(stamp));
        if self.nanoseconds.len() == self.count {
            self.nanoseconds.sort_unstable();
            let percentile = |share: usize| self.nanoseconds[(self.count - 1) * share / 1000] as f64 * 1e-3;
            let [p50, p99, max] = [500, 990, 1000].map(percentile);
            let rate = (self.count - 1) as f64 * 1e9 / (now - first) as f64;
            println!("p50 {p50:.1} us, p99 {p99:.1} us, max {max:.1} us, {rate:.0} a second");
            std::process::exit(0);
        }
    }
}

/// A slice service and an event service; the probe blocks on the event.
fn iceoryx2_peer(arguments: &Arguments) -> Anything {
    use iceoryx2::prelude::*;
    let node = NodeBuilder::new().create::<ipc::Service>()?;
    let name: ServiceName = "raw_latency".try_into()?;
    let topic = node.service_builder(&name).publish_subscribe::<[u8]>().subscriber_max_buffer_size(16);
    let topic = topic.enable_safe_overflow(true).open_or_create()?;
    let event = node.service_builder(&name).event().open_or_create()?;
    if arguments.role == Role::Source {
        let publisher = topic.publisher_builder().initial_max_slice_len(arguments.bytes).create()?;
        let notifier = event.notifier_builder().create()?;
        let mut message = vec![0; arguments.bytes];
        return pace(arguments, || {
            stamp(&mut message);
            publisher.loan_slice_uninit(message.len())?.write_from_slice(&message).send()?;
            notifier.notify()?;
            Ok(())
        });
    }
    let subscriber = topic.subscriber_builder().buffer_size(16).create()?;
    let listener = event.listener_builder().create()?;
    let mut taken = Taken::new(arguments);
    loop {
        listener.blocking_wait(|_| {})?;
        while let Some(sample) = subscriber.receive()? {
            taken.take(sample.payload());
        }
    }
}

/// Bytes as RustDDS's own CDR adapters write them.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Stamps {
    #[serde(with = "serde_bytes")]
    data: Vec<u8>,
}

/// A reliable topic without a key; the probe waits in mio.
fn rustdds_peer(arguments: &Arguments) -> Anything {
    use rustdds::mio1::{Events, Interest, Poll, Token};
    use rustdds::policy::{History, Reliability};
    use rustdds::{DomainParticipantBuilder, QosPolicyBuilder, TopicKind};
    let domain = std::env::var("ROS_DOMAIN_ID").ok().and_then(|domain| domain.parse().ok()).unwrap_or(0);
    let participant = DomainParticipantBuilder::new(domain).build()?;
    let qos = QosPolicyBuilder::new()
        .reliability(Reliability::Reliable { max_blocking_time: rustdds::Duration::from_millis(100) })
        .history(History::KeepLast { depth: 16 })
        .build();
    let topic = participant.create_topic("raw_latency".to_owned(), "Stamps".to_owned(), &qos, TopicKind::NoKey)?;
    if arguments.role == Role::Source {
        let writer = participant.create_publisher(&qos)?.create_datawriter_no_key_cdr::<Stamps>(&topic, None)?;
        return pace(arguments, || {
            let mut message = Stamps { data: vec![0; arguments.bytes] };
            stamp(&mut message.data);
            writer.write(message, None).map_err(|error| format!("{error:?}"))?;
            Ok(())
        });
    }
    let mut reader = participant.create_subscriber(&qos)?.create_datareader_no_key_cdr::<Stamps>(&topic, None)?;
    let mut poll = Poll::new()?;
    poll.registry().register(&mut reader, Token(0), Interest::READABLE)?;
    let (mut events, mut taken) = (Events::with_capacity(8), Taken::new(arguments));
    loop {
        poll.poll(&mut events, None)?;
        while let Some(sample) = reader.take_next_sample()? {
            taken.take(&sample.value().data);
        }
    }
}

/// Two peers with a link of their own; the probe measures in Zenoh's callback.
fn zenoh_peer(arguments: &Arguments) -> Anything {
    use zenoh::Wait;
    let mut config = zenoh::Config::default();
    let (own, other) = if arguments.role == Role::Probe { ("listen", "connect") } else { ("connect", "listen") };
    let set = |config: &mut zenoh::Config, key: &str, value: &str| {
        config.insert_json5(key, value).map_err(|error| error.to_string())
    };
    set(&mut config, &format!("{own}/endpoints"), "[\"tcp/127.0.0.1:7999\"]")?;
    set(&mut config, &format!("{other}/endpoints"), "[]")?;
    set(&mut config, "scouting/multicast/enabled", "false")?;
    let session = zenoh::open(config).wait().map_err(|error| error.to_string())?;
    if arguments.role == Role::Source {
        let publisher = session.declare_publisher("raw_latency").wait().map_err(|error| error.to_string())?;
        return pace(arguments, || {
            let mut message = vec![0; arguments.bytes];
            stamp(&mut message);
            Ok(publisher.put(message).wait().map_err(|error| error.to_string())?)
        });
    }
    let taken = std::sync::Mutex::new(Taken::new(arguments));
    let hear = move |sample: zenoh::sample::Sample| {
        if let Ok(mut taken) = taken.lock() {
            taken.take(&sample.payload().to_bytes());
        }
    };
    let _subscriber =
        session.declare_subscriber("raw_latency").callback(hear).wait().map_err(|error| error.to_string())?;
    loop {
        std::thread::park();
    }
}
