//! The node core: what each event leads to.

use crate::channel::Channel;
use crate::downlink::{Downlink, STREAM};
use crate::interface::{COMMANDS, DIAGNOSTICS, EMERGENCY_STOP, RUN_STATE};
use crate::robot::{Dated, Robot};
use crate::run::Run;
use crate::settings::Tuning;
use crate::stop::{EmergencyStop, News};
use crate::welcome::Hellos;
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Health, Interface, Level, Master, NodeCore, Refusals, RosTime, Sink, Source, Steady, Times};
use trench_msgs::Message;
use trench_msgs::cdr::CdrError;
use trench_msgs::geometry_msgs::{Twist, TwistStamped};
use trench_msgs::msg::{Identify, RunState};
use trench_msgs::std_msgs::Bool;
use trench_radio::{ErrorCounts, RelayList, StreamDecoder};

/// What that means, and the remedy.
pub(crate) const NO_KEY: &str = "anybody on the channel can drive the robots; make one with `(umask 077; openssl rand \
    -hex 16 > key)` and give it to bridge and robots";

/// Between two looks at how things are, s.
const LOOK: f64 = 0.1;

/// The bridge.
pub struct RfBridge {
    pub(crate) interface: Interface,
    pub(crate) tuning: Tuning,
    pub(crate) ranges: usize,
    /// What is wrong where the line is too slow for so many robots.
    pub(crate) shortage: Option<String>,
    pub(crate) stamped: bool,
    pub(crate) robots: Vec<Robot>,
    pub(crate) downlink: Downlink,
    /// The host's clock when the node was made.
    pub(crate) wall: RosTime,
    pub(crate) decoder: StreamDecoder,
    pub(crate) errors: ErrorCounts,
    /// Whether the air loses more than it does by chance.
    pub(crate) channel: Channel,
    /// Who passed the last packet on.
    pub(crate) relays: RelayList,
    pub(crate) hellos: Hellos,
    pub(crate) open: bool,
    /// When the base station answered last; or when the port was opened.
    pub(crate) answered: Option<Steady>,
    pub(crate) run: Run,
    /// Who writes /identify.
    pub(crate) localizer: Master,
    /// The robot that is being told apart, and when that was heard.
    pub(crate) turning: Option<(usize, Steady)>,
    pub(crate) stop: EmergencyStop,
    pub(crate) reset_until: Option<Steady>,
    /// When the frame that is being gathered goes out.
    pub(crate) gathered_at: Option<Steady>,
    pub(crate) heartbeat_at: Steady,
    pub(crate) repeat_at: Option<Steady>,
    pub(crate) looked_at: Option<Steady>,
    pub(crate) refusals: Refusals,
    pub(crate) health: Health,
}

impl RfBridge {
    fn take(
        &mut self,
        at: Times,
        port: usize,
        source: Source,
        cdr: &[u8],
        sink: &mut dyn Sink,
    ) -> Result<(), CdrError> {
        match port {
            RUN_STATE => {
                let was_running = self.run.is_running();
                self.run.hear(source.gid, &RunState::decode(cdr)?);
                self.rest_unless_running(at, was_running, sink);
                if self.run.is_disputed() {
                    let text =
                        "publishers of /run_state contradict each other: another publisher says that nothing runs";
                    self.refusals.tell(at.steady, port, text.to_owned(), &mut self.health, sink);
                }
            }
            EMERGENCY_STOP => match self.stop.hear(source.gid, Bool::decode(cdr)?.data) {
                Some(News::Begins) => self.begin_stop(at, sink),
                Some(News::Words) => self.checkpoint(sink),
                None => {}
            },
            _ if port == COMMANDS + self.robots.len() => {
                let message = Identify::decode(cdr)?;
                match self.localizer.admit(source, at.steady) {
                    Ok(()) => self.hear_identify(at, &message),
                    Err(error) => {
                        self.refusals.tell_dropped(at.steady, (&self.interface, port), error, &mut self.health, sink);
                    }
                }
            }
            _ => {
                let (twist, dated) = if self.stamped {
                    let command = TwistStamped::decode(cdr)?;
                    (command.twist, Dated::Stamp((&command.header.stamp).into()))
                } else {
                    // What waited while nobody read it is older than it looks.
                    let age = self.tuning.unstamped_age + self.channel.held_up(at.steady, self.tuning.heartbeat);
                    (Twist::decode(cdr)?, Dated::Age(age))
                };
                let Some(robot) = self.robots.get_mut(port - COMMANDS) else { return Ok(()) };
                match robot.accept(at, source, &twist, dated, &self.tuning) {
                    Ok(()) => self.gather(at, sink),
                    Err(refusal) => {
                        let text = format!("a command for {} was dropped: {refusal}", robot.name);
                        self.refusals.tell(at.steady, port, text, &mut self.health, sink);
                    }
                }
            }
        }
        Ok(())
    }

