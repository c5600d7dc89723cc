//! Damaged bags: nothing panics, nothing hangs, nothing altered is given out, what is intact is.

use crate::common::{Written, finished, mcap_file, read_all};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use trench_bag::BagReader;

/// A small generator, so that the same damage is done every time (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

/// How often damage is done: `TRENCH_DAMAGE` times as often as by default (10: 20,000 flips and 2,000 truncations).
fn thoroughness() -> usize {
    std::env::var("TRENCH_DAMAGE").map_or(1, |text| text.parse().expect("TRENCH_DAMAGE is a whole number"))
}

fn key(written: &Written) -> (String, u64, u32, Vec<u8>) {
    (written.topic.clone(), written.log_time, written.sequence, written.cdr.clone())
}

/// Reads damaged bytes and gives how many messages they still hold, all of which must be among the written ones.
fn survivors(file: &Path, bytes: &[u8], written: &BTreeSet<(String, u64, u32, Vec<u8>)>, what: &str) -> usize {
    fs::write(file, bytes).unwrap();
    let Ok(reader) = BagReader::open(file) else { return 0 };
    let read = read_all(&reader).unwrap();
    for message in &read {
        assert!(written.contains(&key(message)), "{what}: an altered message was passed off as intact: {message:?}");
    }
    assert_eq!(read.len() as u64, reader.message_count(), "{what}");
    if read.len() < written.len() {
        assert!(
            !reader.damage().is_empty(),
            "{what}: {} messages are missing without a word",
            written.len() - read.len()
        );
    }
    read.len()
}

#[test]
fn single_bit_flips_cost_at_most_a_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let all = finished(&path, 300).unwrap();
    let written = all.iter().map(key).collect();
    let bytes = fs::read(mcap_file(&path)).unwrap();
    let mut random = Random(1);
    let file = folder.path().join("flipped.mcap");
    let mut worst = all.len();
    let flips = 2000 * thoroughness();
    for _ in 0..flips {
        let bit = random.below(bytes.len() * 8);
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        worst = worst.min(survivors(&file, &flipped, &written, &format!("bit {bit}")));
    }
    // A chunk of 2000 bytes holds fewer than 60 of these messages.
    let cost = all.len() - worst;
    assert!(cost <= 60, "one flipped bit cost {cost} of {} messages", all.len());
    println!("worst {cost} of {} messages lost by one of {flips} flips", all.len());
}

#[test]
fn truncation_costs_only_what_was_cut_off() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let all = finished(&path, 300).unwrap();
    let written = all.iter().map(key).collect();
    let bytes = fs::read(mcap_file(&path)).unwrap();
    let file = folder.path().join("truncated.mcap");
    let mut before = 0;
    let truncations = 200 * thoroughness();
    for length in (0..truncations).map(|index| index * bytes.len() / truncations) {
        let count = survivors(&file, &bytes[..length], &written, &format!("{length} bytes"));
        assert!(count >= before, "{count} messages in {length} bytes, {before} in fewer");
        before = count;
    }
    assert!(before >= all.len() - 60);
    println!("worst {} messages lost by the last of {truncations} truncations", all.len() - before);
}

#[test]
fn garbage_in_the_middle_is_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let all = finished(&path, 300).unwrap();
    let written = all.iter().map(key).collect();
    let bytes = fs::read(mcap_file(&path)).unwrap();
    let mut random = Random(2);
    let file = folder.path().join("garbage.mcap");
    for round in 0..200 {
        let at = 8 + random.below(bytes.len() - 8);
        let garbage: Vec<u8> = (0..random.below(300)).map(|_| random.below(256) as u8).collect();
        let damaged = [&bytes[..at], &garbage, &bytes[at..]].concat();
        let count = survivors(&file, &damaged, &written, &format!("round {round}"));
        // Inside the first chunk it costs the definitions of the topics, and the summary cannot help out: it has moved.
        assert!(count >= all.len() - 60 || at < 3000, "round {round}: {count} messages left");
    }
}

#[test]
fn claimed_lengths_are_not_believed() {
    // Chunks of a few bytes that claim to hold up to 2^63: memory stays near the size of the file, or this aborts.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bomb.mcap");
    let chunk = |uncompressed: u64, compression: &str, data: &[u8]| {
        let mut body = Vec::new();
        body.extend([0; 16]);
        body.extend(uncompressed.to_le_bytes());
        body.extend(0_u32.to_le_bytes());
        body.extend((compression.len() as u32).to_le_bytes());
        body.extend(compression.as_bytes());
        body.extend((data.len() as u64).to_le_bytes());
        body.extend(data);
        [&[6][..], &(body.len() as u64).to_le_bytes(), &body].concat()
    };
    let zeros = zstd_of(&vec![0; 64 << 20]);
    let mut bytes = mcap_magic().to_vec();
    for claim in [1 << 40, u64::MAX, 1 << 63] {
        bytes.extend(chunk(claim, "", b"x"));
        bytes.extend(chunk(claim, "zstd", &zeros));
    }
    bytes.extend(chunk(100, "zstd", &zeros));
    bytes.extend([3, 255, 255, 255, 255, 255, 255, 255, 127]);
    fs::write(&file, &bytes).unwrap();
    let reader = BagReader::open(&file).unwrap();
    assert_eq!(reader.message_count(), 0);
    assert!(reader.damage().iter().filter(|damage| damage.what.contains("larger than any chunk")).count() == 6);
}

fn mcap_magic() -> &'static [u8] {
    b"\x89MCAP0\r\n"
}

fn zstd_of(bytes: &[u8]) -> Vec<u8> {
    zstd::encode_all(bytes, 1).unwrap()
}
