//! The keys of rosbag2's player.

/// What a key asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Key {
    /// Space: pause, or go on.
    TogglePaused,
    /// Cursor right: the next message, while paused.
    PlayNext,
    /// Cursor up.
    Faster,
    /// Cursor down.
    Slower,
}

/// By how much cursor up and down change the rate.
pub(super) const RATE_STEP: f64 = 1.1;

/// For the operator.
pub(super) const HELP: &str = "keys: space pauses, cursor right plays the next message while paused, cursor up and \
                               down change the rate";

/// Finds keys among the bytes of a terminal, which may cut the three bytes of a cursor key.
#[derive(Debug, Default)]
pub(super) struct Keys {
    /// How many bytes of `ESC [` have come.
    escaped: u8,
}

impl Keys {
    /// The key that this byte completes, if any.
    pub(super) fn take(&mut self, byte: u8) -> Option<Key> {
        let escaped = std::mem::take(&mut self.escaped);
        match (escaped, byte) {
            (_, 0x1b) => self.escaped = 1,
            // `ESC O` where the terminal is in application mode.
            (1, b'[' | b'O') => self.escaped = 2,
            (2, b'A') => return Some(Key::Faster),
            (2, b'B') => return Some(Key::Slower),
            (2, b'C') => return Some(Key::PlayNext),
            (0, b' ') => return Some(Key::TogglePaused),
            _ => {}
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_among_bytes() {
        let check = |bytes: &[u8], expected: &[Key]| {
            let mut keys = Keys::default();
            assert_eq!(bytes.iter().filter_map(|&byte| keys.take(byte)).collect::<Vec<_>>(), expected, "{bytes:?}");
        };
        check(b" x ", &[Key::TogglePaused, Key::TogglePaused]);
        check(b"\x1b[A\x1b[B\x1bOC", &[Key::Faster, Key::Slower, Key::PlayNext]);
        check(b"\x1b\x1b[A", &[Key::Faster]);
        check(b"\x1b[5~ABC", &[]);
    }
}
