//! The test vectors of docs/protocols/radio.md: bytes made and read back.
#![expect(clippy::expect_used, clippy::panic, reason = "a test ends where its vector is missing")]

use trench_radio::{
    Ack, AckStatus, Commands, Fault, Key, LinkFrame, Packet, Payload, Ranges, RelayList, Relaying, RobotSet,
    StreamDecoder, Telemetry, Welcome, WheelTimer, Wheels, relayed_once_more,
};

const DOCUMENT: &str = include_str!("../../../docs/protocols/radio.md");

/// What a robot drew.
const NONCE: u64 = 0xfeed_0123_4567_89ab;

fn key() -> Key {
    Key::new(std::array::from_fn(|index| index as u8))
}

/// The bytes that the document's table gives for `name`.
fn documented(name: &str) -> Vec<u8> {
    let row = DOCUMENT.lines().find(|line| line.starts_with(&format!("| {name} |")));
    let row = row.unwrap_or_else(|| panic!("docs/protocols/radio.md has no vector {name}"));
    let hex = row.split('|').nth(2).expect("a second column").trim().trim_matches('`');
    hex.split(' ').map(|byte| u8::from_str_radix(byte, 16).expect("a byte")).collect()
}

fn check(name: &str, line: &[u8]) {
    let hex: Vec<String> = line.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(documented(name), line, "{name} is {}", hex.join(" "));
}

/// A packet to the robots, over the line and back.
fn check_downlink(name: &str, packet: Packet, key: Option<&Key>) {
    let (mut bytes, mut line) = (Vec::new(), Vec::new());
    packet.encode(key, &mut bytes);
    LinkFrame::Downlink { packet: &bytes }.encode(&mut line);
    check(name, &line);
    let mut seen = 0;
    StreamDecoder::default().push(&line, |frame| match frame {
        LinkFrame::Downlink { packet: bytes } => {
            assert_eq!(Packet::decode(bytes, key), Ok(packet));
            seen += 1;
        }
        other => panic!("{other:?}"),
    });
    assert_eq!(seen, 1);
}

fn wheels(left: f64, right: f64) -> Wheels {
    Wheels { left: WheelTimer::from_speed(left), right: WheelTimer::from_speed(right) }
}

fn two_robots() -> Payload {
    let mut commands = Commands { validity_ms: 80, ..Commands::default() };
    commands.wheels[1] = Some(wheels(0.2, -0.1));
    commands.wheels[4] = Some(wheels(0.0, 0.3));
    Payload::Commands(commands)
}

fn direct(counter: u64, payload: Payload) -> Packet {
    Packet { relayed: 0, relaying: Relaying::Direct, counter, payload }
}

#[test]
fn commands() {
    check_downlink("commands", direct(0x0102_0304_0506, two_robots()), None);
    check_downlink("commands with tag", direct(7, two_robots()), Some(&key()));
    let relayed = Packet { relayed: 2, relaying: Relaying::By(RelayList::new(&[3, 17])), ..direct(7, two_robots()) };
    check_downlink("commands relayed twice", relayed, Some(&key()));
}

#[test]
fn a_relay_changes_what_the_tag_leaves_out() {
    let relaying = Relaying::By(RelayList::new(&[3, 17]));
    let (mut once, mut twice) = (Vec::new(), Vec::new());
    Packet { relayed: 1, relaying, ..direct(7, two_robots()) }.encode(Some(&key()), &mut once);
    Packet { relayed: 2, relaying, ..direct(7, two_robots()) }.encode(Some(&key()), &mut twice);
    assert_eq!(relayed_once_more(&once), twice);
}

#[test]
fn stop_and_reset() {
    check_downlink("emergency stop", direct(8, Payload::EmergencyStop(RobotSet::ALL)), None);
    check_downlink("reset", direct(8, Payload::Reset(RobotSet(0b1_0010))), Some(&key()));
}

fn report() -> Telemetry {
    Telemetry {
        robot: 4,
        fault: Fault(Fault::LOW_BATTERY.0 | Fault::MISSED_STEPS.0),
        last_counter: 0x0506,
        last_age_ms: 12,
        last_relayed: 1,
        received: 300,
        neighbours: RobotSet(0b1000),
        battery_mv: 7400,
        signal_dbm: -61,
        steps_left: -2,
        steps_right: 70_000,
        uptime_ms: 3_600_000,
        ranges: Ranges::new(&[35, 255, 12, 80]),
    }
}

