//! Nodes and ends of topics and services: as key expressions of their data, and as liveliness tokens.

use super::qos;
use crate::transport::network::Gid;
use trench_core::Qos;
use xxhash_rust::xxh3::xxh3_128;

/// Where the tokens are.
const ADMINISTRATION: &str = "@ros2_lv";

/// Stands where a token names no type hash.
const ANY: &str = "*";

/// What an end is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Publisher,
    Subscription,
    Server,
    Client,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Publisher, Self::Subscription, Self::Server, Self::Client];

    fn code(self) -> &'static str {
        match self {
            Self::Publisher => "MP",
            Self::Subscription => "MS",
            Self::Server => "SS",
            Self::Client => "SC",
        }
    }

    /// Who is at the other end.
    pub(super) fn opposite(self) -> Self {
        match self {
            Self::Publisher => Self::Subscription,
            Self::Subscription => Self::Publisher,
            Self::Server => Self::Client,
            Self::Client => Self::Server,
        }
    }
}

/// A node in its session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NodeToken {
    pub(super) domain: u16,
    pub(super) session: String,
    pub(super) number: u64,
    pub(super) namespace: String,
    pub(super) name: String,
}

impl NodeToken {
    /// Its token, `@ros2_lv/0/<session>/0/0/NN/%/%/listener`.
    pub(super) fn key(&self) -> String {
        self.prefix(self.number, "NN")
    }

    fn prefix(&self, number: u64, code: &str) -> String {
        let Self { domain, session, number: node, namespace, name } = self;
        // Security enclaves are Zenoh's own configuration here: none is named.
        format!("{ADMINISTRATION}/{domain}/{session}/{node}/{number}/{code}/%/{}/{name}", mangle(namespace))
    }

    /// The token of the end number `number` of this node.
    pub(super) fn entity_key(&self, number: u64, entity: &Entity) -> String {
        let Entity { kind, name, type_name, type_hash, qos } = entity;
        let prefix = self.prefix(number, kind.code());
        format!("{prefix}/{}/{type_name}/{type_hash}/{}", mangle(name), qos::encode(*qos))
    }
}

/// An end of a topic or service.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Entity {
    pub(super) kind: Kind,
    /// The absolute name.
    pub(super) name: String,
    /// As DDS mangles it: `std_msgs::msg::dds_::String_`.
    pub(super) type_name: String,
    pub(super) type_hash: String,
    pub(super) qos: Qos,
}

impl Entity {
    /// An end of topic or service `name` of type `package/msg/Name`.
    pub(super) fn new(kind: Kind, name: &str, ros_type: &str, type_hash: &str, qos: Qos) -> Self {
        let type_name = match ros_type.rsplit_once('/') {
            Some((package, name)) => format!("{}::dds_::{name}_", package.replace('/', "::")),
            None => format!("dds_::{ros_type}_"),
        };
        Self { kind, name: name.to_owned(), type_name, type_hash: type_hash.to_owned(), qos }
    }

    /// The key expression of its messages or requests.
    pub(super) fn data_key(&self, domain: u16) -> String {
        format!("{domain}/{}/{}/{}", self.name.trim_matches('/'), self.type_name, self.type_hash)
    }

    /// What a token says: whose session and which end. Nothing for nodes and what is no token of ROS.
    pub(super) fn parse(key: &str) -> Option<(&str, Self)> {
        let parts: Vec<&str> = key.split('/').collect();
        let [
            ADMINISTRATION,
            _domain,
            session,
            _node,
            _number,
            code,
            _enclave,
            _namespace,
            _name,
            name,
            type_name,
            hash,
            qos,
            ..,
        ] = parts[..]
        else {
            return None;
        };
        let kind = Kind::ALL.into_iter().find(|kind| kind.code() == code)?;
        let (type_name, type_hash) = (type_name.to_owned(), hash.to_owned());
        Some((session, Self { kind, name: name.replace('%', "/"), type_name, type_hash, qos: qos::decode(qos) }))
    }

