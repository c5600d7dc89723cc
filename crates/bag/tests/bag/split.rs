//! Bags of several files.

use crate::common::{FLOAT, NESTED, Written, float_cdr, nested_cdr, read_all, small_chunks};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;
use trench_bag::{BagReader, BagWriter, Stamp, WriteOptions};
use trench_core::Qos;

const SECOND: u64 = 1_000_000_000;

/// Writes 25 s of two topics, a message every 10 ms, into a bag that is split.
pub(crate) fn split(path: &Path, split_bytes: Option<u64>, split_after: Option<Duration>) -> Vec<Written> {
    let (writer, written) = unfinished(path, WriteOptions { split_bytes, split_after, ..small_chunks() });
    writer.finish().unwrap();
    written
}

fn unfinished(path: &Path, options: WriteOptions) -> (BagWriter, Vec<Written>) {
    let mut writer = BagWriter::create(path, options).unwrap();
    let float = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
    let mut written = Vec::new();
    for index in 0..2500_u64 {
        let log_time = 100 * SECOND + index * 10_000_000;
        let stamp = Stamp { log_time, publish_time: log_time, sequence: index as u32 };
        // The second topic comes late, and rarely: some files hold none of its messages.
        let (topic, id, cdr) = if index > 1000 && index % 700 == 0 {
            let nested = writer.add_topic("/nested", NESTED, Qos::LATCHED).unwrap();
            ("/nested", nested, nested_cdr(index as i32, 0.5, "text"))
        } else {
            ("/value", float, float_cdr((index as f64).sin()))
        };
        writer.write(id, stamp, &cdr).unwrap();
        let Stamp { log_time, publish_time, sequence } = stamp;
        written.push(Written { topic: topic.to_owned(), log_time, publish_time, sequence, cdr });
    }
    (writer, written)
}

fn mcap_files(path: &Path) -> Vec<PathBuf> {
    let files = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|path| path.extension().is_some_and(|extension| extension == "mcap")).collect()
}

#[test]
fn no_file_is_larger_than_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for most in [15_000, 40_000] {
        let path = folder.path().join(format!("by_size_{most}"));
        let written = split(&path, Some(most), None);
        let files = mcap_files(&path);
        assert!(files.len() > 2, "{files:?}");
        for file in &files {
            let length = file.metadata().unwrap().len();
            assert!(length <= most, "{}: {length} bytes", file.display());
            assert_eq!(BagReader::open(file).unwrap().damage(), [], "each file is a bag of its own");
        }
        let reader = BagReader::open(&path).unwrap();
        assert_eq!((reader.damage(), reader.topics().len()), (&[][..], 2));
        assert_eq!(read_all(&reader).unwrap(), written);
    }
}

#[test]
fn no_file_is_longer_than_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("by_time");
    let written = split(&path, None, Some(Duration::from_secs(2)));
    assert_eq!(mcap_files(&path).len(), 13, "25 s in files of 2 s");
    let reader = BagReader::open(&path).unwrap();
    assert_eq!(read_all(&reader).unwrap(), written);
    let tenth = BagReader::open(&path.join("by_time_10.mcap")).unwrap();
    assert_eq!(tenth.span(), Some((120 * SECOND, 122 * SECOND - 10_000_000)));
}

#[test]
fn a_killed_recorder_leaves_files_that_are_read_in_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("killed");
    let options = WriteOptions { split_after: Some(Duration::from_secs(2)), ..small_chunks() };
    let (writer, written) = unfinished(&path, options);
    std::mem::forget(writer);
    assert!(!path.join("metadata.yaml").exists());
    let reader = BagReader::open(&path).unwrap();
    let names: Vec<_> = reader.files().map(|(path, _)| path.file_stem().unwrap().to_string_lossy()).collect();
    assert_eq!((&*names[2], &*names[10], &*names[12]), ("killed_2", "killed_10", "killed_12"));
    let read = read_all(&reader).unwrap();
    assert!(read.len() > 2450, "{} of 2500", read.len());
    assert_eq!(read, written[..read.len()]);
}

#[test]
fn files_that_overlap_in_time_are_merged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("overlapping");
    fs::create_dir(&path).unwrap();
    // Three recordings side by side in one folder, as split by a recorder whose clock stepped back.
    for part in 0..3_u64 {
        let alone = folder.path().join(format!("part_{part}"));
        let mut writer = BagWriter::create(&alone, small_chunks()).unwrap();
        let topic = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
        for index in 0..1000_u64 {
            let stamp = Stamp { log_time: index / 2, publish_time: part, sequence: index as u32 };
            writer.write(topic, stamp, &float_cdr(index as f64)).unwrap();
        }
        writer.finish().unwrap();
        fs::copy(alone.join(format!("part_{part}_0.mcap")), path.join(format!("overlapping_{part}.mcap"))).unwrap();
    }
    let reader = BagReader::open(&path).unwrap();
    let read: Vec<_> = reader.messages().map(Result::unwrap).collect();
    assert_eq!(read.len(), 3000);
    let keys: Vec<_> = read.iter().map(|message| (message.log_time, message.publish_time, message.sequence)).collect();
    assert!(keys.is_sorted(), "log time, then file, then place in it");
}
