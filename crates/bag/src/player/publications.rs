//! What the player publishes: the bag's topics with the types and the quality of service they were recorded with.

use super::settings::Settings;
use crate::Topic;
use trench_core::{Advertise, Local, Qos};
use trench_msgs::TypeInfo;
use trench_msgs::rosgraph_msgs::Clock;

/// The topic that tells the time.
const CLOCK: &str = "/clock";

/// Messages above this length do not belong on the network: images.
const LARGE: usize = 1 << 16;

/// The publications, each topic's place among them, and that of /clock.
pub(super) struct Publications {
    pub(super) advertised: Vec<Advertise>,
    pub(super) of_topic: Vec<Option<usize>>,
    pub(super) clock: Option<usize>,
}

impl Publications {
    /// `longest` is the length of the longest message of each topic, bytes.
    pub(super) fn new(topics: &[Topic], longest: &[usize], settings: &Settings) -> Self {
        let mut advertised = Vec::new();
        let mut of_topic = Vec::new();
        for (topic, &max_len) in topics.iter().zip(longest) {
            // The recorded clock would contradict this node's.
            let is_old_clock = topic.name == CLOCK && settings.has_clock();
            let is_played = settings.selection.takes(&topic.name) && topic.message_count > 0 && !is_old_clock;
            of_topic.push(is_played.then_some(advertised.len()));
            advertised.extend(is_played.then(|| advertise(topic, max_len)));
        }
        let clock = settings.has_clock().then_some(advertised.len());
        advertised.extend(clock.map(|_| Advertise::of::<Clock>(CLOCK, Qos::RELIABLE, Local::NetworkOnly)));
        Self { advertised, of_topic, clock }
    }
}

fn advertise(topic: &Topic, max_len: usize) -> Advertise {
    let is_image = matches!(&*topic.type_name, "sensor_msgs/msg/Image" | "sensor_msgs/msg/CompressedImage");
    let local = match is_image && max_len > LARGE {
        true => Local::SharedMemoryOnly { max_len },
        false => Local::SharedMemory { max_len },
    };
    Advertise { topic: topic.name.clone(), type_info: type_info(topic), qos: topic.qos(), local }
}

/// The type as the bag names it. It lives as long as the process, as those do that were known when it was built.
fn type_info(topic: &Topic) -> &'static TypeInfo {
    match trench_msgs::type_named(&topic.type_name) {
        Some(known) if topic.type_hash.is_empty() || topic.type_hash == known.hash => known,
        _ => crate::topic_type::leaked(topic.topic_type()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_types_keep_their_names_and_hashes() {
        let topic = |type_name: &str, type_hash: &str| Topic {
            name: "/x".to_owned(),
            type_name: type_name.to_owned(),
            type_hash: type_hash.to_owned(),
            definition: "float64 other\n".to_owned(),
            offered_qos: String::new(),
            message_count: 1,
        };
        let known = trench_msgs::type_named("std_msgs/msg/Float64").unwrap();
        assert_eq!(type_info(&topic("std_msgs/msg/Float64", "")), known);
        assert_eq!(type_info(&topic("std_msgs/msg/Float64", "RIHS01_x")).definition, "float64 other\n");
        assert_eq!(type_info(&topic("theirs/msg/Thing", "RIHS01_y")).hash, "RIHS01_y");
    }
}
