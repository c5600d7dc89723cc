//! Quality of service as rosbag2 writes it: names in bags of format 9, numbers before.

use serde::{Deserialize, Serialize};
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

/// What counts of anybody's `offered_qos_profiles`.
#[derive(Deserialize)]
struct Profile {
    #[serde(default)]
    depth: usize,
    reliability: Policy,
    durability: Policy,
}

/// rmw's name of a policy, or its number.
#[derive(Deserialize)]
#[serde(untagged)]
enum Policy {
    Number(i64),
    Name(String),
}

impl Policy {
    fn is(&self, name: &str, number: i64) -> bool {
        match self {
            Self::Number(found) => *found == number,
            Self::Name(found) => found == name,
        }
    }
}

/// Profiles deeper than this are cut: the past of a latched topic is kept in memory.
const DEEPEST: usize = 1000;

/// What all writers that offered `profiles` can promise together; [`Qos::RELIABLE`] where that is not to be read.
pub(crate) fn common(profiles: &str) -> Qos {
    let profiles: Vec<Profile> = serde_saphyr::from_str(profiles).unwrap_or_default();
    if profiles.is_empty() {
        return Qos::RELIABLE;
    }
    let all = |kept: fn(&Profile) -> bool| profiles.iter().all(kept);
    Qos {
        reliability: match all(|profile| profile.reliability.is("reliable", 1)) {
            true => Reliability::Reliable,
            false => Reliability::BestEffort,
        },
        durability: match all(|profile| profile.durability.is("transient_local", 1)) {
            true => Durability::TransientLocal,
            false => Durability::Volatile,
        },
        depth: profiles.iter().map(|profile| profile.depth).max().unwrap_or_default().clamp(1, DEEPEST),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(profiles: &str, expected: Qos) {
        assert_eq!(common(profiles), expected, "{profiles}");
    }

    #[test]
    fn what_is_written_is_read() {
        for qos in [Qos::RELIABLE, Qos::LATCHED, Qos::SENSOR] {
            check(&serde_saphyr::to_string(&[OfferedQos::from(qos)]).unwrap(), qos);
        }
    }

    #[test]
    fn numbers_of_older_bags_are_understood() {
        check("- {history: 1, depth: 5, reliability: 2, durability: 2}", Qos { depth: 5, ..Qos::SENSOR });
        check(
            "- history: 3\n  depth: 0\n  reliability: 1\n  durability: 1\n  lifespan: {sec: 0, nsec: 0}",
            Qos::LATCHED,
        );
    }

    #[test]
    fn several_writers_promise_what_each_of_them_does() {
        let latched = "- {depth: 1, reliability: reliable, durability: transient_local}\n";
        check(&latched.repeat(2), Qos::LATCHED);
        check(&format!("{latched}- {{depth: 16, reliability: reliable, durability: volatile}}"), Qos::RELIABLE);
        check(&format!("{latched}- {{depth: 1, reliability: best_effort, durability: volatile}}"), Qos::SENSOR);
    }

    #[test]
    fn what_is_not_understood_is_reliable() {
        check("", Qos::RELIABLE);
        check("[]", Qos::RELIABLE);
        check("- {depth: [", Qos::RELIABLE);
    }
}
