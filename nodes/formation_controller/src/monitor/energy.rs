//! What the inputs bring into the Lyapunov function of a dynamic law.

use super::news::News;
use super::{Function, Watched};
use crate::dynamic::DynamicSettings;
use crate::inputs::Ahead;
use trench_core::RosTime;
use trench_formation::agent::{Driven, Surroundings};
use trench_formation::kinematics::PointState;
use trench_formation::stability::{Input, Supply};

/// A tick of a dynamic law.
pub(crate) struct Driving<'a> {
    pub(crate) settings: &'a DynamicSettings,
    pub(crate) around: &'a Surroundings<'a>,
    pub(crate) leader: Option<Ahead>,
    pub(crate) driven: &'a Driven,
    pub(crate) robot: PointState,
    pub(crate) acts: RosTime,
    /// s
    pub(crate) duration: f64,
    pub(crate) epoch: u64,
}

impl Driving<'_> {
    /// What the monitor looks at; `news` is what came otherwise than was expected at the tick before.
    pub(crate) fn watched(&self, news: Supply) -> Watched {
        let first = &self.driven.first;
        Watched {
            function: Function {
                law: Some(self.settings.law),
                epoch: self.epoch,
                draws: first.attraction.is_some(),
                remedy: first.remedy,
                goal: (0, false),
            },
            value: first.steered.lyapunov,
            rate: first.steered.lyapunov_rate + first.cut_power,
            gradient: (-first.forces.of_potentials(), 0.0),
            news,
            supply: supplied(self.driven, self.leader, self.settings.capability.speed, self.duration),
            expected: None,
        }
    }

    /// What is to be expected at the next tick.
    pub(crate) fn expected(&self) -> News {
        News::of(self.around, self.driven, self.robot, (self.acts, self.duration))
    }
}

/// What the inputs bring in up to the next tick. The leader's part is the recursion of chapter 8: its speed in the segment's frame is
/// within sqrt(2 V) of its own Lyapunov function, and within `speed` (m/s).
fn supplied(driven: &Driven, leader: Option<Ahead>, speed: f64, duration: f64) -> Supply {
    let mut supply = Supply::default();
    supply.add(Input::Law, driven.work.law);
    let admitted = leader.map_or(0.0, |leader| (2.0 * leader.lyapunov.max(0.0)).sqrt().min(speed));
    let most = duration * driven.first.forces.zoning.norm() * admitted;
    supply.add(Input::Leader, driven.work.leader.max(most));
    supply.add(Input::Robots, driven.work.robots);
    supply.add(Input::Obstacles, driven.work.obstacles);
    supply.add(Input::Limits, driven.work.limits);
    supply
}
