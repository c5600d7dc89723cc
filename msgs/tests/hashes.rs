//! The type hashes against those that ROS 2's own packages state, and known ones of services.

use trench_msgs::{services, type_named, types};

/// Name and hash of each line `"name": "hash"`.
fn entries(json: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    json.lines().filter_map(|line| match line.split('"').collect::<Vec<_>>()[..] {
        [_, name, _, hash, _] => Some((name, hash)),
        _ => None,
    })
}

#[test]
fn hashes_of_messages_are_those_of_ros_2() {
    let mut count = 0;
    for (name, expected) in entries(include_str!("type_hashes.json")) {
        let info = type_named(name).unwrap_or_else(|| panic!("{name} is not generated"));
        assert_eq!(info.hash, expected, "{name}");
        count += 1;
    }
    assert_eq!(count, 44);
}
