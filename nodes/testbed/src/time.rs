//! The bed's time as ROS time.

use trench_core::{RosTime, Times};

/// The ROS time of an instant of the monotonic clock.
pub(crate) fn ros(at: Times, instant: u64) -> RosTime {
    let ago = at.steady.0 as i64 - instant as i64;
    RosTime(at.ros.0 - ago)
}
