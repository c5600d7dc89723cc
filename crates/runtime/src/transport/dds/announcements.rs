//! Says several times at the start that this process is there.
//!
//! RustDDS announces a participant once, and again after 10 s: what a full link or a radio loses then costs the peers
//! these ten seconds, in which their endpoints cannot be told, and this process asks them in vain ten times a second.
//! (Measured on a link of 256 kbit/s: 10 s, and a link that was full for 23.) Fast DDS announces itself six times at its start. So what
//! RustDDS has said comes again, byte by byte: who has heard it drops it by its number.

use super::rtps::{DATA, PREFIX, submessages};
use rustdds::GUID;
use socket2::{Domain, Socket, Type};
use std::io;
use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Where participants announce themselves (RTPS 2.5, 9.6.2.4.2).
const GROUP: Ipv4Addr = Ipv4Addr::new(239, 255, 0, 1);
/// Under which name they do (RTPS 2.5, 9.3.1.6): SPDPbuiltinParticipantWriter.
const ANNOUNCER: [u8; 4] = [0, 1, 0, 0xc2];
/// After what the announcement comes again, each after the one before, ms.
const PAUSES: [u64; 6] = [100, 200, 400, 800, 1500, 2500];
/// How long endpoints may be opened before RustDDS announces the participant (see [`super::pause`]).
const FIRST: Duration = Duration::from_secs(10);
/// A look whether the process ends meanwhile.
const LOOK: Duration = Duration::from_millis(50);

/// Announces one participant.
pub(super) struct Announcements {
    /// Closed when the participant goes: nothing may be heard of it after its farewell.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Announcements {
    /// Opened before a participant announces itself. Without a network that has multicast there is nothing to do.
    pub(super) fn begin(domain: u16, participant: GUID) -> io::Result<Self> {
        let Some(port) = domain.checked_mul(250).and_then(|offset| offset.checked_add(7400)) else {
            return Ok(Self { end: None, thread: None });
        };
        let ways = ways(port)?;
        let (end, ended) = channel();
        let thread = std::thread::Builder::new().name("announcements".to_owned());
        let thread = thread.spawn(move || repeat(&ways, participant, &ended))?;
        Ok(Self { end: Some(end), thread: Some(thread) })
    }
}

impl Drop for Announcements {
    fn drop(&mut self) {
        self.end = None;
        // A panic of it ends the process by itself.
        let _result = self.thread.take().map(JoinHandle::join);
    }
}

/// A network of this host.
struct Way {
    hears: UdpSocket,
    says: UdpSocket,
    group: SocketAddrV4,
}

/// The networks of this host on which participants announce themselves.
fn ways(port: u16) -> io::Result<Vec<Way>> {
    let interfaces = netdev::get_interfaces();
    let fit = interfaces.iter().filter(|interface| interface.is_multicast() && !interface.is_loopback());
    let addresses = fit.flat_map(|interface| interface.ipv4.iter().map(|network| network.addr()));
    addresses.map(|address| way(address, SocketAddrV4::new(GROUP, port))).collect()
}

fn way(address: Ipv4Addr, group: SocketAddrV4) -> io::Result<Way> {
    let hears = Socket::new(Domain::IPV4, Type::DGRAM, None)?;
    hears.set_reuse_address(true)?;
    // Bound to the group, it hears nothing else.
    hears.bind(&group.into())?;
    hears.join_multicast_v4(&GROUP, &address)?;
    hears.set_read_timeout(Some(LOOK))?;
    let says = Socket::new(Domain::IPV4, Type::DGRAM, None)?;
    says.set_multicast_if_v4(&address)?;
    Ok(Way { hears: hears.into(), says: says.into(), group })
}

/// Hears the participant's announcement and repeats it until all is said or the process ends.
fn repeat(ways: &[Way], participant: GUID, ended: &Receiver<()>) {
    let participant = participant.to_bytes();
    let Some((announcer, _)) = participant.split_first_chunk::<PREFIX>() else { return };
    let Some(announcement) = ways.first().and_then(|way| own(&way.hears, announcer, ended)) else { return };
    for pause in PAUSES {
        if ended.recv_timeout(Duration::from_millis(pause)) != Err(RecvTimeoutError::Timeout) {
            return;
        }
        for way in ways {
            // Lost, like any other that the network does not carry.
            let _lost = way.says.send_to(&announcement, way.group);
        }
    }
}

/// What a participant says of itself.
fn own(hears: &UdpSocket, participant: &[u8; PREFIX], ended: &Receiver<()>) -> Option<Vec<u8>> {
    let mut datagram = vec![0; 65_536];
    let start = Instant::now();
    while start.elapsed() < FIRST && ended.try_recv() == Err(std::sync::mpsc::TryRecvError::Empty) {
        let length = hears.recv(&mut datagram).unwrap_or_default();
        if let Some(said) = datagram.get(..length)
            && is_announcement(said, participant)
        {
            return Some(said.to_vec());
        }
    }
    None
}

/// Whether a datagram announces this participant.
fn is_announcement(datagram: &[u8], participant: &[u8; PREFIX]) -> bool {
    datagram.get(8..8 + PREFIX) == Some(participant)
        && submessages(datagram).any(|(kind, content)| kind == DATA && content.get(8..12) == Some(&ANNOUNCER))
}

#[cfg(test)]
mod tests {
    use super::super::rtps::prefix;
    use super::*;
    use rustdds::{DomainParticipantBuilder, RTPSEntity};

    #[test]
    fn a_participant_is_announced_again_and_not_after_its_farewell() {
        let domain = 53;
        let ways = ways(7400 + 250 * domain).unwrap();
        let Some(way) = ways.first() else { return println!("SKIPPED: no network that has multicast") };
        let participant = DomainParticipantBuilder::new(domain).build().unwrap();
        let again = Announcements::begin(domain, participant.guid()).unwrap();
        let prefix = prefix(participant.guid());
        let mut datagram = vec![0; 65_536];
        let mut announcements = |patience: f64| {
            let start = Instant::now();
            let mut heard = Vec::new();
            while start.elapsed() < Duration::from_secs_f64(patience) {
                let length = way.hears.recv(&mut datagram).unwrap_or_default();
                if is_announcement(&datagram[..length], &prefix) {
                    heard.push(datagram[..length].to_vec());
                }
            }
            heard
        };
        let heard = announcements(2.0);
        let first = heard.first().unwrap();
        let same = heard.iter().filter(|other| *other == first).count();
        assert!(same > 4, "{same} of {} the same", heard.len());
        let leaving = Instant::now();
        drop(again);
        assert!(leaving.elapsed() < Duration::from_millis(300), "it took {:?} to stop", leaving.elapsed());
        drop(participant);
        // What lies in the socket came before.
        let _before = announcements(0.1);
        assert_eq!(announcements(2.0).len(), 0, "announced after its farewell");
    }
}
