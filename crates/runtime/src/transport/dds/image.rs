//! Images on their way to readers elsewhere: cut up by us, each piece when its time has come, and marked as what lets
//! everything else pass.
//!
//! RustDDS sends all pieces of a message at once, from the socket that commands leave by, too: on a slow link commands then wait
//! behind a whole image. Nobody repeats what is lost of a best-effort topic, so that the writer need not know of
//! its messages: they go out under its name and count, and RustDDS only says that there is a writer.

use super::rtps::{DATA, DATA_FRAG, HAS_DATA, INFO_DST, INFO_TS, PREFIX, header, sequence_number, submessage};
use crate::clock::steady_now;
use crate::transport::network::{Lane, Pace};
use rustdds::bytes::Bytes;
use rustdds::{GUID, Timestamp};
use socket2::{Domain, Protocol, Socket, Type};
use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::thread::sleep;

/// DSCP CS1, "lower effort" (RFC 3662), as the field in the IP header has it: Wi-Fi puts it into its background class.
const LOWER_EFFORT: u32 = 8 << 2;
/// TC_PRIO_BULK: the last band of Linux's own queues (pfifo_fast, prio).
const BULK: u32 = 2;
/// Bytes that wait in the host for its own interface, which the kernel doubles for its book-keeping: where that is the slow
/// link, images wait here, so that the newest is not behind many old ones.
const WAITING: usize = 32_768;
/// Headers of Ethernet, IP and UDP, bytes.
const HEADERS: usize = 14 + 20 + 8;
/// The longest piece, bytes: with all headers it fits an Ethernet frame.
const LONGEST: usize = 1344;
/// The shortest: headers are a fifth of it already.
const SHORTEST: usize = 512;
/// s, for which a piece may keep a link that has no more than the images' own rate: what is urgent waits for one at most.
const PIECE: f64 = 0.02;

/// A process that reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    pub(super) prefix: [u8; PREFIX],
    pub(super) address: SocketAddr,
}

/// A message on its way.
pub(super) struct Image {
    /// The writer's count.
    pub(super) number: u64,
    /// With the four bytes that name the encoding.
    pub(super) cdr: Bytes,
    pub(super) to: Arc<[Place]>,
}

/// Opens the way of a writer's images, which may take `rate` bit/s.
pub(super) fn open(writer: GUID, rate: f64) -> io::Result<Lane<Image>> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, Some(Protocol::UDP))?;
    // The first sets the second, too, and to what lets nobody pass.
    socket.set_tos_v4(LOWER_EFFORT)?;
    socket.set_priority(BULK)?;
    socket.set_send_buffer_size(WAITING)?;
    let socket = UdpSocket::from(socket);
    let mut pace = Pace::new(rate);
    let (piece, writer) = (piece(rate), writer.to_bytes());
    let mut datagram = Vec::new();
    Lane::open(move |image: Image| {
        let time = Timestamp::now();
        for number in 0..image.cdr.len().div_ceil(piece) {
            for place in image.to.iter() {
                datagram.clear();
                write(&mut datagram, &writer, &image, place, time, (number, piece));
                sleep(pace.wait(steady_now(), datagram.len() + HEADERS));
                // Lost, like any other piece that the network does not carry.
                let _lost = socket.send_to(&datagram, place.address);
            }
        }
    })
}

/// Bytes of a message in one datagram: always the same of one writer (RTPS 2.5, 8.4.14.1.1).
fn piece(rate: f64) -> usize {
    ((rate / 8.0 * PIECE) as usize).clamp(SHORTEST, LONGEST) / 4 * 4
}

/// Writes the datagram with piece `number` of an image for a reader.
fn write(
    datagram: &mut Vec<u8>,
    writer: &[u8; 16],
    image: &Image,
    place: &Place,
    time: Timestamp,
    (number, piece): (usize, usize),
) {
    let (prefix, entity) = writer.split_at(PREFIX);
    header(datagram, prefix);
    submessage(datagram, INFO_DST, 0, &place.prefix);
    // RTPS has seconds first, then the fraction.
    let ticks = time.to_ticks();
    let halves = [((ticks >> 32) as u32).to_le_bytes(), (ticks as u32).to_le_bytes()];
    submessage(datagram, INFO_TS, 0, &halves.concat());
    let is_whole = image.cdr.len() <= piece;
    let mut content = Vec::with_capacity(64 + piece);
    content.extend([0; 2]); // extra flags
    content.extend((if is_whole { 16_u16 } else { 28 }).to_le_bytes()); // bytes from here to where inline qualities would be
    content.extend([0; 4]); // all readers there
    content.extend(entity);
    content.extend(sequence_number(i64::try_from(image.number).unwrap_or(i64::MAX)));
    if !is_whole {
        // Pieces are counted from 1; a message that had more than u32 counts would not be in memory.
        content.extend((number as u32 + 1).to_le_bytes());
        content.extend(1_u16.to_le_bytes()); // pieces in this datagram
        content.extend((piece as u16).to_le_bytes());
        content.extend((image.cdr.len() as u32).to_le_bytes());
    }
    let start = number * piece;
    content.extend(&image.cdr[start..image.cdr.len().min(start + piece)]);
    content.resize(content.len().next_multiple_of(4), 0);
    let (kind, flags) = if is_whole { (DATA, HAS_DATA) } else { (DATA_FRAG, 0) };
    submessage(datagram, kind, flags, &content);
}

