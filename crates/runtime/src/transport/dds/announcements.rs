//! Says several times at the start that this process is there.
//!
//! RustDDS announces a participant once, and again after 10 s: what a full link or a radio loses then costs the peers
//! these ten seconds, in which this process asks them in vain for their endpoints, ten times a second. Measured on a link of
//! 256 kbit/s: nobody met for 10 s, and the link was full for 23. Fast DDS announces itself six times at its start. So what RustDDS has said
//! comes again, byte by byte: who has heard it drops it by its number.
//!
//! It comes first, too: endpoints that are told to who knows the participant already go out once, to all at once; else each peer asks for
//! all of them, and where the answer waits behind others for longer than 0.1 s, again and again.

use super::rtps::{DATA, PREFIX, prefix, submessages};
use rustdds::GUID;
use socket2::{Domain, Socket, Type};
use std::io;
use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Where participants announce themselves (RTPS 2.5, 9.6.2.4.2).
const GROUP: Ipv4Addr = Ipv4Addr::new(239, 255, 0, 1);
/// Under which name they do (RTPS 2.5, 9.3.1.6): SPDPbuiltinParticipantWriter.
const ANNOUNCER: [u8; 4] = [0, 1, 0, 0xc2];
/// After what the announcement comes again, each after the one before, ms.
const PAUSES: [u64; 6] = [100, 200, 400, 800, 1500, 2500];
/// What a participant has announced.
pub(super) struct Announcement {
    said: Vec<u8>,
    /// One for each network.
    ways: Vec<UdpSocket>,
    group: SocketAddrV4,
}

impl Announcement {
    /// Says it again.
    pub(super) fn repeat(&self) {
        for way in &self.ways {
            // Lost, like any other that the network does not carry.
            let _lost = way.send_to(&self.said, self.group);
        }
    }
}

/// Announces one participant again and again for a while.
pub(super) struct Announcements {
    /// Closed when the participant goes: nothing may be heard of it after its farewell.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Announcements {
    pub(super) fn begin(announcement: Announcement) -> io::Result<Self> {
        let (end, ended) = channel();
        let thread = std::thread::Builder::new().name("announcements".to_owned());
        let thread = thread.spawn(move || {
            for pause in PAUSES {
                if ended.recv_timeout(Duration::from_millis(pause)) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
                announcement.repeat();
            }
        })?;
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

/// Where participants of a domain announce themselves, on all networks of this host that have multicast: what hears them on each, and what
/// can be said there.
pub(super) struct Announced {
    networks: Vec<(UdpSocket, UdpSocket)>,
    group: SocketAddrV4,
}

impl Announced {
    /// Listens to a domain. A network on which that cannot be done is left out: RustDDS has its own word on such.
    pub(super) fn listen(domain: u16) -> Self {
        let group = SocketAddrV4::new(GROUP, domain.saturating_mul(250).saturating_add(7400));
        let interfaces = netdev::get_interfaces();
        let fit = interfaces.iter().filter(|interface| interface.is_multicast() && !interface.is_loopback());
        let addresses = fit.flat_map(|interface| interface.ipv4.iter().map(|network| network.addr()));
        let networks = addresses.filter_map(|address| Some((hearer(group, address).ok()?, sender(address).ok()?)));
        Self { networks: networks.collect(), group }
    }

    /// Whether there is a network that has multicast.
    pub(super) fn can_hear(&self) -> bool {
        !self.networks.is_empty()
    }

    /// Takes what a participant of this process has said of itself since the last look.
    pub(super) fn own(&mut self, participant: GUID) -> Option<Announcement> {
        // What it says on one network is heard on the others, too, from the same host.
        let (hears, _) = self.networks.first()?;
        let mut datagram = vec![0; 65_536];
        while let Ok(length) = hears.recv(&mut datagram) {
            if is_announcement(&datagram[..length], &prefix(participant)) {
                datagram.truncate(length);
                let ways = self.networks.drain(..).map(|(_, says)| says).collect();
                return Some(Announcement { said: datagram, ways, group: self.group });
            }
        }
        None
    }
}

fn hearer(group: SocketAddrV4, address: Ipv4Addr) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, None)?;
    socket.set_reuse_address(true)?;
    // Bound to the group, it hears nothing else.
    socket.bind(&group.into())?;
    socket.join_multicast_v4(&GROUP, &address)?;
    socket.set_nonblocking(true)?;
    Ok(socket.into())
}

fn sender(address: Ipv4Addr) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, None)?;
    socket.set_multicast_if_v4(&address)?;
    Ok(socket.into())
}

/// Whether a datagram announces this participant.
fn is_announcement(datagram: &[u8], participant: &[u8; PREFIX]) -> bool {
    datagram.get(8..8 + PREFIX) == Some(participant)
        && submessages(datagram).any(|(kind, content)| kind == DATA && content.get(8..12) == Some(&ANNOUNCER))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::dds::Participant;
    use crate::transport::network::{Network, TopicName};
    use std::time::Instant;
    use trench_core::Qos;
    use trench_msgs::Message;
    use trench_msgs::rcl_interfaces::Log;

    /// RTPS 2.5, 9.3.1.6: SEDPbuiltinPublicationsWriter.
    const TELLS_WRITERS: [u8; 4] = [0, 0, 3, 0xc2];

    /// What participants of a domain say, which has no others, in order: under which name, and the whole of it.
    fn heard(announced: &Announced, patience: f64) -> Vec<([u8; 4], Vec<u8>)> {
        let (start, mut all, mut datagram) = (Instant::now(), Vec::new(), vec![0; 65_536]);
        while start.elapsed() < Duration::from_secs_f64(patience) {
            let Ok(length) = announced.networks[0].0.recv(&mut datagram) else {
                std::thread::sleep(Duration::from_millis(5));
                continue;
            };
            let said = submessages(&datagram[..length]).filter(|(kind, _)| *kind == DATA);
            all.extend(said.map(|(_, content)| (content[8..12].try_into().unwrap(), datagram[..length].to_vec())));
        }
        all
    }

    #[test]
    fn a_participant_is_announced_first_then_its_endpoints_and_nothing_after_its_farewell() {
        let domain = 54;
        let announced = Announced::listen(domain);
        if !announced.can_hear() {
            return println!("SKIPPED: no network that has multicast");
        }
        let mut participant = Participant::join(domain, None).unwrap();
        let name = TopicName::new("/rosout", Log::TYPE);
        let _writer = participant.writer("/speaker", &name, Qos::RELIABLE).unwrap();
        let before = heard(&announced, 0.5);
        assert!(before.iter().filter(|(who, _)| *who == ANNOUNCER).count() > 1, "not announced");
        assert!(before.iter().all(|(who, _)| *who != TELLS_WRITERS), "its endpoints are told before all are open");
        participant.announce().unwrap();
        let after = heard(&announced, 2.0);
        assert!(after.iter().any(|(who, _)| *who == TELLS_WRITERS), "nothing of its endpoints");
        let first = &before[0].1;
        let same = before.iter().chain(&after).filter(|(_, said)| said == first).count();
        assert!(same > 4, "announced {same} times");
        let leaving = Instant::now();
        drop(participant);
        assert!(leaving.elapsed() < Duration::from_secs(1), "it took {:?} to leave", leaving.elapsed());
        // What lies in the socket came before.
        let _before = heard(&announced, 0.1);
        assert!(heard(&announced, 2.0).is_empty(), "announced after its farewell");
    }
}
