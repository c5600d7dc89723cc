//! The stream of frames: their order, gaps and intervals.

use trench_core::{RosTime, Source, Steady};

/// What the frames so far say of the stream.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stream {
    last: Option<(Source, RosTime, Steady)>,
    /// Frames taken.
    pub(crate) frames: u64,
    /// Frames that never came.
    pub(crate) missed: u64,
    /// Frames not newer than the one before.
    pub(crate) stale: u64,
}

/// A clock that runs back this far was set anew, s: less is a frame out of order.
const SET_BACK: f64 = 1.0;
/// A clock that ran ahead of the monotonic one by this much between two frames was set anew, s: less may be a bag that is
/// played fast.
const SET_AHEAD: f64 = 60.0;
/// The interval assumed when it cannot be known, s.
const NOMINAL: f64 = 0.04;

impl Stream {
    /// The time from the previous frame to this one, s (0 for the first); None if the frame is not newer and must be left.
    pub(crate) fn take(&mut self, at: Steady, source: Source, stamp: RosTime) -> Option<f64> {
        let interval = match self.last {
            None => 0.0,
            Some((last_source, last_stamp, last_at)) => {
                let interval = stamp.seconds_since(last_stamp);
                if interval <= 0.0 && interval > -SET_BACK {
                    self.stale += 1;
                    return None;
                }
                if source.gid == last_source.gid {
                    self.missed += source.sequence.saturating_sub(last_source.sequence).saturating_sub(1);
                }
                let was_set = interval < 0.0 || interval > at.seconds_since(last_at) + SET_AHEAD;
                if was_set { NOMINAL } else { interval }
            }
        };
        self.last = Some((source, stamp, at));
        self.frames += 1;
        Some(interval)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_gaps_and_order() {
        let mut stream = Stream::default();
        let mut check = |gid: u8, sequence: u64, milliseconds: i64, expected: Option<f64>, counts: [u64; 3]| {
            let source = Source { gid: [gid; 16], sequence };
            let interval = stream.take(Steady(40_000_000 * sequence), source, RosTime(1_000_000 * milliseconds));
            assert_eq!(interval.map(|seconds| (seconds * 1e6).round() * 1e-6), expected, "frame {sequence}");
            assert_eq!([stream.frames, stream.missed, stream.stale], counts, "frame {sequence}");
        };
        check(1, 7, 5000, Some(0.0), [1, 0, 0]);
        check(1, 8, 5040, Some(0.04), [2, 0, 0]);
        check(1, 8, 5040, None, [2, 0, 1]);
        check(1, 11, 5160, Some(0.12), [3, 2, 1]);
        check(1, 10, 5120, None, [3, 2, 2]);
        // Another camera process counts from 1 again.
        check(2, 1, 5200, Some(0.04), [4, 2, 2]);
        // The clock was set back.
        check(2, 2, 10, Some(0.04), [5, 2, 2]);
        // And an hour ahead.
        check(2, 3, 3_600_050, Some(0.04), [6, 2, 2]);
        check(2, 4, 3_600_090, Some(0.04), [7, 2, 2]);
    }
}
