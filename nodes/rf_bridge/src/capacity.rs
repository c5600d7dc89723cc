//! Whether the serial line carries what the robots report.

/// Bytes on the line for a report without ranges and tag, for each range, for the tag, and for an answer of the base station.
const REPORT: usize = 42;
const TAG: usize = 8;
const ANSWER: usize = 13;

/// Reports of a robot, and packets that are answered, a second.
const REPORTS: f64 = 10.0;
const PACKETS: f64 = 30.0;

/// A byte on the line, with its start and stop bit.
const BITS: f64 = 10.0;

/// What is wrong if reports are more than the line carries, and the remedy: the base station drops what it cannot pass on within 50 ms.
pub(crate) fn shortage(robots: usize, ranges: usize, has_key: bool, baud: u32) -> Option<String> {
    let report = REPORT + ranges + if has_key { TAG } else { 0 };
    let needed = REPORTS * (robots * report) as f64 + PACKETS * ANSWER as f64;
    let there = f64::from(baud) / BITS;
    (needed > there).then(|| {
        format!(
            "serial.baud is {baud}: it carries {there:.0} bytes a second, but {robots} robots with {ranges} ranges report {needed:.0}, \
             and reports get lost; raise it, here and at the base station, to {:.0} or more, or use fewer range sensors",
            needed * BITS
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_radio::{Key, LinkFrame, Packet, Payload, Ranges, Relaying, Telemetry};

    #[test]
    fn a_report_takes_what_is_counted() {
        let key = Key::from_hex("000102030405060708090a0b0c0d0e0f").ok();
        for (ranges, key) in [(0, None), (4, key.as_ref()), (8, key.as_ref())] {
            let report = Telemetry { ranges: Ranges::new(&vec![7; ranges]), ..Telemetry::default() };
            let (mut packet, mut line) = (Vec::new(), Vec::new());
            Packet { relayed: 0, relaying: Relaying::Direct, counter: 1, payload: Payload::Telemetry(report) }
                .encode(key, &mut packet);
            LinkFrame::Uplink { signal_dbm: 0, wait_ms: 0, packet: &packet }.encode(&mut line);
            assert_eq!(line.len(), REPORT + ranges + if key.is_some() { TAG } else { 0 });
        }
    }

    #[test]
    fn twenty_robots_with_a_key_fit_and_more_are_told() {
        assert_eq!(shortage(20, 4, true, 115_200), None);
        for (robots, ranges) in [(20, 8), (32, 4)] {
            let told = shortage(robots, ranges, true, 115_200).unwrap_or_default();
            assert!(told.contains("115200") && told.contains("raise it"), "{told}");
            assert_eq!(shortage(robots, ranges, true, 230_400), None);
        }
    }
}
