//! Holds RustDDS's discovery while this process opens its endpoints.
//!
//! RustDDS 0.15.1 locks up where an endpoint is opened while others are found: its discovery thread tells the network
//! thread of the readers of a new writer (`add_local_writer`) through a channel of 32 places, under a read lock of the
//! discovery database; the network thread needs that lock before it takes anything out (`update_participant`), and does
//! not get it while the thread that opens the next endpoint waits to write. Measured: 10 of 112 processes of 60 endpoints
//! that started 14 at a time, and none of 140 with this.
//!
//! What breaks the circle is that the discovery thread stands still, at a place where it holds no lock, while endpoints are
//! opened. It says so to the [`log`] facade at such places, and the logger, which is ours, returns when it may go on.
//!
//! It stands before the first endpoint is opened, where it hears its own participant announced ([`super::announcements`]), so that
//! others are told of all its endpoints at once. RustDDS puts no time stamp on what it tells of endpoints; Fast DDS, which sorts by
//! them what several writers sent, forgets for ever the endpoints that it asks for again while it holds later ones (found by
//! reading its `NotifyChanges` and `history_order_cmp`; docs/decisions/0001-transport.md). Where no network has multicast it stands
//! before it announces anything.
//!
//! A release of RustDDS that notifies without the lock makes this file superfluous; one that logs other words fails its test.

use super::malformed;
use log::{LevelFilter, Log, Metadata, Record};
use std::fmt;
use std::sync::{Condvar, Mutex, MutexGuard, Once, PoisonError};
use std::time::Duration;

/// Where the discovery thread logs.
const DISCOVERY: &str = "rustdds::discovery::discovery";
/// What it says before it works on a participant, after it has told the network thread of a reader or a writer, and before
/// it does what is due, such as to announce its participant (first after 0.1 s).
const LOCK_FREE: [&str; 3] = ["spdp_receive read", "Discovered Writer", "Discovery event loop idling"];
/// Never longer, whatever happens: others take a participant that is silent for 20 s for lost.
const LONGEST: Duration = Duration::from_secs(8);
/// How long a new discovery thread takes, at the most, until it comes to a place where it can be held.
pub(super) const FIRST_STOP: Duration = Duration::from_millis(500);

/// Discovery of this process stands still while one of these lives.
pub(super) struct Pause(());

impl Pause {
    /// Holds the discovery threads of all participants of this process, each as soon as it comes to a place where it
    /// can be held.
    pub(super) fn begin() -> Self {
        static INSTALLED: Once = Once::new();
        // Where the program has a logger of its own discovery goes on as it would, and the watchdog is what remains.
        INSTALLED.call_once(|| drop(log::set_logger(&HOLD)));
        let mut state = HOLD.lock();
        state.pauses += 1;
        log::set_max_level(LevelFilter::Debug);
        Self(())
    }

    /// Waits until a discovery thread is held, at most for `patience`: one that comes by nowhere has nothing to do.
    pub(super) fn wait(&self, patience: Duration) -> bool {
        let held = HOLD.changed.wait_timeout_while(HOLD.lock(), patience, |state| state.held == 0);
        held.unwrap_or_else(PoisonError::into_inner).0.held > 0
    }

    /// Lets a thread that is held go on to where it can be held next.
    pub(super) fn step(&self) {
        let mut state = HOLD.lock();
        if state.held > 0 {
            state.held -= 1;
            state.steps += 1;
            HOLD.changed.notify_all();
        }
    }
}

impl Drop for Pause {
    fn drop(&mut self) {
        let mut state = HOLD.lock();
        state.pauses -= 1;
        if state.pauses == 0 {
            log::set_max_level(LevelFilter::Warn);
        }
        HOLD.changed.notify_all();
    }
}

static HOLD: Hold = Hold { state: Mutex::new(State { pauses: 0, held: 0, steps: 0 }), changed: Condvar::new() };

struct Hold {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// How many pauses live.
    pauses: usize,
    /// How many threads stand still.
    held: usize,
    /// How many more may go on to their next stop.
    steps: usize,
}

impl Hold {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Log for Hold {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target() == DISCOVERY || malformed::may_say(metadata)
    }

