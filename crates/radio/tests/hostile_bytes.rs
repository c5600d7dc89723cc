//! Whatever bytes arrive, the decoder goes on, and what it lets through is what was sent.

use proptest::prelude::*;
use trench_radio::{
    Commands, Key, LinkFrame, MAX_ROBOTS, Packet, PacketError, Payload, Ranges, RelayList, Relaying, RobotSet,
    StreamDecoder, Telemetry, Welcome, WheelTimer, Wheels,
};

fn key() -> Key {
    Key::new([7; 16])
}

fn any_wheels() -> impl Strategy<Value = Option<Wheels>> {
    prop::option::of(
        (-0.3..0.3f64, -0.3..0.3f64).prop_map(|(left, right)| Wheels {
            left: WheelTimer::from_speed(left),
            right: WheelTimer::from_speed(right),
        }),
    )
}

fn any_packet() -> impl Strategy<Value = Packet> {
    let commands = (any::<u8>(), prop::array::uniform::<_, MAX_ROBOTS>(any_wheels()))
        .prop_map(|(validity_ms, wheels)| Payload::Commands(Commands { validity_ms, wheels }));
    let payload = prop_oneof![
        commands,
        any::<u32>().prop_map(|set| Payload::EmergencyStop(RobotSet(set))),
        any::<u32>().prop_map(|set| Payload::Reset(RobotSet(set))),
        prop::collection::vec((0..32u8, any::<u64>()), 1..5).prop_map(|robots| Payload::Welcome(Welcome::new(&robots))),
    ];
    let relays = prop::collection::vec(0..32u8, 0..4).prop_map(|ids| Relaying::by(RelayList::new(&ids)));
    let down = (relays, payload);
    let ranges = prop::collection::vec(any::<u8>(), 0..9);
    let nonce = prop::option::of(any::<u64>());
    let report = (0..32u8, any::<u32>(), ranges, nonce).prop_map(|(robot, set, ranges, nonce)| {
        let (neighbours, ranges) = (RobotSet(set), Ranges::new(&ranges));
        let report = Telemetry { robot, neighbours, ranges, ..Telemetry::default() };
        nonce.map_or(Payload::Telemetry(report), |nonce| Payload::Hello { nonce, report })
    });
    let asked = (0..4u8).prop_map(|limit| if limit == 0 { Relaying::Direct } else { Relaying::Anyone(limit) });
    let up = (asked, report);
    (0..16u8, 0..trench_radio::COUNTER_LIMIT, prop_oneof![down, up])
        .prop_map(|(relayed, counter, (relaying, payload))| Packet { relayed, relaying, counter, payload })
}

fn bytes_of(packet: &Packet) -> Vec<u8> {
    let mut bytes = Vec::new();
    packet.encode(Some(&key()), &mut bytes);
    bytes
}

fn line_of(packet: &Packet) -> Vec<u8> {
    let mut line = Vec::new();
    LinkFrame::Downlink { packet: &bytes_of(packet) }.encode(&mut line);
    line
}

/// The packets that a decoder gets out of `bytes`, fed in pieces of `cut` bytes.
fn received(bytes: &[u8], cut: usize) -> (Vec<Packet>, StreamDecoder) {
    let mut decoder = StreamDecoder::default();
    let mut packets = Vec::new();
    for piece in bytes.chunks(cut) {
        decoder.push(piece, |frame| {
            if let LinkFrame::Downlink { packet } = frame {
                packets.extend(Packet::decode(packet, Some(&key())));
            }
        });
    }
    (packets, decoder)
}

proptest! {
    #[test]
    fn packets_come_back_however_the_line_is_cut(packets in prop::collection::vec(any_packet(), 1..5), cut in 1..200usize) {
        let line: Vec<u8> = packets.iter().flat_map(line_of).collect();
        let (seen, decoder) = received(&line, cut);
        prop_assert_eq!(decoder.errors().total(), 0);
        prop_assert_eq!(seen, packets);
    }

    #[test]
    fn any_bytes_give_no_panic_and_no_packet(bytes in prop::collection::vec(any::<u8>(), 0..2000), cut in 1..300usize) {
        let (seen, _) = received(&bytes, cut);
        prop_assert_eq!(seen, vec![]);
        let _ = Packet::decode(&bytes, None);
    }

    #[test]
    fn after_garbage_the_next_delimiter_puts_it_in_step(
        garbage in prop::collection::vec(any::<u8>(), 1..600), lost in 0..20usize, first in any_packet(), second in any_packet(),
    ) {
        let cut_short = line_of(&first);
        let mut line = garbage;
        line.push(0);
        line.extend(&cut_short[..cut_short.len() - 1 - lost.min(cut_short.len() - 2)]);
        line.push(0);
        line.extend(line_of(&second));
        line.extend(line_of(&second));
        let (seen, decoder) = received(&line, 64);
        prop_assert_eq!(seen.last(), Some(&second));
        prop_assert_eq!(seen.iter().filter(|&&packet| packet == second).count() >= 2, true);
        prop_assert!(lost == 0 || decoder.errors().total() > 0);
    }

    #[test]
    fn a_changed_packet_is_not_authentic(packet in any_packet(), at: prop::sample::Index, bit in 0..8u8) {
        let mut bytes = bytes_of(&packet);
        let index = at.index(bytes.len());
        bytes[index] ^= 1 << bit;
        match Packet::decode(&bytes, Some(&key())) {
            Ok(changed) => prop_assert_eq!(Packet { relayed: packet.relayed, ..changed }, packet),
            Err(error) => prop_assert!(matches!(error, PacketError::Tag | PacketError::Version(_) | PacketError::Unauthenticated)),
        }
        prop_assert_eq!(Packet::decode(&bytes, Some(&Key::new([8; 16]))).is_ok(), false);
    }
}

#[test]
fn errors_are_counted_by_kind() {
    let packet = Packet { relayed: 0, relaying: Relaying::Direct, counter: 1, payload: Payload::Reset(RobotSet::ALL) };
    let good = line_of(&packet);
    let mut flipped = good.clone();
    flipped[1] ^= 0x01;
    let mut bytes = vec![1; 300];
    bytes.push(0);
    bytes.extend([9, 1, 0]);
    bytes.extend(flipped);
    for body in [&[][..], &[0x20, 1, 2], &[0x3f], &[0x32, 1]] {
        trench_radio::framing::frame(body, &mut bytes);
    }
    let (seen, decoder) = received(&bytes, 7);
    assert!(seen.is_empty());
    let counts: Vec<_> = decoder.errors().iter().collect();
    let expected = [("checksum", 1), ("kind", 1), ("overlong", 1), ("short", 2), ("stuffing", 1), ("version", 1)];
    assert_eq!(counts, expected);
}
