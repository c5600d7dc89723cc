//! CDR that ROS 2 itself made (ros2_cdr.py, with rclpy and Fast DDS) of one filled message of every standard type.

use std::collections::BTreeMap;
use trench_msgs::dynamic::{Schema, Value};
use trench_msgs::{Message, for_every_message};

fn vectors() -> BTreeMap<&'static str, Vec<u8>> {
    let lines = include_str!("ros2_cdr.json").lines();
    let pairs = lines.filter_map(|line| match line.split('"').collect::<Vec<_>>()[..] {
        [_, name, _, hex, _] => Some((name, hex)),
        _ => None,
    });
    pairs.map(|(name, hex)| (name, bytes(hex))).collect()
}

fn bytes(hex: &str) -> Vec<u8> {
    let digits: Vec<u8> = hex.chars().filter_map(|digit| digit.to_digit(16)).map(|digit| digit as u8).collect();
    digits.chunks_exact(2).map(|pair| 16 * pair[0] + pair[1]).collect()
}

/// Leaf `count` as the script fills it.
fn is_as_filled(value: &Value, count: usize) -> bool {
    match value {
        Value::Bool(value) => *value == (count % 2 == 1),
        Value::Text(text) => *text == format!("s{count}"),
        Value::Bytes(bytes) => bytes.iter().all(|byte| usize::from(*byte) == count) && bytes.len() >= 2,
        Value::Integer(value) => *value == count as i64,
        Value::Unsigned(value) => *value == count as u64,
        Value::Float32(value) => *value == count as f32,
        Value::Float64(value) => *value == count as f64,
        // Only a message without fields is a leaf.
        Value::List(_) | Value::Message(_) => count == 1,
    }
}

#[test]
fn all_values_are_read_and_written_as_ros_2_does() {
    fn check<M: Message>() {
        let name = M::TYPE.name;
        let vectors = vectors();
        let Some(theirs) = vectors.get(name) else {
            // Some packages come in no wheel; ours, which still change, are exchanged with a live rclpy by the interop tests.
            let without = ["tf2_msgs/", "rosbag2_interfaces/", "trench_msgs/"];
            assert!(without.iter().any(|package| name.starts_with(package)), "{name} has no vector");
            return;
        };
        let schema = Schema::parse(name, M::TYPE.definition).expect("our own definitions are understood");
        let value = schema.decode(theirs).unwrap_or_else(|error| panic!("{name}: {error}"));
        for (index, (path, leaf)) in value.leaves().into_iter().enumerate() {
            assert!(is_as_filled(leaf, index + 1), "{name}: {path} is {leaf}, leaf {}", index + 1);
        }
        let ours = M::decode(theirs).unwrap_or_else(|error| panic!("{name}: {error}")).to_cdr();
        assert_eq!(schema.decode(&ours), Ok(value), "{name}");
        // Messages without strings and sequences are padded to a multiple of four at the end.
        assert!((ours.len()..ours.len() + 4).contains(&theirs.len()), "{name}");
        // Their padding holds what was in memory, ours zeros; all other bytes are equal.
        assert!(ours.iter().zip(theirs).all(|(ours, theirs)| ours == theirs || *ours == 0), "{name}");
    }
    for_every_message!(check);
}
