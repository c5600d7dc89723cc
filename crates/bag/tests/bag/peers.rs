//! Bags exchanged with programs of others: `rosbags` and `mcap-ros2-support` from PyPI, in the virtual environment that
//! `scripts/ros-venv` builds (`$TRENCH_VENV`, or `.venv` in the repository).

use crate::common::{FLOAT, Written, finished, float_cdr, mcap_file, read_all, small_chunks};
use std::path::{Path, PathBuf};
use std::process::Command;
use trench_bag::{BagReader, BagWriter, Compression, Stamp, WriteOptions};
use trench_core::Qos;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs a program of tests/interop and gives the lines it prints.
fn run(program: &str, arguments: &[&str]) -> Vec<String> {
    let venv = std::env::var_os("TRENCH_VENV").map_or_else(|| repository().join(".venv"), PathBuf::from);
    let python = venv.join("bin/python3");
    let script = repository().join("tests/interop").join(program);
    let output = Command::new(&python).arg(script).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}; run scripts/ros-venv", python.display()));
    assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn rosbags_reads_every_message() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let written = finished(&path, 200).unwrap();
    let lines = run("bag_rosbags.py", &[path.to_str().unwrap()]);
    assert_eq!(lines.len(), written.len());
    for (line, Written { topic, log_time, cdr, .. }) in lines.iter().zip(&written) {
        for part in [format!("\"{topic}\""), format!(": {log_time},"), format!("\"{}\"", hex(cdr))] {
            assert!(line.contains(&part), "{line} lacks {part}");
        }
    }
    let hash = "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a";
    assert!(lines[1].contains(hash), "{}", lines[1]);
}

#[test]
fn rosbags_reads_a_bag_of_several_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("split");
    let written = crate::split::split(&path, None, Some(std::time::Duration::from_secs(3)));
    let lines = run("bag_rosbags.py", &[path.to_str().unwrap()]);
    assert_eq!(lines.len(), written.len());
    for (line, Written { topic, log_time, cdr, .. }) in lines.iter().zip(&written) {
        for part in [format!("\"{topic}\""), format!(": {log_time},"), format!("\"{}\"", hex(cdr))] {
            assert!(line.contains(&part), "{line} lacks {part}");
        }
    }
}

#[test]
fn both_peers_read_bags_without_compression() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plain");
    let options = WriteOptions { compression: Compression::Off, ..small_chunks() };
    let mut writer = BagWriter::create(&path, options).unwrap();
    let topic = writer.add_topic("/value", FLOAT, Qos::RELIABLE).unwrap();
    for index in 0..500_u64 {
        writer.write(topic, Stamp { log_time: index, ..Stamp::default() }, &float_cdr(index as f64)).unwrap();
    }
    writer.finish().unwrap();
    for (program, file) in [("bag_rosbags.py", path.clone()), ("bag_mcap_ros2.py", mcap_file(&path))] {
        let lines = run(program, &[file.to_str().unwrap()]);
        assert_eq!(lines.len(), 500);
        for (index, line) in lines.iter().enumerate() {
            assert!(line.contains(&hex(&float_cdr(index as f64))), "{line}");
        }
    }
    assert_eq!(read_all(&BagReader::open(&path).unwrap()).unwrap().len(), 500);
}

#[test]
fn mcap_ros2_support_decodes_every_message() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let written = finished(&path, 200).unwrap();
    let lines = run("bag_mcap_ros2.py", &[mcap_file(&path).to_str().unwrap()]);
    assert_eq!(lines.len(), written.len());
    for (line, Written { topic, log_time, publish_time, sequence, cdr }) in lines.iter().zip(&written) {
        let times = format!("\"log_time\": {log_time}, \"publish_time\": {publish_time}, \"sequence\": {sequence},");
        for part in [format!("\"{topic}\""), times, format!("\"{}\"", hex(cdr))] {
            assert!(line.contains(&part), "{line} lacks {part}");
        }
    }
    assert!(lines[3].contains(r#""message": {"inner": {"a": -2, "b": 1.0}, "text": "n\u00famero 3"}"#), "{}", lines[3]);
}

#[test]
fn bags_written_by_rosbags_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("theirs");
    run("bag_write_rosbags.py", &[path.to_str().unwrap(), "150"]);
    let reader = BagReader::open(&path).unwrap();
    assert_eq!(reader.damage(), []);
    assert_eq!(reader.topics()[0].type_name, "std_msgs/msg/Float64");
    let read = read_all(&reader).unwrap();
    assert_eq!(read.len(), 150);
    for (index, message) in read.iter().enumerate() {
        assert_eq!(message.log_time, 1_000_000_000 + index as u64 * 10_000_000);
        assert_eq!(message.cdr, float_cdr(index as f64));
    }
}
