//! The formation in force.

use trench_core::RosTime;
use trench_msgs::msg::Formation;
use trench_msgs::std_msgs::Header;
use trench_plan::Plan;

/// A formation with its message, made once when it comes into force, and the robots that take part.
#[derive(Debug, Clone)]
pub(crate) struct Held {
    pub(crate) plan: Plan,
    /// Without a stamp.
    pub(crate) message: Formation,
    pub(crate) robots: Vec<String>,
    /// When it replaced another one during a run: its virtual points set out then.
    pub(crate) since: Option<RosTime>,
}

impl Held {
    /// `robots` are in order of name.
    pub(crate) fn new(plan: Plan, robots: Vec<String>) -> Self {
        let message = plan.message(Header::default());
        Self { plan, message, robots, since: None }
    }

    /// The message, stamped.
    pub(crate) fn stamped(&self, stamp: RosTime) -> Formation {
        let header = Header { stamp: stamp.into(), ..self.message.header.clone() };
        Formation { header, ..self.message.clone() }
    }
}
