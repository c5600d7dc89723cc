//! What is written is read again.

use crate::common::{FLOAT, finished, float_cdr, mcap_file, read_all, small_chunks, unfinished};
use std::fs;
use trench_bag::{BagError, BagReader, BagWriter, Stamp, WriteOptions};
use trench_core::Qos;

#[test]
fn a_bag_gives_back_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let written = finished(&path, 500).unwrap();
    let reader = BagReader::open(&path).unwrap();
    assert_eq!(reader.damage(), []);
    assert_eq!(reader.message_count(), 500);
    assert_eq!(reader.span(), Some((written[0].log_time, written[499].log_time)));
    assert_eq!(reader.topics().len(), 2);
    let float = &reader.topics()[reader.topic("/value").unwrap()];
    assert_eq!(float.topic_type(), FLOAT);
    assert!(float.offered_qos.contains("depth: 16"), "{}", float.offered_qos);
    assert_eq!(read_all(&reader).unwrap(), written);
    let alone = BagReader::open(&mcap_file(&path)).unwrap();
    assert_eq!(read_all(&alone).unwrap(), written);
}

#[test]
fn messages_come_in_log_order_however_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("disordered");
    let mut writer = BagWriter::create(&path, small_chunks()).unwrap();
    let topic = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
    let mut expected = Vec::new();
    for index in 0..2000_u64 {
        // Steps back by up to 700 places, across chunks; every time occurs several times.
        let log_time = 1000 + (index * 7919) % 700 / 3 + index / 700 * 200;
        writer.write(topic, Stamp { log_time, publish_time: index, sequence: 0 }, &float_cdr(index as f64)).unwrap();
        expected.push((log_time, index));
    }
    writer.finish().unwrap();
    expected.sort();
    let reader = BagReader::open(&path).unwrap();
    let read: Vec<_> = read_all(&reader).unwrap().iter().map(|m| (m.log_time, m.publish_time)).collect();
    assert_eq!(read, expected);
}

#[test]
fn an_empty_bag_is_a_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("empty");
    assert_eq!(finished(&path, 0).unwrap(), []);
    let reader = BagReader::open(&path).unwrap();
    assert_eq!((reader.message_count(), reader.span(), reader.damage()), (0, None, &[][..]));
    assert_eq!(reader.topics().len(), 2);
}

#[test]
fn a_bag_is_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    finished(&path, 3).unwrap();
    assert!(matches!(BagWriter::create(&path, WriteOptions::default()), Err(BagError::Exists(_))));
}

#[test]
fn a_killed_recorder_loses_only_its_open_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("killed");
    let (writer, written) = unfinished(&path, 500).unwrap();
    // What the file holds now is what a killed process leaves: forget the writer instead of closing it.
    std::mem::forget(writer);
    let reader = BagReader::open(&path).unwrap();
    let read = read_all(&reader).unwrap();
    assert!(read.len() > 450, "{} of 500 survived", read.len());
    assert_eq!(read, written[..read.len()]);
    assert_eq!(reader.damage().len(), 1, "{:?}", reader.damage());
    assert!(reader.damage()[0].what.contains("without a summary"));
}

#[test]
fn time_alone_closes_a_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slow");
    let options =
        WriteOptions { flush_after: Some(std::time::Duration::ZERO), disk_reserve: 0, ..WriteOptions::default() };
    let mut writer = BagWriter::create(&path, options).unwrap();
    let topic = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
    writer.write(topic, Stamp::default(), &float_cdr(1.0)).unwrap();
    assert_eq!(BagReader::open(&path).unwrap().message_count(), 1);
}

/// Of a simulation that the machine held up on its way.
#[test]
fn the_same_messages_make_the_same_bytes_however_long_they_take() {
    let folder = tempfile::tempdir().unwrap();
    let written = |place: &str, pause: std::time::Duration| {
        // A file says its own name.
        let path = folder.path().join(place).join("run");
        let mut writer = BagWriter::create(&path, WriteOptions::reproducible()).unwrap();
        let topic = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
        for index in 0..3_u64 {
            writer.write(topic, Stamp { log_time: index, publish_time: index, sequence: 0 }, &float_cdr(1.0)).unwrap();
            writer.flush_if_due().unwrap();
            std::thread::sleep(pause);
        }
        writer.finish().unwrap();
        fs::read(mcap_file(&path)).unwrap()
    };
    let hasty = written("hasty", std::time::Duration::ZERO);
    // Longer than what closes a chunk of a recorder.
    assert!(hasty == written("slow", std::time::Duration::from_millis(600)));
}

#[test]
fn a_full_disk_ends_the_recording_and_leaves_a_readable_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("full");
    // A reserve that no disk has: the first flush finds the disk full.
    let mut writer = BagWriter::create(&path, small_chunks()).unwrap();
    let topic = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
    writer.write(topic, Stamp::default(), &float_cdr(1.0)).unwrap();
    writer.set_disk_reserve(u64::MAX / 4);
    let error = writer.flush().unwrap_err();
    assert!(matches!(error, BagError::DiskFull { .. }), "{error}");
    assert!(matches!(writer.write(topic, Stamp::default(), &float_cdr(2.0)), Err(BagError::DiskFull { .. })));
    writer.finish().unwrap();
    let reader = BagReader::open(&path).unwrap();
    assert_eq!((reader.message_count(), reader.damage()), (1, &[][..]));
}

#[test]
fn a_disk_that_others_fill_is_noticed_though_nothing_is_due() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = BagWriter::create(&folder.path().join("filled"), small_chunks()).unwrap();
    writer.flush_if_due().unwrap();
    writer.set_disk_reserve(u64::MAX / 4);
    assert!(matches!(writer.flush_if_due(), Err(BagError::DiskFull { .. })));
}

#[test]
fn what_is_no_bag_is_refused_with_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let check = |name: &str, content: Option<&[u8]>, expected: &str| {
        let path = folder.path().join(name);
        if let Some(content) = content {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, content).unwrap();
        }
        let open = if name.ends_with("metadata.yaml") { path.parent().unwrap() } else { path.as_path() };
        let error = BagReader::open(open).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{name}: {error:?} does not say {expected:?}");
        assert!(error.contains(folder.path().to_str().unwrap()), "{name}: {error:?} does not say where");
    };
    check("missing", None, "No such file");
    check("text.mcap", Some(b"not a bag"), "is not an MCAP file");
    check("empty.mcap", Some(b""), "is not an MCAP file");
    check(
        "a/metadata.yaml",
        Some(b"rosbag2_bagfile_information:\n  relative_file_paths: []\n  storage_identifier: mcap\n"),
        "holds neither",
    );
    check(
        "b/metadata.yaml",
        Some(b"rosbag2_bagfile_information:\n  relative_file_paths: [x.db3]\n  storage_identifier: sqlite3\n"),
        "sqlite3",
    );
    check("c/metadata.yaml", Some(b"something: else\n"), "rosbag2_bagfile_information");
    check("d/metadata.yaml", Some(b"rosbag2_bagfile_information:\n  relative_file_paths: [x.mcap]\n  storage_identifier: mcap\n  compression_mode: FILE\n"), "compression_mode");
    fs::create_dir(folder.path().join("folder")).unwrap();
    check("folder", None, "holds neither");
}