    /// What anybody said of the run may have changed.
    fn rest_unless_running(&mut self, at: Times, was_running: bool, sink: &mut dyn Sink) {
        if was_running && !self.run.is_running() {
            self.halt(at, sink);
        }
    }

    fn wake(&mut self, at: Times, sink: &mut dyn Sink) {
        if self.repeat_at.is_some_and(|due| due <= at.steady) {
            self.repeat(at, sink);
        }
        if self.hellos.due.is_some_and(|due| due <= at.steady) {
            self.welcome(at, sink);
        }
        if self.gathered_at.is_some_and(|due| due <= at.steady) || self.heartbeat_at <= at.steady {
            self.broadcast(at, sink);
        }
    }

    /// Looks now and then how things are: while commands flow no heartbeat does.
    fn look(&mut self, at: Times, sink: &mut dyn Sink) {
        if self.looked_at.is_none_or(|looked| at.steady.seconds_since(looked) >= LOOK) {
            self.looked_at = Some(at.steady);
            self.tell_silence(at, sink);
            self.diagnose(at.steady);
        }
    }

    fn stream(&mut self, at: Times, open: bool, sink: &mut dyn Sink) {
        self.open = open;
        self.answered = Some(at.steady);
        self.decoder.reset();
        if open {
            sink.log(Level::Info, "the serial port is open");
            self.halt(at, sink);
            self.repeat(at, sink);
        } else {
            sink.log(Level::Error, "the serial port is gone: the robots stop by themselves");
            self.robots.iter_mut().for_each(Robot::halt);
        }
        self.diagnose(at.steady);
    }
}

impl NodeCore for RfBridge {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        self.channel.attend(at.steady);
        match event {
            Event::Started => {
                self.downlink.start(at, self.wall);
                if self.downlink.key().is_none() {
                    sink.log(Level::Info, &format!("key_file names no key: {NO_KEY}"));
                }
                if let Some(shortage) = &self.shortage {
                    sink.log(Level::Warn, shortage);
                }
                self.heartbeat_at = at.steady.plus_seconds(self.tuning.heartbeat);
                self.stop.start(at.steady);
                if self.stop.active() {
                    self.begin_stop(at, sink);
                }
            }
            Event::Message { port, source, cdr, .. } => {
                if let Err(error) = self.take(at, port, source, cdr, sink) {
                    self.refusals.tell_dropped(at.steady, (&self.interface, port), error, &mut self.health, sink);
                }
            }
            Event::Request { service, id, .. } => {
                let response = self.reset(at, sink);
                sink.respond(service, id, &response);
            }
            Event::Bytes { stream: STREAM, data } => self.hear(at, data, sink),
            Event::StreamState { stream: STREAM, open } => self.stream(at, open, sink),
            Event::Matched { port: EMERGENCY_STOP, writers } => {
                self.stop.writers(writers, at.steady);
                if self.stop.reached_for(at.steady) {
                    self.halt(at, sink);
                    self.diagnose(at.steady);
                }
            }
            Event::Presence { port: RUN_STATE, gid, is_there } => {
                let was_running = self.run.is_running();
                self.run.presence(gid, is_there);
                self.rest_unless_running(at, was_running, sink);
            }
            Event::Presence { port: EMERGENCY_STOP, gid, is_there } => self.stop.presence(gid, is_there),
            Event::Wakeup => self.wake(at, sink),
            Event::Shutdown => {
                self.run.forget();
                self.halt(at, sink);
            }
            _ => {}
        }
        self.look(at, sink);
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        [Some(self.heartbeat_at), self.gathered_at, self.repeat_at, self.hellos.due].into_iter().flatten().min()
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.tuning = Tuning::read(parameters)?;
        Ok(())
    }
}
