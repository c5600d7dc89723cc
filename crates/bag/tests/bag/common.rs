//! Bags for the tests.

use std::path::{Path, PathBuf};
use trench_bag::{BagError, BagReader, BagWriter, Stamp, TopicType, WriteOptions};
use trench_core::Qos;

/// `std_msgs/msg/Float64`, and a type with a dependency.
pub(crate) const FLOAT: TopicType<'static> = TopicType {
    name: "std_msgs/msg/Float64",
    hash: "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a",
    definition: "float64 data\n",
};
/// `geometry_msgs/msg/Pose2D`-like, with a nested type.
pub(crate) const NESTED: TopicType<'static> = TopicType {
    name: "trench_test/msg/Nested",
    hash: "",
    definition: concat!(
        "trench_test/Inner inner\nstring text\n",
        "================================================================================\n",
        "MSG: trench_test/Inner\nint32 a\nfloat32 b\n"
    ),
};

/// One message as it was written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Written {
    pub(crate) topic: String,
    pub(crate) log_time: u64,
    pub(crate) publish_time: u64,
    pub(crate) sequence: u32,
    pub(crate) cdr: Vec<u8>,
}

pub(crate) fn float_cdr(value: f64) -> Vec<u8> {
    [&[0, 1, 0, 0][..], &value.to_le_bytes()].concat()
}

pub(crate) fn nested_cdr(a: i32, b: f32, text: &str) -> Vec<u8> {
    let mut cdr = [&[0, 1, 0, 0][..], &a.to_le_bytes(), &b.to_le_bytes()].concat();
    cdr.extend((text.len() as u32 + 1).to_le_bytes());
    cdr.extend(text.as_bytes());
    cdr.push(0);
    cdr
}

/// Options with small chunks, so that a small bag has many.
pub(crate) fn small_chunks() -> WriteOptions {
    WriteOptions { chunk_bytes: 2000, disk_reserve: 0, ..WriteOptions::default() }
}

/// Writes `count` messages on two topics into the new bag `directory` without finishing it.
pub(crate) fn unfinished(directory: &Path, count: usize) -> Result<(BagWriter, Vec<Written>), BagError> {
    let mut writer = BagWriter::create(directory, small_chunks())?;
    let float = writer.add_topic("/value", FLOAT, Qos::RELIABLE)?;
    let nested = writer.add_topic("/robot1/nested", NESTED, Qos::LATCHED)?;
    let mut written = Vec::new();
    for index in 0..count {
        let log_time = 1_700_000_000_000_000_000 + index as u64 * 10_000_000;
        let stamp = Stamp { log_time, publish_time: log_time - 1000, sequence: index as u32 + 1 };
        let (id, topic, cdr) = if index % 3 == 0 {
            (nested, "/robot1/nested", nested_cdr(index as i32 - 5, index as f32 / 3.0, &format!("número {index}")))
        } else {
            (float, "/value", float_cdr((index as f64).sin()))
        };
        writer.write(id, stamp, &cdr)?;
        let Stamp { log_time, publish_time, sequence } = stamp;
        written.push(Written { topic: topic.to_owned(), log_time, publish_time, sequence, cdr });
    }
    Ok((writer, written))
}

/// Writes and finishes a bag.
pub(crate) fn finished(directory: &Path, count: usize) -> Result<Vec<Written>, BagError> {
    let (writer, written) = unfinished(directory, count)?;
    writer.finish()?;
    Ok(written)
}

/// Everything a reader gives.
pub(crate) fn read_all(reader: &BagReader) -> Result<Vec<Written>, BagError> {
    let read = |message: trench_bag::BagMessage| Written {
        topic: reader.topics()[message.topic].name.clone(),
        log_time: message.log_time,
        publish_time: message.publish_time,
        sequence: message.sequence,
        cdr: message.to_vec(),
    };
    reader.messages().map(|message| message.map(read)).collect()
}

/// The `.mcap` file of a bag's folder.
pub(crate) fn mcap_file(directory: &Path) -> PathBuf {
    let name = directory.file_name().expect("a bag has a name").to_string_lossy();
    directory.join(format!("{name}_0.mcap"))
}
