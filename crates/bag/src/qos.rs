//! Quality of service as rosbag2 writes it (bag format 9: names instead of numbers).

use serde::Serialize;
use trench_core::{Durability, Qos, Reliability};

/// ROS 2's infinite duration.
const INFINITE: Period = Period { sec: 9_223_372_036, nsec: 854_775_807 };

/// One entry of `offered_qos_profiles`.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct OfferedQos {
    history: &'static str,
    depth: usize,
    reliability: &'static str,
    durability: &'static str,
    deadline: Period,
    lifespan: Period,
    liveliness: &'static str,
    liveliness_lease_duration: Period,
    avoid_ros_namespace_conventions: bool,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Period {
    sec: i64,
    nsec: i64,
}

impl From<Qos> for OfferedQos {
    fn from(qos: Qos) -> Self {
        Self {
            history: "keep_last",
            depth: qos.depth,
            reliability: match qos.reliability {
                Reliability::Reliable => "reliable",
                Reliability::BestEffort => "best_effort",
            },
            durability: match qos.durability {
                Durability::Volatile => "volatile",
                Durability::TransientLocal => "transient_local",
            },
            deadline: INFINITE,
            lifespan: INFINITE,
            liveliness: "automatic",
            liveliness_lease_duration: INFINITE,
            avoid_ros_namespace_conventions: false,
        }
    }
}
