//! All cores in one process, one event at a time, as fast as the machine goes.
//!
//! Time stands still while events are handled: what a core publishes arrives at its readers at the same instant, in the
//! order of publication. Between instants time jumps to the earliest wakeup. Two runs are equal byte for byte.

mod outlet;

use crate::bus::{Bus, BusError, Delivery, End};
use outlet::{Outlet, Outlets};
use trench_core::arguments::{Names, Remap};
use trench_core::{Advertise, ByteStream, Event, Level, NodeCore, RosTime, Source, Steady, Times};

/// ROS time at the start of a run: 2020-01-01, so that stamps look like stamps.
const EPOCH: RosTime = RosTime(1_577_836_800_000_000_000);

/// A core with its place in the graph.
pub struct Instance {
    /// The name its executable gives it.
    pub default_name: String,
    /// Its `-r` rules: name, namespace, topics and services.
    pub remaps: Vec<Remap>,
    /// The core.
    pub core: Box<dyn NodeCore>,
}

/// What happens in a run, for whoever records or shows it.
pub trait Observer {
    /// A message went out on `topic`.
    fn published(&mut self, at: Times, topic: &str, advertise: &Advertise, source: Source, cdr: &[u8]);
    /// A node said something.
    fn logged(&mut self, at: Times, node: &str, level: Level, text: &str);
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ending {
    /// A core asked for the end with this code.
    Exit {
        /// Which node.
        node: String,
        /// Its exit code.
        code: u8,
    },
    /// The time given was over.
    TimeOver,
    /// No core wants to wake up again.
    Silence,
}

struct Seat {
    core: Box<dyn NodeCore>,
    outlets: Outlets,
    ended: bool,
}

/// A lock-step run.
pub struct Lockstep {
    seats: Vec<Seat>,
    bus: Bus,
    now: Steady,
    /// Where messages are written; what is in it is of no interest afterwards.
    scratch: Vec<u8>,
    ended: Option<Ending>,
}

/// Events handled at one instant before the run is called a livelock: cores that answer each other for ever.
const EVENTS_AN_INSTANT: usize = 1_000_000;

impl Lockstep {
    /// Connects the cores.
    ///
    /// # Errors
    /// When two nodes use one topic with different types.
    pub fn new(instances: Vec<Instance>) -> Result<Self, BusError> {
        let mut run = Self {
            seats: Vec::new(),
            bus: Bus::default(),
            now: Steady(1_000_000_000),
            scratch: Vec::new(),
            ended: None,
        };
        for (index, instance) in instances.into_iter().enumerate() {
            run.seat(index, instance)?;
        }
        run.plug();
        Ok(run)
    }

    fn seat(&mut self, index: usize, instance: Instance) -> Result<(), BusError> {
        let names = Names::new(&instance.remaps, &instance.default_name);
        let interface = instance.core.interface();
        let topics = self.bus.join(index, &names, interface)?;
        let outlets = Outlets::new(index, &names, interface, topics);
        self.seats.push(Seat { core: instance.core, outlets, ended: false });
        Ok(())
    }

    fn plug(&mut self) {
        for (instance, seat) in self.seats.iter().enumerate() {
            for (index, stream) in seat.core.interface().byte_streams.iter().enumerate() {
                if let ByteStream::Serial { path, .. } = stream {
                    self.bus.plug(End { instance, index }, path);
                }
            }
        }
        self.bus.announce();
    }

    /// The present instant.
    #[must_use]
    pub fn times(&self) -> Times {
        Times { ros: RosTime(EPOCH.0 + self.now.0 as i64), steady: self.now }
    }

    /// Runs until a core asks for the end, or `seconds` of simulated time are over.
    pub fn run(&mut self, seconds: f64, observer: &mut dyn Observer) -> Ending {
        let end = self.now.plus_seconds(seconds);
        for index in 0..self.seats.len() {
            self.handle(index, Event::Started, observer);
        }
        loop {
            self.settle(observer);
            if let Some(ending) = self.ended.take() {
                return ending;
            }
            let next = self.seats.iter().enumerate().filter(|(_, seat)| !seat.ended);
            let next = next.filter_map(|(index, seat)| Some((seat.core.next_wakeup()?, index))).min();
            match next {
                None => return Ending::Silence,
                Some((when, _)) if when > end => return Ending::TimeOver,
                Some((when, index)) => {
                    self.now = self.now.max(when);
                    self.handle(index, Event::Wakeup, observer);
                }
            }
        }
    }

    /// Delivers everything that is due at this instant, and what comes of it.
    fn settle(&mut self, observer: &mut dyn Observer) {
        for _ in 0..EVENTS_AN_INSTANT {
            let Some(delivery) = self.bus.due.pop_front() else { return };
            match delivery {
                Delivery::Message { to, source, cdr } => {
                    self.handle(
                        to.instance,
                        Event::Message { port: to.index, source, cdr: &cdr, arrived: None },
                        observer,
                    );
                }
                Delivery::Request { to, id, cdr } => {
                    self.handle(to.instance, Event::Request { service: to.index, id, cdr: &cdr }, observer);
                }
                Delivery::Response { to, cdr } => {
                    let event = Event::Response { client: to.index, cdr: cdr.as_deref() };
                    self.handle(to.instance, event, observer);
                }
                Delivery::Bytes { to, data } => {
                    self.handle(to.instance, Event::Bytes { stream: to.index, data: &data }, observer);
                }
                Delivery::StreamState { to, open } => {
                    self.handle(to.instance, Event::StreamState { stream: to.index, open }, observer);
                }
                Delivery::Matched { to, writers } => {
                    self.handle(to.instance, Event::Matched { port: to.index, writers }, observer);
                }
            }
        }
        self.ended = Some(Ending::Silence);
    }

    fn handle(&mut self, index: usize, event: Event<'_>, observer: &mut dyn Observer) {
        let at = self.times();
        let seat = &mut self.seats[index];
        if seat.ended {
            return;
        }
        let (bus, scratch) = (&mut self.bus, &mut self.scratch);
        let mut outlet = Outlet { outlets: &mut seat.outlets, at, bus, scratch, observer, exit: None };
        seat.core.handle(at, event, &mut outlet);
        if let Some(code) = outlet.exit {
            seat.ended = true;
            self.ended = Some(Ending::Exit { node: seat.outlets.label.clone(), code });
        }
    }
}
