//! One robot's controller from tick to tick.
use super::attract::Tie;
use super::encroach::Encroachers;
use super::law::Sum;
use super::remedy::Remedy;
use super::risen::{Pace, Risen};
use super::surroundings::Moment;
use super::{Action, AgentSettings, Driven, RemedyState, Surroundings, Work};
use crate::Vector2;
use crate::curve::Interval;
use crate::hull::HullError;
use crate::kinematics::PointState;
use crate::laws::Terms;
use crate::seek::{Fragments, Seeker};
use crate::trench::Trench;
use std::sync::Arc;

/// Without remedies, which say how fast, a hull rises through the whole potential in this time, s.
const RISING: f64 = 1.0;

/// One robot's controller.
#[derive(Debug, Clone)]
pub struct Agent<T> {
    /// Shared by all robots that are clones of one.
    pub(super) settings: Arc<AgentSettings<T>>,
    pub(super) seeker: Seeker,
    /// What few robots need is kept apart: a step passes over thousands of them.
    pub(super) remedy: Option<Box<Remedy>>,
    pub(super) risen: Option<Box<Risen>>,
    pub(super) fragments: Fragments,
    pub(super) encroachers: Option<Box<Encroachers>>,
    /// How its leader draws it.
    pub(super) tie: Tie,
    /// Whether it has come to its place.
    pub(super) arrived: bool,
    /// Time of the last action, s.
    pub(super) last: Option<f64>,
    sensed: Option<f64>,
}

impl<T: Trench> Agent<T> {
    /// A robot that has seen nothing yet.
    pub fn new(settings: AgentSettings<T>) -> Self {
        let (seeker, fragments) = (Seeker::default(), Fragments::default());
        let settings = Arc::new(settings);
        let tie = Tie::default();
        Self {
            settings,
            seeker,
            remedy: None,
            risen: None,
            fragments,
            encroachers: None,
            tie,
            arrived: false,
            last: None,
            sensed: None,
        }
    }

    /// What it was made with.
    pub fn settings(&self) -> &AgentSettings<T> {
        &self.settings
    }

    /// The same, to have beside it.
    pub(crate) fn shared(&self) -> Arc<AgentSettings<T>> {
        self.settings.clone()
    }

    /// Goes on under other settings: with the nearest point that it has, and the remedy that is under way.
    pub fn set(&mut self, settings: AgentSettings<T>) {
        self.settings = Arc::new(settings);
        self.encroachers = None;
    }

    /// The segment is another one: neither the nearest point nor the fragments that it has are on it.
    pub fn renew(&mut self) {
        self.seeker = Seeker::default();
        self.encroachers = None;
        self.arrived = false;
    }

    /// The robot is told to rest, whatever its law says: standing still is no sign now that it is caught.
    pub fn pause(&mut self) {
        if let Some(remedy) = &mut self.remedy {
            remedy.pause();
        }
        self.last = None;
    }

    /// Arc length of the nearest point that it keeps, m.
    pub fn kept(&self) -> Option<f64> {
        self.seeker.kept()
    }

    /// Its qualified fragments of the segment, m of arc length.
    pub fn fragments(&self) -> &[Interval] {
        self.fragments.intervals()
    }

    /// The guard, or the way out of a hull, that a robot at `from` goes by, m: for those who draw it. Empty without a remedy.
    pub fn way_out(&self, from: Vector2<f64>) -> Vec<Vector2<f64>> {
        self.remedy.as_ref().map_or_else(Vec::new, |remedy| remedy.way_out(from))
    }

    /// Begins a tick: seeks the qualified fragments anew (steps (1) to (3) of 7.5.2). While nothing moves that encroaches, once
    /// is enough.
    ///
    /// # Errors
    /// Robots ahead whose position is not finite, where robots encroach: the fragments stay as they were.
    pub fn sense(&mut self, around: &Surroundings<'_>) -> Result<(), HullError> {
        self.find_fragments(around, None)?;
        self.carry_on(around);
        Ok(())
    }

    /// [`Self::sense`] where robots encroach, and the one ahead has sensed just now: the same, sooner.
    pub(crate) fn sense_behind(&mut self, teammate: &Self, around: &Surroundings<'_>) -> Result<(), HullError> {
        self.find_fragments(around, teammate.encroachers.as_deref())?;
        self.carry_on(around);
        Ok(())
    }

    /// [`Self::sense`] where robots do not encroach: a teammate has the same fragments.
    pub(crate) fn sense_as(&mut self, teammate: &Self, around: &Surroundings<'_>) {
        self.fragments = teammate.fragments.clone();
        self.carry_on(around);
    }

    fn carry_on(&mut self, around: &Surroundings<'_>) {
        let elapsed = self.sensed.map_or(0.0, |sensed| around.time - sensed);
        self.sensed = Some(around.time);
        if let Some(remedy) = &mut self.remedy {
            remedy.carry_on(around, elapsed);
        }
    }

    /// What a robot at `robot` does, `since` seconds after the tick. Others are carried on by their velocities.
    pub fn steer(&mut self, around: &Surroundings<'_>, robot: PointState, since: f64) -> Action {
        self.steer_at(around, &around.moment(since), robot)
    }

