//! Topics that nobody announced beforehand: what type they have, and how to listen to them.

use super::topics;
use crate::TopicType;
use crate::topic_type::leaked;
use trench_core::{Discovered, Durability, Qos};
use trench_msgs::TypeInfo;

/// Messages that may wait for the recorder where all of them count.
const DEPTH: usize = 64;

/// Whether messages of this type are too large to be recorded without being asked for.
pub(super) fn is_image(type_name: &str) -> bool {
    matches!(type_name, "sensor_msgs/msg/Image" | "sensor_msgs/msg/CompressedImage")
}

/// The type of a topic, and what is to be said of it: a definition is in the bag only where it is that of the writer.
pub(super) fn type_info(found: &Discovered<'_>) -> (&'static TypeInfo, Option<String>) {
    let Discovered { topic, type_name, type_hash, .. } = *found;
    let known = trench_msgs::type_named(type_name);
    if let Some(known) = known.filter(|known| type_hash.is_empty() || type_hash == known.hash) {
        return (known, None);
    }
    let hash = if type_hash.is_empty() { "without a type hash" } else { type_hash };
    let problem = match known {
        Some(known) => {
            format!("{topic}: its writer has another {type_name} ({hash}) than this program ({})", known.hash)
        }
        None => format!("{topic}: {type_name} ({hash}) is no type of this program"),
    };
    let text = format!("{problem}; its messages are recorded without a definition");
    (leaked(TopicType { name: type_name, hash: type_hash, definition: "" }), Some(text))
}

/// How to listen: as the stack does where it knows the topic, else as the writer offers.
pub(super) fn qos(found: &Discovered<'_>) -> Qos {
    topics::known(found.topic).map_or_else(
        || match found.qos.durability {
            Durability::TransientLocal => found.qos,
            Durability::Volatile => Qos { depth: DEPTH, ..found.qos },
        },
        |(_, qos)| qos,
    )
}
