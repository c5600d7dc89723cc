//! How long a message may be that says more than itself.

use std::sync::LazyLock;

/// RustDDS takes a path it knows nothing of for an Ethernet, bytes.
const ETHERNET: usize = 1500;
/// Where the MTU is not told, the least that IPv6 allows.
const LEAST: usize = 1280;
/// What RustDDS reserves of an MTU: IP and UDP (48), heartbeat (32), header of the sample (48).
const HEADERS: usize = 48 + 32 + 48;

/// The longest message that can say more than itself, bytes: its writer's own count, or in a response which request it answers.
/// Both are said in inline quality of service, and with that nobody can read what RustDDS 0.15.1 cuts up (it writes a byte too much;
/// a debug build of it panics). It cuts up what does not fit the smallest MTU on the way to any reader: an interface of this
/// host, or an Ethernet. For longer responses see [`super::long`].
pub(super) fn longest_annotated() -> usize {
    // RustDDS looks at the interfaces at its start too.
    static LONGEST: LazyLock<usize> =
        LazyLock::new(|| longest(netdev::get_interfaces().iter().map(|interface| interface.mtu)));
    *LONGEST
}

fn longest(mtus: impl Iterator<Item = Option<u32>>) -> usize {
    let known = mtus.map(|mtu| mtu.map_or(LEAST, |mtu| mtu as usize));
    known.chain([ETHERNET]).min().unwrap_or(LEAST).saturating_sub(HEADERS)
}

#[cfg(test)]
mod tests {
    use super::longest;

    #[test]
    fn the_smallest_mtu_counts() {
        assert_eq!(longest([Some(65_536)].into_iter()), 1372);
        assert_eq!(longest([Some(65_536), Some(1400)].into_iter()), 1272);
        assert_eq!(longest([Some(65_536), None].into_iter()), 1152);
        assert_eq!(longest(std::iter::empty()), 1372);
        assert_eq!(longest([Some(68)].into_iter()), 0);
    }
}
