//! A node in the serial line: hands on what passes, and notes when frames and commands pass.
//!
//! Frames and bytes wake the same event loop, so what a wake-up takes is in both times and drops out of their
//! difference. A frame's answer is the first frame of the bridge after it; the line's own time for the bytes, which a
//! pseudo-terminal does not take, is added for the last of them.

use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    ByteStream, Event, Files, Interface, NodeContext, NodeCore, NodeDescription, Qos, Sink, StartError, Steady,
    Subscribe, Times,
};
use trench_msgs::Message;
use trench_msgs::msg::RunState;
use trench_msgs::sensor_msgs::Image;

pub(super) const DESCRIPTION: NodeDescription =
    NodeDescription { name: "command_latency", about: "Times commands against camera frames", parameters, build };

const BAUD: u32 = 115_200;

/// Microseconds that a byte takes: ten bits.
const BYTE_TIME: f64 = 1e7 / BAUD as f64;

const FRAMES: usize = 0;
const RUN_STATE: usize = 1;

/// The test bed's end of the line.
const LINE: usize = 0;
/// The bridge's end.
const TAP: usize = 1;

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::string("line", "", "the test bed's serial port").read_only(),
        ParameterDescriptor::string("tap", "", "where the bridge's serial port is made").read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let interface = Interface {
        subscriptions: vec![
            // Told when it was published; to wake for it would delay the localizer.
            Subscribe::to::<Image>("/overhead/image_raw", Qos::SENSOR).without_waking(),
            Subscribe::to::<RunState>("/run_state", Qos::LATCHED),
        ],
        byte_streams: vec![
            ByteStream::Serial { path: parameters.str("line")?.to_owned(), baud: BAUD },
            ByteStream::PseudoTerminal { link: parameters.str("tap")?.to_owned() },
        ],
        ..Interface::default()
    };
    Ok(Box::new(Probe { interface, running: false, frame: None, frames: 0, first: Vec::new(), last: Vec::new() }))
}

struct Probe {
    interface: Interface,
    running: bool,
    /// When the newest frame came, until it is answered.
    frame: Option<Steady>,
    /// Frames while the formation is running.
    frames: usize,
    /// Microseconds from a frame to the first byte of its answer.
    first: Vec<f64>,
    /// Microseconds until the last byte would be through a real line.
    last: Vec<f64>,
}

impl Probe {
    fn hear_bridge(&mut self, at: Steady, data: &[u8]) {
        if let Some(frame) = self.frame.take() {
            let microseconds = at.seconds_since(frame) * 1e6;
            self.first.push(microseconds);
            self.last.push(microseconds + BYTE_TIME * data.len() as f64);
        }
    }

    fn report(&mut self) {
        println!("{} of {} frames answered before the next", self.first.len(), self.frames);
        for (what, times) in [("first byte", &mut self.first), ("last byte", &mut self.last)] {
            times.sort_unstable_by(f64::total_cmp);
            let percentile =
                |share: usize| times.get(times.len().saturating_sub(1) * share / 1000).unwrap_or(&f64::NAN);
            let [p50, p90, p99, max] = [500, 900, 990, 1000].map(percentile);
            println!("{what}: p50 {p50:.0} us, p90 {p90:.0} us, p99 {p99:.0} us, max {max:.0} us");
        }
    }
}

impl NodeCore for Probe {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Message { port: FRAMES, arrived, .. } if self.running => {
                self.frames += 1;
                // From its publication, however late this process woke.
                self.frame = Some(arrived.unwrap_or(at.steady));
            }
            Event::Message { port: RUN_STATE, cdr, .. } => {
                self.running = RunState::decode(cdr).is_ok_and(|state| state.state == RunState::RUNNING);
                self.frame = None;
            }
            Event::Bytes { stream: TAP, data } => {
                sink.write_bytes(LINE, data);
                self.hear_bridge(at.steady, data);
            }
            Event::Bytes { stream: LINE, data } => sink.write_bytes(TAP, data),
            Event::Shutdown => self.report(),
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        None
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}
