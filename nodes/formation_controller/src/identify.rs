//! The one command without a pose: a small turn on the spot, by which the localizer finds out which robot this is.

use crate::robot::CLOCK_ERROR;
use crate::tick::Tick;
use trench_core::{RosTime, Times};
use trench_formation::kinematics::Twist;

/// No faster, rad/s, whatever is asked: below the speed that steppers start and stop at without a ramp.
const FASTEST: f64 = 1.2;

impl Tick {
    /// The turn that is asked of this robot now. Bodies are round: on the spot they come nearer to nothing, so that the safety
    /// filter, which needs to know where the robot is, has nothing to add.
    pub(crate) fn identifying(&self, at: Times) -> Option<Twist> {
        let heard = self.inputs.identify.as_ref().filter(|heard| heard.message.robot == self.settings.robot)?;
        let stamped = at.ros.seconds_since(RosTime::from(&heard.message.header.stamp));
        let age = stamped.max(at.steady.seconds_since(heard.at));
        let omega = heard.message.omega;
        let usable = !self.inputs.emergency_stop
            && omega.is_finite()
            && (-CLOCK_ERROR..=self.settings.pose_age_limit).contains(&stamped)
            && age <= self.settings.pose_age_limit;
        usable.then(|| Twist { v: 0.0, omega: omega.clamp(-FASTEST, FASTEST) })
    }
}
