//! ROS 2's quality of service in DDS's words.

use rustdds::qos::policy;
use rustdds::{Duration, QosPolicies, QosPolicyBuilder};
use trench_core::{Durability, Qos, Reliability};

/// Samples that wait in the reader's cache until the event loop takes them, at least: eight seconds of poses, or a tenth of a second of
/// the fastest. RustDDS drops the oldest ones beyond it, and keeps those that were taken as well: a process's memory grows to so
/// many of every topic that it hears.
const UNREAD: i32 = 256;
/// The same where only the newest is asked for: half a second of a camera, whose pictures of 1.3 MB take 20 MB then.
const UNSEEN: i32 = 16;

/// What a writer offers. A write never blocks (zero blocking time): what does not fit the send window waits in the
/// writer's own queue.
pub(crate) fn writer(qos: Qos) -> QosPolicies {
    let kept = common(qos).history(policy::History::KeepLast { depth: depth(qos) });
    match qos.durability {
        Durability::Volatile => kept.build(),
        // RustDDS keeps a latched writer's whole past while nobody reads it, up to this limit, which is also how many
        // messages may be unacknowledged.
        Durability::TransientLocal => kept.resource_limits(limits(depth(qos).max(LATCHED))).build(),
    }
}

/// Messages of a latched topic that may be on their way at once.
const LATCHED: i32 = 32;

fn limits(max_samples: i32) -> policy::ResourceLimits {
    policy::ResourceLimits { max_samples, max_instances: 1, max_samples_per_instance: max_samples }
}

/// What a writer of another process offers. Its depth is that of the past which late readers get; not all tell it.
pub(crate) fn offered(policies: &QosPolicies) -> Qos {
    Qos {
        reliability: match policies.reliability() {
            Some(policy::Reliability::Reliable { .. }) => Reliability::Reliable,
            Some(policy::Reliability::BestEffort) | None => Reliability::BestEffort,
        },
        durability: match policies.durability() {
            Some(policy::Durability::Volatile) | None => Durability::Volatile,
            Some(_) => Durability::TransientLocal,
        },
        depth: match policies.history() {
            Some(policy::History::KeepLast { depth }) => usize::try_from(depth).unwrap_or(1).max(1),
            Some(policy::History::KeepAll) | None => 1,
        },
    }
}

/// What a reader asks for. The history is the cache between RustDDS's thread and the event loop, not a ROS queue, hence
/// mostly deeper than `qos.depth`.
pub(crate) fn reader(qos: Qos) -> QosPolicies {
    let depth = depth(qos).max(if qos == Qos::SENSOR { UNSEEN } else { UNREAD });
    // Without limits RustDDS keeps 64 at least.
    common(qos).history(policy::History::KeepLast { depth }).resource_limits(limits(depth)).build()
}

/// Requests and responses of services, as ROS 2's default for services.
pub(crate) const SERVICE: Qos = Qos { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 64 };

fn common(qos: Qos) -> QosPolicyBuilder {
    let durability = match qos.durability {
        Durability::Volatile => policy::Durability::Volatile,
        Durability::TransientLocal => policy::Durability::TransientLocal,
    };
    let reliability = match qos.reliability {
        Reliability::BestEffort => policy::Reliability::BestEffort,
        Reliability::Reliable => policy::Reliability::Reliable { max_blocking_time: Duration::ZERO },
    };
    QosPolicyBuilder::new().durability(durability).reliability(reliability)
}

fn depth(qos: Qos) -> i32 {
    i32::try_from(qos.depth.max(1)).unwrap_or(i32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_asks_for_the_newest_alone_does_not_keep_minutes_of_pictures() {
        let kept = |qos| match (reader(qos).history(), reader(qos).resource_limits()) {
            (Some(policy::History::KeepLast { depth }), Some(limits)) if limits.max_samples == depth => depth,
            kept => panic!("{kept:?}"),
        };
        assert_eq!(kept(Qos::SENSOR), 16);
        assert_eq!(kept(Qos::RELIABLE), 256);
        assert_eq!(kept(Qos::LATCHED), 256);
        assert_eq!(kept(Qos { depth: 1000, ..Qos::RELIABLE }), 1000);
    }
}
