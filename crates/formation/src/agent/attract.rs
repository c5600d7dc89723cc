//! What draws a robot: its goal or nearest point, unless a remedy asks for something else.
use super::remedy::{Asked, Drawn, Sight};
use super::surroundings::Moment;
use super::{Agent, Leader, Surroundings};
use crate::Vector2;
use crate::curve::Foot;
use crate::kinematics::PointState;
use crate::laws::{Attracting, GoalMotion};
use crate::seek::{LeaderView, Sought};
use crate::trench::Trench;

/// The point that draws a robot.
pub(super) struct Attracted {
    pub(super) attracting: Attracting,
    /// The point of the segment, where that is what draws.
    pub(super) foot: Option<Foot>,
    /// The nearest or goal point, whether it draws or not, m.
    pub(super) place: Option<Vector2<f64>>,
    /// Distance from it, m.
    pub(super) deviation: f64,
    /// How its leader draws it.
    pub(super) tie: Tie,
}

/// How a leader draws the robot behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Tie {
    /// By Psi.
    #[default]
    Whole,
    /// By the trench, to where Psi would pull less than that: a remedy has led the robot away from where Psi would have held it, or it comes
    /// back to its team by itself. From as far as it may be now, the full acceleration of zone 5 would drive it through whatever stands between.
    Gentle,
    /// Not at all: a remedy leads the robot, and the attraction would hold it back.
    Loose,
}

impl<T: Trench> Agent<T> {
    #[inline(always)]
    pub(super) fn attract(
        &mut self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        (robot, leader): (Vector2<f64>, Option<PointState>),
        step: f64,
    ) -> Attracted {
        let goal = around.goal_after(moment.since);
        let (drawn, foot) = match goal {
            Some(goal) => (Drawn::Goal(goal.position), goal),
            None => match self.seek(around, moment, (robot, leader)) {
                Sought::Point(foot) => (Drawn::To(foot), moment.motion.at(foot.point)),
                Sought::Tie | Sought::NoFragment => {
                    let attracting = Attracting { foot: moment.motion.at(robot), draws: false };
                    return Attracted { attracting, foot: None, place: None, deviation: f64::INFINITY, tie: self.tie };
                }
            },
        };
        let deviation = (foot.position - robot).norm();
        let asked = match &self.settings.remedies {
            Some(remedies) => {
                let (potential, zoning) = (&self.settings.potential, &self.settings.zoning);
                let fragments = self.fragments.intervals();
                let sight = Sight { remedies, potential, zoning, fragments, around, moment, step };
                self.remedy.get_or_insert_default().update(&sight, robot, drawn)
            }
            None => Asked::Attraction,
        };
        let attracting = match asked {
            Asked::Attraction => Attracting { foot, draws: true },
            Asked::Suspension => Attracting { foot: moment.motion.at(robot), draws: false },
            Asked::Point(point) => Attracting { foot: GoalMotion::at_rest(point), draws: true },
        };
        let on_segment = match (asked, drawn) {
            (Asked::Attraction, Drawn::To(foot)) => Some(foot),
            _ => None,
        };
        // Where Psi pulls less than the trench would, it does no harm.
        let (zoning, trench) = (&self.settings.zoning, &self.settings.law.trench);
        let is_back = || {
            leader.is_none_or(|leader| {
                let apart = (leader.position - robot).norm();
                let beyond = apart - zoning.radii().rho;
                beyond <= 0.0 || zoning.force(apart) <= trench.slope(beyond)
            })
        };
        self.tie = match (asked, self.tie) {
            (Asked::Point(_), _) => Tie::Loose,
            _ if leader.is_none() && goal.is_some() => Tie::Gentle,
            (_, Tie::Loose | Tie::Gentle) if !is_back() => Tie::Gentle,
            _ => Tie::Whole,
        };
        Attracted { attracting, foot: on_segment, place: Some(drawn.point()), deviation, tie: self.tie }
    }

    #[inline(always)]
    fn seek(
        &mut self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        (robot, leader): (Vector2<f64>, Option<PointState>),
    ) -> Sought {
        let place = self.leaders_place(around);
        let leader = around.leader.zip(leader).map(|(Leader { deviation, .. }, state)| {
            let speed = (state.velocity - moment.motion.velocity_at(state.position)).norm();
            let view = LeaderView { position: place.unwrap_or(state.position), distance: deviation, speed };
            (view, self.settings.zoning.radii())
        });
        let whole = around.curve.domain();
        self.seeker.seek(&self.settings.seeking, &moment.segment, (whole, &self.fragments), robot, leader)
    }
}
