//! How much shared memory a topic takes.

use trench_core::Qos;

/// Messages up to this length are small: every reader of a large team may keep many of them.
const SMALL: usize = 64 * 1024;

/// Limits of one topic's service. iceoryx2 reserves `readers * (buffered + borrowed)` messages a writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Limits {
    pub(super) writers: usize,
    pub(super) readers: usize,
    /// Messages that wait for one reader; beyond it the oldest is overwritten.
    pub(super) buffered: usize,
    /// Messages that one reader may look at at once.
    pub(super) borrowed: usize,
}

/// Processes that may use one topic.
pub(super) const NODES: usize = 128;

impl Limits {
    /// For messages of at most `max_len` bytes.
    pub(super) fn of(max_len: usize, qos: Qos) -> Self {
        if max_len <= SMALL {
            // A reader that is busy for a moment must not lose what the network would keep for it.
            Self { writers: 64, readers: 64, buffered: qos.depth.max(SMALL / max_len.max(1024)), borrowed: 2 }
        } else {
            Self { writers: 4, readers: 6, buffered: qos.depth.max(2), borrowed: 2 }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_do_not_fill_the_memory_of_a_container() {
        let image = 768 * 576 * 3 + 256;
        let limits = Limits::of(image, Qos::SENSOR);
        let bytes = limits.readers * (limits.buffered + limits.borrowed) * image;
        assert!(bytes < 48 << 20, "{bytes} bytes for one camera");
    }

    #[test]
    fn small_messages_wait_in_numbers() {
        assert_eq!(Limits::of(200, Qos::RELIABLE).buffered, 64);
        assert_eq!(Limits::of(200, Qos { depth: 1000, ..Qos::RELIABLE }).buffered, 1000);
        assert_eq!(Limits::of(SMALL, Qos::RELIABLE).buffered, 16);
    }
}
