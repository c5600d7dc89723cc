//! Measures the way from one core to another on this host: start it twice, first with `-p role:=probe`, then with
//! `-p role:=source`. The probe prints percentiles of the time from the source's wake-up to the probe's core, and how many came a second:
//! with a `rate` beyond what is possible, how many can.

use std::process::ExitCode;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, Sink, StartError, Steady,
    Subscribe, Times,
};
use trench_msgs::Message;
use trench_msgs::std_msgs::UInt64;

const LATENCY: NodeDescription =
    NodeDescription { name: "latency", about: "Measures the way between two cores.", parameters, build };

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::string("role", "probe", "source or probe").read_only(),
        ParameterDescriptor::bool("shared_memory", true, "whether the source uses it").read_only(),
        ParameterDescriptor::bool(
            "network",
            true,
            "whether shared memory's messages go over the network, too: images do not",
        )
        .read_only(),
        ParameterDescriptor::bool("best_effort", false, "messages may be lost, as images may").read_only(),
        ParameterDescriptor::integer("bytes", 12, "length of a message: a stamp and zeros")
            .range(12.0, 1.0e7)
            .read_only(),
        ParameterDescriptor::double("rate", 200.0, "wake-ups of the source a second").range(1.0, 1.0e7).read_only(),
        ParameterDescriptor::integer("burst", 1, "messages at each wake-up").range(1.0, 1.0e4).read_only(),
        ParameterDescriptor::integer(
            "skip",
            0,
            "messages before the first that is measured: nodes find one another meanwhile",
        )
        .range(0.0, 1.0e7)
        .read_only(),
        ParameterDescriptor::integer("count", 2000, "messages to measure").range(1.0, 1.0e7).read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let topic = "/stamps".to_owned();
    let bytes = parameters.usize("bytes")?;
    let local = match (parameters.bool("shared_memory")?, parameters.bool("network")?) {
        (true, true) => Local::SharedMemory { max_len: bytes },
        (true, false) => Local::SharedMemoryOnly { max_len: bytes },
        (false, _) => Local::NetworkOnly,
    };
    let mut interface = Interface::default();
    let qos = if parameters.bool("best_effort")? { Qos::SENSOR } else { Qos::RELIABLE };
    let source = parameters.str("role")? == "source";
    if source {
        interface.publications = vec![Advertise { topic, type_info: UInt64::TYPE, qos, local }];
    } else {
        interface.subscriptions = vec![Subscribe::to::<UInt64>(topic, qos)];
    }
    let period = 1.0 / parameters.f64("rate")?;
    let next = source.then_some(Steady(0));
    Ok(Box::new(Latency {
        interface,
        period,
        burst: parameters.usize("burst")?,
        next,
        message: vec![0; bytes],
        skip: parameters.usize("skip")?,
        count: parameters.usize("count")?,
        nanoseconds: Vec::new(),
        first: None,
    }))
}

struct Latency {
    interface: Interface,
    period: f64,
    burst: usize,
    next: Option<Steady>,
    message: Vec<u8>,
    skip: usize,
    count: usize,
    nanoseconds: Vec<u64>,
    /// When the first that is measured came.
    first: Option<Steady>,
}

impl Latency {
    /// A CDR message that begins with the time: what else is in it matters to nobody.
    fn say(&mut self, at: Steady, sink: &mut dyn Sink) {
        let stamp = at.0.to_le_bytes();
        let message = &mut self.message;
        message[..4].copy_from_slice(&[0, 1, 0, 0]);
        message[4..12].copy_from_slice(&stamp);
        sink.publish_with(0, message.len(), &mut |loan| {
            loan.copy_from_slice(message);
            message.len()
        });
    }

    fn measure(&mut self, at: Times, cdr: &[u8], sink: &mut dyn Sink) {
        let Ok(stamp) = UInt64::decode(cdr) else { return };
        if self.skip > 0 {
            self.skip -= 1;
            return;
        }
        let first = *self.first.get_or_insert(at.steady);
        self.nanoseconds.push(at.steady.0.saturating_sub(stamp.data));
        if self.nanoseconds.len() == self.count {
            self.nanoseconds.sort_unstable();
            let percentile = |share: usize| self.nanoseconds[(self.count - 1) * share / 1000] as f64 * 1e-3;
            let [p50, p99, max] = [500, 990, 1000].map(percentile);
            let rate = (self.count - 1) as f64 / at.steady.seconds_since(first);
            println!("p50 {p50:.0} us, p99 {p99:.0} us, max {max:.0} us, {rate:.0} a second");
            sink.exit(0);
        }
    }
}

impl NodeCore for Latency {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Wakeup => {
                for _ in 0..self.burst {
                    self.say(at.steady, sink);
                }
                self.next = Some(at.steady.plus_seconds(self.period));
            }
            Event::Message { cdr, .. } => self.measure(at, cdr, sink),
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.next
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

fn main() -> ExitCode {
    trench_runtime::run(LATENCY)
}