/// Of a reader's addresses the one that is nearest by the way this host would take: that whose own address agrees with it
/// furthest. One is enough, and each costs a copy. RustDDS announces the loopback address to other hosts, too: it is nearest
/// only where there is no other.
pub(super) fn nearest(addresses: impl Iterator<Item = SocketAddr>) -> Option<SocketAddr> {
    let distance = |address: &SocketAddr| {
        let socket = UdpSocket::bind("0.0.0.0:0").ok()?;
        socket.connect(address).ok()?;
        match (socket.local_addr().ok()?, address) {
            (SocketAddr::V4(_), SocketAddr::V4(other)) if other.ip().is_loopback() => Some(u32::BITS),
            (SocketAddr::V4(own), SocketAddr::V4(other)) => {
                Some(u32::BITS - (own.ip().to_bits() ^ other.ip().to_bits()).leading_zeros())
            }
            _ => None,
        }
    };
    let reachable = addresses.filter(SocketAddr::is_ipv4).filter_map(|address| Some((distance(&address)?, address)));
    reachable.min().map(|(_, address)| address)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(cdr: &'static [u8]) -> (Image, Place) {
        let place =
            Place { prefix: std::array::from_fn(|index| 0x40 + index as u8), address: ([127, 0, 0, 1], 7411).into() };
        (Image { number: 7, cdr: Bytes::from_static(cdr), to: Arc::new([place]) }, place)
    }

    fn hex(cdr: &'static [u8], number: usize, piece: usize) -> String {
        let (image, place) = image(cdr);
        let writer = std::array::from_fn(|index| 0x20 + index as u8);
        let mut datagram = Vec::new();
        let time = Timestamp::from_ticks(0x0000_0001_8000_0000);
        write(&mut datagram, &writer, &image, &place, time, (number, piece));
        datagram.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    const BEFORE: &str = concat!(
        "52545053",
        "0204",
        "0112",
        "202122232425262728292a2b",
        "0e010c00",
        "404142434445464748494a4b",
        "09010800",
        "0100000000000080",
    );

    #[test]
    fn pieces_are_as_the_standard_writes_them() {
        let content = |number: &str, bytes: &str| {
            let head = "0000".to_owned() + "1c00" + "00000000" + "2c2d2e2f" + "0000000007000000";
            format!("{BEFORE}16012800{head}{number}0100080013000000{bytes}")
        };
        let cdr: &[u8] = &[0, 1, 0, 0, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18];
        assert_eq!(hex(cdr, 0, 8), content("01000000", "0001000004050607"));
        assert_eq!(hex(cdr, 1, 8), content("02000000", "08090a0b0c0d0e0f"));
        // The last one is shorter, and filled up to whole words.
        let last = content("03000000", "10111200").replace("16012800", "16012400");
        assert_eq!(hex(cdr, 2, 8), last);
    }

    #[test]
    fn a_short_message_goes_as_it_is() {
        let expected = format!("{BEFORE}15051c0000001000000000002c2d2e2f000000000700000000010000090a0000");
        assert_eq!(hex(&[0, 1, 0, 0, 9, 10], 0, 8), expected);
    }

    #[test]
    fn pieces_fit_the_frame_and_the_patience_of_commands() {
        assert_eq!(piece(f64::INFINITY), LONGEST);
        assert_eq!(piece(400.0e6), LONGEST);
        assert_eq!(piece(300_000.0), 748);
        assert_eq!(piece(100_000.0), SHORTEST);
    }

    #[test]
    fn loopback_is_nearest_only_where_there_is_nothing_else() {
        let at = |text: &str| text.parse::<SocketAddr>().unwrap();
        let loopback = at("127.0.0.1:7411");
        assert_eq!(nearest([at("[::1]:7411"), loopback].into_iter()), Some(loopback));
        assert_eq!(nearest(std::iter::once(at("[::1]:7411"))), None);
        // Where this host has a network at all, its own address there is nearer than one that is beyond.
        let socket = UdpSocket::bind("0.0.0.0:0").unwrap();
        if socket.connect("192.0.2.1:9").is_ok() {
            let own = SocketAddr::new(socket.local_addr().unwrap().ip(), 7411);
            assert_eq!(nearest([loopback, at("192.0.2.1:7411"), own].into_iter()), Some(own));
        }
    }
}
