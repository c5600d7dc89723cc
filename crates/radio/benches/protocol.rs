//! What packets cost the host: `cargo bench -p trench_radio --bench protocol`. Commands for twenty robots made for the line, as the
//! bridge does once a camera frame, and reports read from it, as it does ten times a second for each robot; both with a key's tag
//! and without.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use trench_radio::{
    Commands, Key, LinkFrame, Packet, Payload, Ranges, Relaying, StreamDecoder, Telemetry, WheelTimer, Wheels,
};

const ROBOTS: usize = 20;

/// A packet on the line, from the base station's side or the host's.
fn encode(packet: Packet, up: bool, key: Option<&Key>, bytes: &mut Vec<u8>, line: &mut Vec<u8>) {
    bytes.clear();
    line.clear();
    packet.encode(key, bytes);
    let packet: &[u8] = bytes;
    let frame =
        if up { LinkFrame::Uplink { signal_dbm: -60, wait_ms: 1, packet } } else { LinkFrame::Downlink { packet } };
    frame.encode(line);
}

fn commands() -> Payload {
    let mut commands = Commands { validity_ms: 80, ..Commands::default() };
    for (id, slot) in commands.wheels.iter_mut().take(ROBOTS).enumerate() {
        let speed = 0.01 * id as f64;
        *slot = Some(Wheels { left: WheelTimer::from_speed(speed), right: WheelTimer::from_speed(-speed) });
    }
    Payload::Commands(commands)
}

fn report() -> Payload {
    Payload::Telemetry(Telemetry { robot: 7, ranges: Ranges::new(&[35; 8]), ..Telemetry::default() })
}

fn packet(counter: u64, payload: Payload) -> Packet {
    Packet { relayed: 0, relaying: Relaying::Direct, counter, payload }
}

fn protocol(criterion: &mut Criterion) {
    let key = Key::new(std::array::from_fn(|index| index as u8));
    let (mut bytes, mut line) = (Vec::new(), Vec::new());
    let mut group = criterion.benchmark_group("radio");
    group.throughput(Throughput::Elements(1));
    for (name, key) in [("without a tag", None), ("with a tag", Some(&key))] {
        let mut counter = 0;
        group.bench_function(format!("commands for twenty robots, written, {name}"), |bencher| {
            bencher.iter(|| {
                counter += 1;
                encode(packet(counter, black_box(commands())), false, key, &mut bytes, &mut line);
                black_box(line.len())
            });
        });
        for (what, payload, up) in [("commands for twenty robots", commands(), false), ("a report", report(), true)] {
            encode(packet(1, payload), up, key, &mut bytes, &mut line);
            let mut decoder = StreamDecoder::default();
            group.bench_function(format!("{what}, read, {name}"), |bencher| {
                bencher.iter(|| {
                    let mut good = 0;
                    decoder.push(black_box(&line), |frame| {
                        if let LinkFrame::Downlink { packet } | LinkFrame::Uplink { packet, .. } = frame {
                            good += u32::from(black_box(Packet::decode(packet, key)).is_ok());
                        }
                    });
                    assert_eq!(good, 1, "{what} is read");
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, protocol);
criterion_main!(benches);
