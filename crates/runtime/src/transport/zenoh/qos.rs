//! Quality of service as liveliness tokens carry it: what differs from ROS 2's defaults (reliable, volatile, keep last),
//! and the depth.

use trench_core::{Durability, Qos, Reliability};

/// What ROS 2 takes where a token names no depth.
const DEFAULT_DEPTH: usize = 42;

/// `<reliability>:<durability>:<history>,<depth>:<deadline>:<lifespan>:<liveliness>`, each of the last three with its
/// times; nothing stands for the default.
pub(super) fn encode(qos: Qos) -> String {
    let reliability = if qos.reliability == Reliability::BestEffort { "2" } else { "" };
    let durability = if qos.durability == Durability::TransientLocal { "1" } else { "" };
    format!("{reliability}:{durability}:,{}:,:,:,,", qos.depth.max(1))
}

/// What a token says, as far as it matters here.
pub(super) fn decode(text: &str) -> Qos {
    let mut parts = text.split(':');
    let reliability = parts.next();
    let durability = parts.next();
    let depth = parts.next().and_then(|history| history.split_once(',')).and_then(|(_, depth)| depth.parse().ok());
    Qos {
        reliability: if reliability == Some("2") { Reliability::BestEffort } else { Reliability::Reliable },
        durability: if durability == Some("1") { Durability::TransientLocal } else { Durability::Volatile },
        depth: depth.unwrap_or(DEFAULT_DEPTH).max(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_say_what_differs_from_the_defaults() {
        let check = |qos: Qos, text: &str| {
            assert_eq!(encode(qos), text);
            assert_eq!(decode(text), qos);
        };
        check(Qos { depth: 7, ..Qos::RELIABLE }, "::,7:,:,:,,");
        check(Qos::SENSOR, "2::,1:,:,:,,");
        check(Qos::LATCHED, ":1:,1:,:,:,,");
        assert_eq!(decode("1:2:1,:,:,:,,"), Qos { depth: 42, ..Qos::RELIABLE });
        assert_eq!(decode("").reliability, Reliability::Reliable);
    }
}