    /// What [`Self::steer`] would say, which the robot does not do: it remembers nothing of it, and is not helped by remedies.
    pub fn foreseen(&self, around: &Surroundings<'_>, robot: PointState, since: f64) -> Action {
        let (settings, fragments) = (self.settings.clone(), self.fragments.clone());
        let (remedy, risen, encroachers, last, sensed) = (None, None, None, None, None);
        let mut other = Self { settings, fragments, remedy, risen, encroachers, last, sensed, ..*self };
        other.steer(around, robot, since)
    }

    #[inline(always)]
    fn steer_at(&mut self, around: &Surroundings<'_>, moment: &Moment<'_>, robot: PointState) -> Action {
        let now = around.time + moment.since;
        let step = self.last.map(|last| (now - last).max(0.0));
        self.last = Some(now);
        self.look_for_hulls(around, moment.since, robot, step);
        let step = step.unwrap_or(0.0);
        let leader = around.leader.map(|leader| leader.state.coasted(moment.since));
        let attracted = self.attract(around, moment, (robot.position, leader), step);
        self.arrived = attracted.deviation <= self.settings.seeking.settled_distance;
        let Sum { steered, forces, powers, values, met } = self.law(around, moment, (robot, leader), &attracted);
        let draws = attracted.attracting.draws;
        Action {
            steered,
            acceleration: steered.acceleration,
            cut: false,
            cut_power: 0.0,
            powers,
            values,
            attraction: draws.then_some(met.unwrap_or(attracted.attracting.foot.position)),
            place: attracted.place,
            deviation: attracted.deviation,
            forces,
            zone: leader.map(|leader| self.settings.zoning.zone((leader.position - robot.position).norm())),
            remedy: self.remedy.as_ref().map_or(RemedyState::None, |remedy| remedy.state()),
        }
    }

    /// Sees how far hulls have risen; what is far from all of them remembers nothing.
    #[inline(always)]
    fn look_for_hulls(&mut self, around: &Surroundings<'_>, since: f64, robot: PointState, step: Option<f64>) {
        let cut = self.settings.potential.cut();
        let is_near = |index: usize| around.is_near(index, since, robot.position, cut);
        if around.clear > cut || !(0..around.apparent.len()).any(is_near) {
            self.risen = None;
            return;
        }
        let rising = self.settings.remedies.as_ref().map_or(cut / RISING, |remedies| remedies.rising);
        let mut risen = self.risen.take().unwrap_or_default();
        let instead = |index: usize| {
            let remedy = self.remedy.as_ref().filter(|remedy| remedy.concerns(around.apparent[index].id))?;
            Some(remedy.approach(around, since, index, robot.position).gap)
        };
        risen.follow(around, (since, robot), Pace { cut, rising, step }, instead);
        self.risen = Some(risen);
    }

    /// [`Self::steer`] within the limits of speed and acceleration relative to the segment, for a step of `step` (s).
    pub fn act(&mut self, around: &Surroundings<'_>, robot: PointState, since: f64, step: f64) -> Action {
        self.act_at(around, &around.moment(since), robot, step)
    }

    /// [`Self::act`], where what all robots of a team see alike is known.
    #[inline(always)]
    pub(crate) fn act_at(
        &mut self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        robot: PointState,
        step: f64,
    ) -> Action {
        let mut action = self.steer_at(around, moment, robot);
        let Some(limits) = self.settings.limits else { return action };
        let frame = moment.motion.at(robot.position);
        let sliding = robot.velocity - frame.velocity;
        let wanted = action.acceleration - frame.acceleration;
        let (walls, attraction) = (action.forces.walls(), action.forces.of_trench());
        let terms = Terms { walls, attraction, damping: wanted - walls - attraction };
        let cut = limits.saturate(sliding, terms, step);
        action.cut = cut != wanted;
        action.cut_power = (cut - wanted).dot(&sliding);
        action.acceleration = cut + frame.acceleration;
        action
    }

    /// Integrates the reference from `robot` for `duration` (s) in equal steps of about `step` (invariant: 1 ms), by semi-implicit Euler.
    pub fn drive(&mut self, around: &Surroundings<'_>, robot: PointState, duration: f64, step: f64) -> Driven {
        let count = libm::round(duration / step).max(1.0);
        let step = duration / count;
        let first = self.act(around, robot, 0.0, step);
        let mut end = robot.advanced_semi_implicit(first.acceleration, step);
        let is_pushed = |action: &Action| action.forces.obstacles != Vector2::zeros();
        let (mut cut, mut pushed, mut work) = (first.cut, is_pushed(&first), Work::default());
        work.add(&first, step);
        for index in 1..count as u32 {
            let action = self.act(around, end, f64::from(index) * step, step);
            cut |= action.cut;
            pushed |= is_pushed(&action);
            work.add(&action, step);
            end = end.advanced_semi_implicit(action.acceleration, step);
        }
        let mean_velocity = (end.position - robot.position) / duration;
        Driven {
            end,
            mean_velocity,
            mean_acceleration: (end.velocity - robot.velocity) / duration,
            first,
            cut,
            pushed,
            work,
        }
    }
}
