//! The event loop: one thread for all cores of a process.

use crate::clock::steady_now;
use crate::found::Found;
use crate::latency_request::LatencyRequest;
use crate::node::{Node, Wake};
use crate::priority::{take_turn, threads_wait_turn};
use crate::signals::Signals;
use crate::timer::Timer;
use crate::topics::Topics;
use crate::transport::network::{GraphChange, GraphWatch, Network};
use crate::transport::shared_memory::Host;
use crate::transport::{Backend, TransportError};
use crate::watchdog::Watchdog;
use rustdds::mio1::{Events, Interest, Poll, Token};
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};
use trench_core::{Discovered, Steady};

/// Tokens of the process's own sources; those of its nodes follow.
const STATUS: Token = Token(0);
const TIMER: Token = Token(1);
const SIGNALS: Token = Token(2);
const OWN_TOKENS: usize = 3;

/// How soon messages that the network did not take are offered again.
const FLUSH_SECONDS: f64 = 0.002;

/// How long after a node was woken what has come without waking is handed over, s, if nothing wakes it before: at leisure,
/// rather than at the next frame of the camera, when every robot waits.
const LEISURE_SECONDS: f64 = 0.004;

/// How long before the next frame is expected that is done, s, where frames come at regular times: this also brings back into caches
/// what the frame will need.
const AHEAD_SECONDS: f64 = 0.001;

/// How much later than expected it may come and still finds processors awake, s.
const LATE_SECONDS: f64 = 0.003;

/// What wakes a node more seldom, s, is not waited for.
const LONGEST_SECONDS: f64 = 0.1;

/// How long the network may take to close.
const LEAVING: Duration = Duration::from_secs(3);

/// How long last words have to leave.
const LAST_WORDS: Duration = Duration::from_millis(200);

/// A process with its nodes.
pub(crate) struct Process {
    poll: Poll,
    timer: Timer,
    /// Kept: the loop waits for it.
    _signals: Signals,
    status: Box<dyn GraphWatch>,
    /// What each token means.
    wakes: Vec<Option<Wake>>,
    topics: Topics,
    /// When to take what has come without waking.
    leisure: Option<Steady>,
    /// Of processes in the control loop, where the system allows it.
    awake: Option<LatencyRequest>,
    pub(crate) nodes: Vec<Node>,
    /// Lives as long as the endpoints of the nodes.
    pub(crate) network: Box<dyn Network>,
    host: Host,
    pub(crate) found: Found,
}

impl Process {
    /// Joins the network, as the `enclave` in this folder if there is one; nodes are added afterwards.
    pub(crate) fn new(backend: Backend, domain: u16, enclave: Option<&Path>) -> Result<Self, TransportError> {
        let system = |what| move |source| TransportError::System { what, source };
        let (network, mut status) = backend.join(domain, enclave)?;
        threads_wait_turn();
        let host = Host::join(domain)?;
        let poll = Poll::new().map_err(system("cannot make an event loop"))?;
        let timer = Timer::new().map_err(system("cannot make a timer"))?;
        let mut signals = Signals::new().map_err(system("cannot listen to signals"))?;
        timer.register(poll.registry(), TIMER).map_err(system("cannot wait for a timer"))?;
        signals.register(poll.registry(), SIGNALS).map_err(system("cannot wait for signals"))?;
        status.register(poll.registry(), STATUS, Interest::READABLE).map_err(system("cannot wait for the network"))?;
        Ok(Self {
            poll,
            timer,
            _signals: signals,
            status,
            wakes: vec![None; OWN_TOKENS],
            topics: Topics::new().map_err(system("cannot make an event loop"))?,
            leisure: None,
            awake: None,
            nodes: Vec::new(),
            network,
            host,
            found: Found::default(),
        })
    }

