//! What every transport must do, tried on real processes: order, exactly once, latched messages, large messages,
//! restarts and sudden deaths of either side; services between processes. The same suite runs over both networks, each
//! with shared memory and without, and over shared memory alone.

#[cfg(test)]
#[path = "../common/mod.rs"]
mod common;
#[cfg(test)]
mod crowd;
#[cfg(test)]
mod modes;
#[cfg(test)]
mod router;
#[cfg(test)]
mod services;
#[cfg(test)]
mod topics;

use common::Island;

/// The ways from a writer to a reader of the same host, by the talker's parameter `local`.
const LOCAL: [&str; 3] = ["network", "shared_memory", "shared_memory_only"];

/// The networks, by RMW_IMPLEMENTATION.
#[derive(Clone, Copy)]
enum Network {
    Dds,
    Zenoh,
}

impl Network {
    /// An island of this network; `number` as for [`Island::new`].
    fn island(self, number: u16) -> Island {
        match self {
            Self::Dds => Island::new(number),
            Self::Zenoh => Island::with_router(number),
        }
    }

    /// A test's island for each local way.
    fn on_every_way(self, test: u16, check: impl Fn(&Island, &str)) {
        for (number, local) in LOCAL.iter().enumerate() {
            println!("over {local}");
            check(&self.island(test * 3 + number as u16), local);
        }
    }
}

/// One test a network for each of these checks.
macro_rules! on_every_network {
    ($($check:ident)*) => {
        mod dds {
            $(#[test] fn $check() { super::$check(crate::Network::Dds); })*
        }
        mod zenoh {
            $(#[test] fn $check() { super::$check(crate::Network::Zenoh); })*
        }
    };
}
use on_every_network;
