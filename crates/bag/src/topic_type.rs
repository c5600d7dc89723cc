//! Message types as bags name them.

use trench_msgs::TypeInfo;

/// A message type, known at build time or read from somewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TopicType<'a> {
    /// For example `nav_msgs/msg/Odometry`.
    pub name: &'a str,
    /// Its RIHS01 hash; empty where it is not known.
    pub hash: &'a str,
    /// The root .msg text and those of all dependencies (`ros2msg`).
    pub definition: &'a str,
}

impl From<&'static TypeInfo> for TopicType<'static> {
    fn from(info: &'static TypeInfo) -> Self {
        Self { name: info.name, hash: info.hash, definition: info.definition }
    }
}

/// A type that was not known at build time, as ports want it: it lives as long as the process. There are only so many
/// types in a graph or a bag.
pub(crate) fn leaked(of: TopicType<'_>) -> &'static TypeInfo {
    let text = |text: &str| &*Box::leak(text.to_owned().into_boxed_str());
    Box::leak(Box::new(TypeInfo { name: text(of.name), hash: text(of.hash), definition: text(of.definition) }))
}