    /// The pieces a node is connected to.
    pub(crate) fn connections(&mut self) -> crate::node::Connections<'_> {
        crate::node::Connections {
            network: self.network.as_mut(),
            host: &self.host,
            registry: self.poll.registry(),
            topics: &mut self.topics,
            wakes: &mut self.wakes,
        }
    }

    /// Runs until a signal or a core ends it; gives the core's exit code, 0 after a signal.
    pub(crate) fn run(mut self) -> io::Result<u8> {
        // All threads are there.
        let in_real_time = take_turn();
        self.awake = in_real_time.then(LatencyRequest::open).flatten();
        for node in &mut self.nodes {
            node.debug(if in_real_time { "runs with real-time priority" } else { "runs with ordinary priority" });
        }
        self.nodes.iter_mut().for_each(Node::start);
        let mut events = Events::with_capacity(256);
        let code = loop {
            let wait = self.tick()?;
            if let Some(code) = self.nodes.iter().find_map(Node::exit) {
                break code;
            }
            match self.poll.poll(&mut events, wait) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                other => other?,
            }
            let mut asked_to_end = false;
            for event in &events {
                match event.token() {
                    SIGNALS => asked_to_end = true,
                    TIMER => self.timer.clear(),
                    STATUS => self.follow_graph(),
                    Token(token) => self.wake(token)?,
                }
            }
            if asked_to_end {
                break 0;
            }
        };
        self.end();
        let _leaving = Watchdog::new(LEAVING, code, "the network did not let go");
        drop(self);
        Ok(code)
    }

    /// Brings what woke the loop, and before it what has come without waking.
    fn wake(&mut self, token: usize) -> io::Result<()> {
        let now = steady_now();
        self.topics.take_waiting(now, &mut self.nodes)?;
        match self.wakes.get(token).copied().flatten() {
            Some(Wake::Topic(index)) => {
                self.topics.beat(index, now);
                self.topics.take(index, steady_now(), &mut self.nodes);
            }
            Some(Wake::Network(index)) => {
                self.topics.beat(index, now);
                self.topics.network_wakes(index);
                self.topics.take(index, steady_now(), &mut self.nodes);
            }
            Some(Wake::Node(index, wake)) => {
                if let Some(node) = self.nodes.get_mut(index) {
                    node.wake(wake);
                }
            }
            None => {}
        }
        self.leisure = (self.topics.some_wait() || self.awake.is_some()).then(|| self.leisure_after(now));
        Ok(())
    }

    /// When to take what has come without waking, after a wake-up `now`.
    fn leisure_after(&self, now: Steady) -> Steady {
        let soon = now.plus_seconds(LEISURE_SECONDS);
        let next = self.topics.next_beat(soon.plus_seconds(AHEAD_SECONDS)).map(|next| next.seconds_since(now));
        next.filter(|wait| *wait <= LONGEST_SECONDS).map_or(soon, |wait| now.plus_seconds(wait - AHEAD_SECONDS))
    }

    fn follow_graph(&mut self) {
        for change in self.status.take() {
            self.topics.graph_changed(&change, &mut self.nodes);
            for node in &mut self.nodes {
                node.graph_changed(&change);
            }
            if let GraphChange::Writer { topic, type_name, type_hash, qos } = &change {
                self.discover(Discovered { topic, type_name, type_hash, qos: *qos }, steady_now());
            }
        }
    }

    /// Does what is due and arms the timer for what comes next; gives how long the loop may wait, if there is a limit.
    fn tick(&mut self) -> io::Result<Option<Duration>> {
        let now = steady_now();
        let mut next: Option<Steady> = None;
        let at_leisure = self.leisure.is_some_and(|at| at <= now);
        self.leisure = self.leisure.filter(|_| !at_leisure);
        if at_leisure || self.nodes.iter().any(|node| node.is_due(now)) {
            self.topics.take_waiting(now, &mut self.nodes)?;
        }
        self.keep_awake(now, at_leisure);
        self.open_found(now);
        for node in &mut self.nodes {
            node.tick(now);
        }
        self.topics.tick(now, &self.host, self.poll.registry(), &mut self.nodes);
        for node in &mut self.nodes {
            let flush = if node.flush() { None } else { Some(now.plus_seconds(FLUSH_SECONDS)) };
            next = next.into_iter().chain(node.next_tick()).chain(flush).min();
        }
        let sleep = self.awake.as_ref().and_then(LatencyRequest::held).map(|(_, until)| until);
        let look = self.found.next_look(now);
        self.timer
            .set(next.into_iter().chain(look).chain(self.topics.next_tick()).chain(self.leisure).chain(sleep).min())
    }

    /// From shortly before what comes at regular times until all of it has come, processors do not sleep: one takes longer to
    /// wake than a controller to answer, and a frame wakes three one after the other.
    fn keep_awake(&mut self, now: Steady, at_leisure: bool) {
        let Some(awake) = &mut self.awake else { return };
        if at_leisure {
            let next = self.topics.next_beat(now).filter(|next| next.seconds_since(now) <= 2.0 * AHEAD_SECONDS);
            if let Some(next) = next {
                awake.hold(now, next.plus_seconds(LATE_SECONDS));
            }
        } else if let Some((since, until)) = awake.held()
            && (until <= now || self.topics.next_beat(since).is_none_or(|next| next > until))
        {
            awake.release();
        }
    }

    /// Last words, and time for them to leave.
    fn end(&mut self) {
        // Whoever watches wants all that was said until now.
        if let Err(error) = self.topics.take_waiting(steady_now(), &mut self.nodes) {
            self.nodes.iter_mut().for_each(|node| node.warn(&format!("the last messages are lost: {error}")));
        }
        self.nodes.iter_mut().for_each(Node::shut_down);
        let deadline = Instant::now() + LAST_WORDS;
        self.nodes.iter_mut().for_each(|node| node.settle(deadline));
    }
}
