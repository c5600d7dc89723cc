//! Length bombs: a reader's memory stays below twice the size of the file and 64 MiB, whatever the file claims.
//!
//! Each file is read by a process of its own, whose largest resident memory, program included, is the measure.
#![expect(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail as tests do")]

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use trench_bag::BagReader;

/// Names the file that a process of its own reads.
const BOMB: &str = "TRENCH_BOMB";

/// The largest resident memory of this process, bytes.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("the kernel tells it");
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() << 10
}

/// Opens and reads the bag, and says what that took.
fn read_alone(path: &Path) {
    let count = BagReader::open(path).map_or(0, |reader| reader.messages().map_while(Result::ok).count());
    println!("peak {} messages {count}", peak());
}

/// How many small records a file has: more with `TRENCH_DAMAGE`.
fn many() -> usize {
    50_000 * std::env::var("TRENCH_DAMAGE").map_or(1, |text| text.parse::<usize>().expect("a whole number"))
}

fn record(opcode: u8, body: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

fn schema(id: u16, name: &str, definition: &[u8]) -> Vec<u8> {
    let length = (definition.len() as u32).to_le_bytes();
    record(3, &[&id.to_le_bytes()[..], &text(name), &text("ros2msg"), &length, definition].concat())
}

fn channel(id: u16, schema: u16, topic: &str, metadata: &[u8]) -> Vec<u8> {
    let length = (metadata.len() as u32).to_le_bytes();
    let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
    record(4, &[&ids[..], &text(topic), &text("cdr"), &length, metadata].concat())
}

fn message(channel: u16, time: u64, data: &[u8]) -> Vec<u8> {
    let time = time.to_le_bytes();
    record(5, &[&channel.to_le_bytes()[..], &[0; 4], &time, &time, data].concat())
}

/// A chunk that claims to hold `claimed` bytes.
fn chunk(claimed: u64, compression: &str, data: &[u8]) -> Vec<u8> {
    let mut body = vec![0; 16];
    body.extend(claimed.to_le_bytes());
    body.extend([0; 4]);
    body.extend(text(compression));
    body.extend((data.len() as u64).to_le_bytes());
    body.extend(data);
    record(6, &body)
}

fn zstd_chunk(records: &[u8]) -> Vec<u8> {
    chunk(records.len() as u64, "zstd", &zstd::encode_all(records, 1).unwrap())
}

/// A frame that asks its reader for a window of 128 MiB and names no size.
fn wide_window() -> Vec<u8> {
    let mut encoder = zstd::Encoder::new(Vec::new(), 1).unwrap();
    encoder.window_log(27).unwrap();
    encoder.include_contentsize(false).unwrap();
    encoder.write_all(&vec![0; 30 << 20]).unwrap();
    encoder.finish().unwrap()
}

/// Lets another process, which has never held more, read what these parts make.
fn read(path: &Path, name: &str, parts: &mut dyn FnMut(&mut fs::File)) {
    let mut file = fs::File::create(path).unwrap();
    file.write_all(b"\x89MCAP0\r\n").unwrap();
    parts(&mut file);
    drop(file);
    let size = path.metadata().unwrap().len();
    let mut command = Command::new(std::env::current_exe().unwrap());
    let output = command.args(["--exact", "memory_is_bounded_by_the_size_of_the_file", "--nocapture"]).env(BOMB, path);
    let output = output.output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{name}: {said}");
    let words: Vec<&str> = said.split_whitespace().skip_while(|word| *word != "peak").collect();
    let used: u64 = words[1].parse().unwrap();
    println!("{name}: {size} bytes, {} messages, peak {:.1} MiB", words[3], used as f64 / f64::from(1 << 20));
    assert!(used <= 2 * size + (64 << 20), "{name}: {used} bytes for a file of {size}");
}

#[test]
fn memory_is_bounded_by_the_size_of_the_file() {
    if let Some(path) = std::env::var_os(BOMB) {
        return read_alone(Path::new(&path));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bomb.mcap");
    let check = |name: &str, parts: &[&[u8]], repeat: usize| {
        read(&path, name, &mut |file| {
            for _ in 0..repeat {
                parts.iter().for_each(|part| file.write_all(part).unwrap());
            }
        });
    };
    let zeros = zstd::encode_all(&*vec![0; 1 << 30], 1).unwrap();
    check("claims without bytes", &[&chunk(1 << 40, "", b"x"), &chunk(u64::MAX, "zstd", b"x")], 1);
    check("1 GiB claimed and there", &[&chunk(1 << 30, "zstd", &zeros)], 4);
    check("1 GiB there, 30 MiB claimed", &[&chunk(30 << 20, "zstd", &zeros)], 4);
    check("1 GiB there, 100 bytes claimed", &[&chunk(100, "zstd", &zeros)], 4);
    check("a window of 128 MiB", &[&chunk(30 << 20, "zstd", &wide_window())], 4);
    check("a record that claims 2^63 bytes", &[&[3, 255, 255, 255, 255, 255, 255, 255, 127]], 1);

    let topic = channel(1, 1, "/value", &[]);
    let empty = message(1, 7, &[]);
    let empties = [&topic[..], &empty.repeat((31 << 20) / empty.len())].concat();
    check("a million empty messages in a few kilobytes", &[&zstd_chunk(&empties)], 1);
    check("the same again and again, all at one time", &[&zstd_chunk(&empties)], 8);

    let large_type: Vec<u8> = (0..40).flat_map(|id| schema(id, "a/msg/A", &vec![b'#'; 700_000])).collect();
    check("types of 28 MiB in a few kilobytes", &[&zstd_chunk(&large_type)], 1);
    let channels: Vec<u8> = (0..40_000).flat_map(|id| channel(id, 1, &format!("/topic/{id}"), &[])).collect();
    let one_type = schema(1, "a/msg/A", &vec![b'#'; 700_000]);
    check("40,000 topics of a large type", &[&zstd_chunk(&[&one_type[..], &channels].concat())], 1);
    let keys: Vec<u8> = (0..2_000_000).flat_map(|key| [text(&format!("{key:x}")), text("")].concat()).collect();
    check("a topic with two million keys", &[&zstd_chunk(&channel(1, 1, "/value", &keys))], 1);
    check(
        "metadata with two million keys",
        &[&record(12, &[&text("x")[..], &(keys.len() as u32).to_le_bytes(), &keys].concat())],
        1,
    );

    check("chunks that are none", &[&chunk(1 << 60, "", b"")], 2 * many());
    check("messages outside chunks", &[&topic, &empty], many());
    check("the same with private records between", &[&topic, &empty, &record(0x90, &[])], many());
    check("the same with chunks between", &[&topic, &empty, &chunk(0, "", b"")], many());
}