/// A packet to the base, over the line and back.
fn check_uplink(name: &str, payload: Payload) {
    let packet = Packet { relaying: Relaying::Anyone(3), ..direct(9, payload) };
    let (mut bytes, mut line) = (Vec::new(), Vec::new());
    packet.encode(Some(&key()), &mut bytes);
    LinkFrame::Uplink { signal_dbm: -58, wait_ms: 3, packet: &bytes }.encode(&mut line);
    check(name, &line);
    let mut seen = 0;
    StreamDecoder::default().push(&line, |frame| {
        assert_eq!(frame, LinkFrame::Uplink { signal_dbm: -58, wait_ms: 3, packet: &bytes });
        seen += 1;
    });
    assert_eq!((seen, Packet::decode(&bytes, Some(&key()))), (1, Ok(packet)));
}

#[test]
fn telemetry() {
    check_uplink("telemetry", Payload::Telemetry(report()));
}

#[test]
fn hello_and_welcome() {
    let switched_on = Telemetry {
        fault: Fault::COMMAND_TIMEOUT,
        last_counter: 0,
        last_age_ms: 255,
        last_relayed: 0,
        received: 0,
        neighbours: RobotSet::default(),
        signal_dbm: 0,
        steps_left: 0,
        steps_right: 0,
        uptime_ms: 80,
        ..report()
    };
    check_uplink("hello", Payload::Hello { nonce: NONCE, report: switched_on });
    let welcome = Welcome::new(&[(4, NONCE), (17, 1)]);
    assert_eq!([4, 17, 3].map(|robot| welcome.nonce(robot)), [Some(NONCE), Some(1), None]);
    check_downlink("welcome", direct(10, Payload::Welcome(welcome)), Some(&key()));
    let relayed =
        Packet { relayed: 1, relaying: Relaying::By(RelayList::new(&[3])), ..direct(10, Payload::Welcome(welcome)) };
    check_downlink("welcome relayed", relayed, Some(&key()));
}

/// A welcome of nobody, of more than there is room for, or of half a robot is none.
#[test]
fn lengths_of_welcomes() {
    let (mut bytes, count) = (Vec::new(), trench_radio::MAX_WELCOMED);
    direct(1, Payload::Welcome(Welcome::new(&[(1, NONCE)]))).encode(None, &mut bytes);
    let (header, entry) = bytes.split_at(8);
    for length in 0..=9 * (count + 1) {
        let entries = entry.iter().cycle().take(length).copied();
        let packet: Vec<u8> = header.iter().copied().chain(entries).collect();
        let whole = length > 0 && length % 9 == 0 && length <= 9 * count;
        assert_eq!(Packet::decode(&packet, None).is_ok(), whole, "{length}");
    }
}

#[test]
fn acknowledgement() {
    let ack = Ack { counter: 0x0102_0304_0506, status: AckStatus::Expired, wait_ms: 1 };
    let mut line = Vec::new();
    LinkFrame::Ack(ack).encode(&mut line);
    check("acknowledgement", &line);
    let mut seen = 0;
    StreamDecoder::default().push(&line, |frame| {
        assert_eq!(frame, LinkFrame::Ack(ack));
        seen += 1;
    });
    assert_eq!(seen, 1);
}

#[test]
fn twenty_robots_with_tag_fit_into_ten_milliseconds() {
    let mut commands = Commands { validity_ms: 80, ..Commands::default() };
    commands.wheels[..20].fill(Some(wheels(0.25, -0.25)));
    for (relays, length) in [(&[][..], 111), (&[1, 2, 3], 113)] {
        let relaying = Relaying::by(RelayList::new(relays));
        let (mut bytes, mut line) = (Vec::new(), Vec::new());
        Packet { relaying, ..direct(1, Payload::Commands(commands)) }.encode(Some(&key()), &mut bytes);
        LinkFrame::Downlink { packet: &bytes }.encode(&mut line);
        assert_eq!(line.len(), length);
        // With the delimiter that the host sends first.
        assert!((line.len() + 1) as f64 * 10.0 / 115_200.0 < 0.010);
    }
}

/// The longest welcome keeps commands waiting for less than a frame of theirs does.
#[test]
fn a_welcome_is_on_the_line_for_six_milliseconds() {
    let robots: Vec<(u8, u64)> = (1..=trench_radio::MAX_WELCOMED as u8).map(|robot| (robot, NONCE)).collect();
    let relaying = Relaying::by(RelayList::new(&[1, 2, 3]));
    let (mut bytes, mut line) = (Vec::new(), Vec::new());
    Packet { relaying, ..direct(1, Payload::Welcome(Welcome::new(&robots))) }.encode(Some(&key()), &mut bytes);
    LinkFrame::Downlink { packet: &bytes }.encode(&mut line);
    assert!((line.len() + 1) as f64 * 10.0 / 115_200.0 < 0.006, "{} bytes", line.len());
}
