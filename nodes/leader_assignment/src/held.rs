//! The formation in force.

use trench_core::RosTime;
use trench_msgs::msg::Formation;
use trench_msgs::std_msgs::Header;
use trench_plan::Plan;

/// A formation with its message, made once when it comes into force, and the robots that take part.
#[derive(Debug, Clone)]
pub(crate) struct Held {
    /// As its file, or the message it came by, has it.
    pub(crate) original: Plan,
    /// Factor of all its lengths.
    pub(crate) scale: f64,
    /// The original at this scale.
    pub(crate) plan: Plan,
    /// Without a stamp.
    pub(crate) message: Formation,
    pub(crate) robots: Vec<String>,
    /// When it replaced one of another shape during a run: its virtual points set out then.
    pub(crate) since: Option<RosTime>,
}

impl Held {
    /// `robots` are in order of name.
    pub(crate) fn new(plan: Plan, robots: Vec<String>) -> Self {
        let message = plan.message(Header::default());
        Self { original: plan.clone(), scale: 1.0, plan, message, robots, since: None }
    }

    /// A plan with all its lengths times `scale`.
    ///
    /// # Errors
    /// A sentence about a curve that this leaves nothing of.
    pub(crate) fn at_scale(original: &Plan, scale: f64, robots: Vec<String>) -> Result<Self, String> {
        let plan = original.scaled(scale).map_err(|error| format!("{} times {scale}: {error}", original.name))?;
        Ok(Self { original: original.clone(), scale, ..Self::new(plan, robots) })
    }

    /// Whether virtual points that are on their way in `before` go on in this one: it is the same but for its size and its robots.
    pub(crate) fn goes_on_from(&self, before: &Self) -> bool {
        self.original.name == before.original.name && self.original.motion == before.original.motion
    }

    /// The message, stamped.
    pub(crate) fn stamped(&self, stamp: RosTime) -> Formation {
        let header = Header { stamp: stamp.into(), ..self.message.header.clone() };
        Formation { header, ..self.message.clone() }
    }
}