    /// The type as ROS names it; what is none of ROS stays as it is.
    pub(super) fn ros_type(&self) -> String {
        let parts = self.type_name.split_once("::dds_::");
        let parts = parts.and_then(|(package, name)| Some((package, name.strip_suffix('_')?)));
        parts.map_or_else(|| self.type_name.clone(), |(package, name)| format!("{}/{name}", package.replace("::", "/")))
    }

    /// Whether both are ends of one topic or service that talk with each other.
    pub(super) fn matches(&self, other: &Self) -> bool {
        let same_type = self.type_hash == other.type_hash || self.type_hash == ANY || other.type_hash == ANY;
        self.kind == other.kind.opposite() && self.name == other.name && self.type_name == other.type_name && same_type
    }
}

/// All tokens of a domain.
pub(super) fn all_tokens(domain: u16) -> String {
    format!("{ADMINISTRATION}/{domain}/**")
}

/// The identity of who shows this token: its hash, the lower half first.
pub(super) fn gid(token: &str) -> Gid {
    xxh3_128(token.as_bytes()).to_le_bytes()
}

/// Tokens have no room for slashes nor for nothing.
fn mangle(name: &str) -> String {
    if name.is_empty() { "%".to_owned() } else { name.replace('/', "%") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HASH: &str = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";

    fn node(namespace: &str) -> NodeToken {
        let session = "aac3178e146ba6f1fc6e6a4085e77f21".to_owned();
        NodeToken { domain: 2, session, number: 0, namespace: namespace.to_owned(), name: "talker".to_owned() }
    }

    #[test]
    fn keys_are_those_of_rmw_zenoh() {
        let qos = Qos { depth: 7, ..Qos::RELIABLE };
        let chatter = Entity::new(Kind::Publisher, "/chatter", "std_msgs/msg/String", HASH, qos);
        assert_eq!(chatter.data_key(0), format!("0/chatter/std_msgs::msg::dds_::String_/{HASH}"));
        let session = "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0";
        assert_eq!(node("/").key(), format!("{session}/0/NN/%/%/talker"));
        assert_eq!(node("/hall/west").key(), format!("{session}/0/NN/%/%hall%west/talker"));
        let token = node("/").entity_key(10, &chatter);
        let expected = format!("{session}/10/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/{HASH}/::,7:,:,:,,");
        assert_eq!(token, expected);
        assert_eq!(Entity::parse(&token), Some(("aac3178e146ba6f1fc6e6a4085e77f21", chatter)));
    }

    #[test]
    fn nodes_and_foreign_tokens_are_no_ends() {
        for key in
            [node("/").key().as_str(), "@ros2_lv", "", "0/chatter", "@ros2_lv/0/a/0/1/XX/%/%/n/%t/T_/h/::,1:,:,:,,"]
        {
            assert_eq!(Entity::parse(key), None, "{key}");
        }
    }

    #[test]
    fn ends_match_by_name_type_and_hash() {
        let end = |kind, name, hash| Entity::new(kind, name, "std_msgs/msg/String", hash, Qos::RELIABLE);
        let check = |other: Entity, expected| {
            let publisher = end(Kind::Publisher, "/chatter", HASH);
            assert_eq!(publisher.matches(&other), expected, "{other:?}");
            assert_eq!(other.matches(&publisher), expected, "{other:?}");
        };
        check(end(Kind::Subscription, "/chatter", HASH), true);
        check(end(Kind::Subscription, "/chatter", "*"), true);
        check(end(Kind::Subscription, "/chatter", "RIHS01_00"), false);
        check(end(Kind::Subscription, "/talk", HASH), false);
        check(end(Kind::Publisher, "/chatter", HASH), false);
        check(end(Kind::Client, "/chatter", HASH), false);
    }

    #[test]
    fn types_are_named_as_ros_does() {
        let named =
            |text: &str| Entity { type_name: text.to_owned(), ..Entity::new(Kind::Server, "", "", "", Qos::SENSOR) };
        assert_eq!(named("std_srvs::srv::dds_::Trigger_").ros_type(), "std_srvs/srv/Trigger");
        assert_eq!(named("Shape").ros_type(), "Shape");
    }
}
