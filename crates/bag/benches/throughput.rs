//! Recording against the mcap crate alone: the same messages, the same compression, the same disk, in turns.
//!
//! `cargo bench -p trench_bag --bench throughput`
#![expect(clippy::unwrap_used, reason = "a benchmark ends where it cannot measure")]

use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::Instant;
use trench_bag::{BagWriter, Stamp, TopicType, WriteOptions};
use trench_core::Qos;

const ROUNDS: usize = 9;
const COUNT: u64 = 200_000;
/// Sizes of the messages of the launched square, bytes: commands, leader states, odometry, team state, diagnostics.
const SIZES: [usize; 8] = [92, 92, 340, 340, 740, 740, 1100, 2400];
const TYPE: TopicType<'static> = TopicType { name: "test/msg/Numbers", hash: "", definition: "float64[] numbers\n" };

/// What is recorded: numbers that change a little from message to message, as those of a run do.
fn messages() -> Vec<(usize, u64, Vec<u8>)> {
    let message = |index: u64| {
        let topic = (index % SIZES.len() as u64) as usize;
        let number = |place: usize| (index as f64 * 1e-3 + place as f64).sin().to_le_bytes();
        let numbers: Vec<u8> = (0..SIZES[topic] / 8).flat_map(number).collect();
        (topic, 1_700_000_000_000_000_000 + index * 1_000_000, [&[0, 1, 0, 0][..], &numbers].concat())
    };
    (0..COUNT).map(message).collect()
}

fn ours(path: &Path, messages: &[(usize, u64, Vec<u8>)]) {
    let mut writer = BagWriter::create(path, WriteOptions::default()).unwrap();
    let ids: Vec<_> =
        (0..SIZES.len()).map(|n| writer.add_topic(&format!("/topic{n}"), TYPE, Qos::RELIABLE).unwrap()).collect();
    for (topic, log_time, cdr) in messages {
        let stamp = Stamp { log_time: *log_time, publish_time: *log_time, sequence: 0 };
        writer.write(ids[*topic], stamp, cdr).unwrap();
    }
    writer.finish().unwrap();
}

fn theirs(path: &Path, messages: &[(usize, u64, Vec<u8>)]) {
    let mut writer = mcap::WriteOptions::new()
        .profile("ros2")
        .compression(Some(mcap::Compression::Zstd))
        .compression_level(1)
        .compression_threads(0)
        .chunk_size(Some(1 << 20))
        .create(BufWriter::new(File::create(path).unwrap()))
        .unwrap();
    let schema = writer.add_schema(TYPE.name, "ros2msg", TYPE.definition.as_bytes()).unwrap();
    let channel = |n| format!("/topic{n}");
    let ids: Vec<_> =
        (0..SIZES.len()).map(|n| writer.add_channel(schema, &channel(n), "cdr", &BTreeMap::new()).unwrap()).collect();
    for (topic, log_time, cdr) in messages {
        let header =
            MessageHeader { channel_id: ids[*topic], sequence: 0, log_time: *log_time, publish_time: *log_time };
        writer.write_to_known_channel(&header, cdr).unwrap();
    }
    writer.finish().unwrap();
    // As durable as ours.
    writer.into_inner().into_inner().map_err(std::io::IntoInnerError::into_error).unwrap().sync_data().unwrap();
}

fn main() {
    let messages = messages();
    let bytes: usize = messages.iter().map(|(_, _, cdr)| cdr.len()).sum();
    let folder = tempfile::tempdir().unwrap();
    let mut seconds = [Vec::new(), Vec::new()];
    for round in 0..ROUNDS {
        for (which, write) in [ours, theirs].into_iter().enumerate() {
            let path = folder.path().join(format!("{which}_{round}"));
            let began = Instant::now();
            write(&path, &messages);
            seconds[which].push(began.elapsed().as_secs_f64());
        }
    }
    let [ours, theirs] = seconds.map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        (seconds[0], seconds[ROUNDS / 2])
    });
    let rate = |seconds: f64| (COUNT as f64 / seconds / 1e3, bytes as f64 / seconds / 1e6);
    for (name, (best, median)) in [("trench_bag", ours), ("mcap", theirs)] {
        let ((messages, megabytes), (best, _)) = (rate(median), rate(best));
        println!(
            "[throughput] {name}: {messages:.0} thousand messages/s, {megabytes:.0} MB/s (best {best:.0} thousand/s)"
        );
    }
    println!(
        "[throughput] ratio of the medians {:.1} %, of the best {:.1} %",
        100.0 * theirs.1 / ours.1,
        100.0 * theirs.0 / ours.0
    );
}