    fn log(&self, record: &Record<'_>) {
        if malformed::may_say(record.metadata()) {
            malformed::count(record);
            return;
        }
        if !self.enabled(record.metadata()) || !LOCK_FREE.iter().any(|words| starts_with(*record.args(), words)) {
            return;
        }
        let mut state = self.lock();
        state.held += 1;
        self.changed.notify_all();
        let held = self.changed.wait_timeout_while(state, LONGEST, |state| state.pauses > 0 && state.steps == 0);
        let (mut state, _) = held.unwrap_or_else(PoisonError::into_inner);
        match state.steps.checked_sub(1) {
            Some(steps) => state.steps = steps,
            None => state.held -= 1,
        }
    }

    fn flush(&self) {}
}

/// Whether a text begins with these words. Formats no more of it than that: the rest is a whole discovery message.
pub(super) fn starts_with(text: fmt::Arguments<'_>, words: &str) -> bool {
    let mut beginning = Beginning { rest: words };
    let _stopped_early = fmt::write(&mut beginning, text);
    beginning.rest.is_empty()
}

struct Beginning<'a> {
    /// What must still come.
    rest: &'a str,
}

impl fmt::Write for Beginning<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let common = self.rest.len().min(text.len());
        let (now, later) = self.rest.split_at_checked(common).ok_or(fmt::Error)?;
        if !text.starts_with(now) {
            return Err(fmt::Error);
        }
        self.rest = later;
        if later.is_empty() { Err(fmt::Error) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::{FIRST_STOP, Pause, starts_with};
    use rustdds::{DomainParticipantBuilder, RTPSEntity, StatusEvented};
    use socket2::{Domain, Socket, Type};
    use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
    use std::time::{Duration, Instant};

    /// Fails with a release of RustDDS that must be held elsewhere.
    #[test]
    fn discovery_stands_still_while_paused_and_goes_on() {
        let pause = Pause::begin();
        let participant = DomainParticipantBuilder::new(51).build().unwrap();
        assert!(pause.wait(Duration::from_secs(6)), "the discovery thread came by nowhere");
        drop(pause);
        let other = DomainParticipantBuilder::new(51).build().unwrap();
        let listener = participant.status_listener();
        let mut found = false;
        for _ in 0..1000 {
            found |= listener.try_recv_status().is_some();
            std::thread::sleep(Duration::from_millis(10));
            if found {
                break;
            }
        }
        assert!(found, "nothing was found after the pause");
        drop(other);
    }

    /// Who hears of a participant early asks for endpoints while others are announced.
    #[test]
    fn a_participant_is_silent_while_its_endpoints_are_opened() {
        let domain = 52;
        let socket = Socket::new(Domain::IPV4, Type::DGRAM, None).unwrap();
        socket.set_reuse_address(true).unwrap();
        let port = 7400 + 250 * domain; // RTPS 2.5, 9.6.2.3: discovery by multicast
        socket.bind(&SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, port).into()).unwrap();
        socket.join_multicast_v4(&Ipv4Addr::new(239, 255, 0, 1), &Ipv4Addr::UNSPECIFIED).unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(400))).unwrap();
        let socket = UdpSocket::from(socket);
        let pause = Pause::begin();
        let participant = DomainParticipantBuilder::new(domain).build().unwrap();
        assert!(pause.wait(FIRST_STOP));
        let prefix = &participant.guid().to_bytes()[..12];
        let mut datagram = [0; 65536];
        let mut is_announced = || {
            let start = Instant::now();
            while start.elapsed() < Duration::from_millis(800) {
                if socket.recv(&mut datagram).is_ok_and(|length| datagram[..length].get(8..20) == Some(prefix)) {
                    return true;
                }
            }
            false
        };
        assert!(!is_announced(), "announced before it may be");
        drop(pause);
        assert!(is_announced());
    }

    #[test]
    fn only_the_beginning_of_a_text_counts() {
        let check = |text, words, expected| assert_eq!(starts_with(format_args!("{text}"), words), expected, "{text}");
        check("spdp_receive read Ok(None)", "spdp_receive read", true);
        check("spdp_receive read", "spdp_receive read", true);
        check("spdp_receive", "spdp_receive read", false);
        check("Disposed Writer", "Discovered Writer", false);
        assert!(starts_with(format_args!("{}_receive {}", "spdp", "read"), "spdp_receive read"));
    }
}
