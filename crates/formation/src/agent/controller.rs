//! One robot's controller from tick to tick.
use super::attract::Attracted;
use super::encroach::Encroachers;
use super::remedy::Remedy;
use super::surroundings::Moment;
use super::{Action, AgentSettings, Driven, Forces, Method, Powers, Surroundings, Work};
use crate::Vector2;
use crate::curve::Interval;
use crate::hull::{ApparentObstacle, Approach, HullError};
use crate::kinematics::PointState;
use crate::laws::{Attraction, NearestAttraction, Push, Steered, Terms, ZonedAttraction};
use crate::seek::{Fragments, Seeker};
use crate::trench::{Damping, Trench};
use std::sync::Arc;

/// A push within this of straight against the attraction (its sine) is turned by [`SIDESTEP`] (rad).
const HEAD_ON: f64 = 0.05;
const SIDESTEP: f64 = 0.15;

/// One robot's controller.
#[derive(Debug, Clone)]
pub struct Agent<T> {
    /// Shared by all robots that are clones of one.
    pub(super) settings: Arc<AgentSettings<T>>,
    pub(super) seeker: Seeker,
    pub(super) remedy: Remedy,
    pub(super) fragments: Fragments,
    pub(super) encroachers: Option<Encroachers>,
    /// Whether it has come to its place.
    pub(super) arrived: bool,
    /// Time of the last action, s.
    last: Option<f64>,
    sensed: Option<f64>,
}

impl<T: Trench> Agent<T> {
    /// A robot that has seen nothing yet.
    pub fn new(settings: AgentSettings<T>) -> Self {
        let (seeker, remedy, fragments) = (Seeker::default(), Remedy::default(), Fragments::default());
        let settings = Arc::new(settings);
        Self { settings, seeker, remedy, fragments, encroachers: None, arrived: false, last: None, sensed: None }
    }

    /// What it was made with.
    pub fn settings(&self) -> &AgentSettings<T> {
        &self.settings
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
        self.remedy.pause();
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
        self.remedy.way_out(from)
    }

    /// Begins a tick: seeks the qualified fragments anew (steps (1) to (3) of 7.5.2). While nothing moves that encroaches, once
    /// is enough.
    ///
    /// # Errors
    /// Robots ahead whose position is not finite, where robots encroach: the fragments stay as they were.
    pub fn sense(&mut self, around: &Surroundings<'_>) -> Result<(), HullError> {
        self.find_fragments(around)?;
        let elapsed = self.sensed.map_or(0.0, |sensed| around.time - sensed);
        self.sensed = Some(around.time);
        self.remedy.carry_on(around, elapsed);
        Ok(())
    }

    /// What a robot at `robot` does, `since` seconds after the tick. Others are carried on by their velocities.
    pub fn steer(&mut self, around: &Surroundings<'_>, robot: PointState, since: f64) -> Action {
        let moment = around.moment(since);
        let now = around.time + since;
        let step = self.last.map_or(0.0, |last| (now - last).max(0.0));
        self.last = Some(now);
        let attracted = self.attract(around, &moment, robot.position, step);
        self.arrived = attracted.deviation <= self.settings.seeking.settled_distance;
        let mut powers = Powers::default();
        let (steered, forces) = self.law(around, &moment, robot, &attracted, &mut powers);
        let draws = attracted.attracting.draws;
        Action {
            steered,
            acceleration: steered.acceleration,
            cut: false,
            cut_power: 0.0,
            powers,
            attraction: draws.then_some(attracted.attracting.foot.position),
            place: attracted.place,
            deviation: attracted.deviation,
            forces,
            zone: around.leader.map(|leader| {
                let distance = (leader.state.coasted(since).position - robot.position).norm();
                self.settings.zoning.zone(distance)
            }),
            remedy: self.remedy.state(),
        }
    }

    /// [`Self::steer`] within the limits of speed and acceleration relative to the segment, for a step of `step` (s).
    pub fn act(&mut self, around: &Surroundings<'_>, robot: PointState, since: f64, step: f64) -> Action {
        let mut action = self.steer(around, robot, since);
        let Some(limits) = self.settings.limits else { return action };
        let frame = around.moment(since).motion.at(robot.position);
        let sliding = robot.velocity - frame.velocity;
        let wanted = action.acceleration - frame.acceleration;
        let Forces { trench, zoning, robots, obstacles, .. } = action.forces;
        let walls = zoning + robots + obstacles;
        let terms = Terms { walls, attraction: trench, damping: wanted - walls - trench };
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
        let (mut cut, mut work) = (first.cut, Work::default());
        work.add(&first, step);
        for index in 1..count as u32 {
            let action = self.act(around, end, f64::from(index) * step, step);
            cut |= action.cut;
            work.add(&action, step);
            end = end.advanced_semi_implicit(action.acceleration, step);
        }
        let mean_velocity = (end.position - robot.position) / duration;
        Driven { end, mean_velocity, mean_acceleration: (end.velocity - robot.velocity) / duration, first, cut, work }
    }

    fn law(
        &self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        robot: PointState,
        attracted: &Attracted,
        powers: &mut Powers,
    ) -> (Steered, Forces) {
        let (settings, attracting, since) = (&self.settings, attracted.attracting, moment.since);
        let target = attracting.draws.then(|| attracting.foot.position - robot.position);
        let leader = around.leader.map(|leader| leader.state.coasted(since));
        let mut forces = Forces::default();
        let mut law = NearestAttraction {
            trench: &settings.law.trench,
            damping: settings.law.damping,
            leader_damping: settings.law.leader_damping,
        };
        if let (Some(offset), true) = (target, attracting.draws) {
            forces.trench = crate::laws::pull(&law.trench, offset);
        }
        if let (Method::Goal(Some(damping)), Some(offset)) = (settings.method, target) {
            law.damping = damping.coefficient(offset.norm());
        }
        let steered = match (settings.method, attracted.foot, leader) {
            (Method::Directed { direction, compensates }, Some(foot), Some(leader)) => {
                let directed = (direction.map(|direction| moment.segment.direction_in_map(direction)), compensates);
                self.directed(around, moment, (robot, leader), directed, (&foot, &mut forces, powers))
            }
            _ => {
                // Where the segment turns, robots at rest in it have different velocities: compared is what they do in it.
                let alike = leader.map(|leader| {
                    leader.velocity - moment.motion.at(leader.position).velocity + attracting.foot.velocity
                });
                let turn = |push: Push| self.sidestepped(push, target);
                let (position, still) = (robot.position, attracting.foot.velocity);
                let ahead = around.ahead.iter().map(|other| {
                    let there = other.coasted(since);
                    (turn(Push::of_robot_ahead(&settings.zoning, position, there.position)), there.velocity)
                });
                let leading = leader.map(|leader| {
                    let push = match attracted.led {
                        true => Push::of_robot_ahead(&settings.zoning, position, leader.position),
                        false => Push::of_leader(&settings.zoning, position, leader.position),
                    };
                    (push, leader.velocity)
                });
                let obstacles = self.obstacles_near(around, since, position).map(|index| {
                    let approach = self.approach(around, since, index, position);
                    (turn(Push::of_obstacle(&settings.potential, approach)), around.velocity(index))
                });
                let Forces { zoning, robots, obstacles: of_obstacles, .. } = &mut forces;
                let tell = |(push, velocity): (Push, Vector2<f64>), force: &mut Vector2<f64>, power: &mut f64| {
                    *force += push.force;
                    *power += push.force.dot(&(velocity - still));
                    push
                };
                let pushes = (ahead.map(|push| tell(push, robots, &mut powers.robots)))
                    .chain(leading.map(|push| tell(push, zoning, &mut powers.leader)))
                    .chain(obstacles.map(|push| tell(push, of_obstacles, &mut powers.obstacles)));
                law.steer(robot, attracting, alike, pushes)
            }
        };
        forces.damping = steered.acceleration - forces.trench - forces.zoning - forces.robots - forces.obstacles;
        (steered, forces)
    }

    /// (6.1), seen from the segment's frame, which it is written for.
    fn directed(
        &self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        (robot, leader): (PointState, PointState),
        (direction, compensates): (Option<Vector2<f64>>, bool),
        (foot, forces, powers): (&crate::curve::Foot, &mut Forces, &mut Powers),
    ) -> Steered {
        let settings = &self.settings;
        let seen = |state: PointState| PointState {
            velocity: state.velocity - moment.motion.at(state.position).velocity,
            ..state
        };
        let robot_seen = seen(robot);
        let across = direction.unwrap_or_else(|| Vector2::new(-foot.tangent.y, foot.tangent.x));
        let attraction = Attraction::on_line(robot_seen, across, foot.point, foot.tangent)
            .unwrap_or(Attraction { point: foot.point, velocity: Vector2::zeros() });
        forces.trench = crate::laws::pull(&settings.law.trench, attraction.point - robot.position);
        let law = ZonedAttraction {
            trench: &settings.law.trench,
            zoning: settings.zoning,
            damping: settings.law.damping,
            leader_damping: settings.law.leader_damping,
            compensates,
        };
        let leader_seen = seen(leader);
        let mut steered = law.steer(robot_seen, attraction, leader_seen, &[]);
        forces.zoning = Push::of_leader(&settings.zoning, robot.position, leader.position).force;
        powers.leader = forces.zoning.dot(&leader_seen.velocity);
        let still = moment.motion.at(robot.position).velocity;
        let mut add = |push: Push, velocity: Vector2<f64>, force: &mut Vector2<f64>, power: &mut f64| {
            steered.acceleration += push.force;
            steered.lyapunov += push.value;
            *force += push.force;
            *power += push.force.dot(&(velocity - still));
        };
        for other in around.ahead {
            let there = other.coasted(moment.since);
            let push = Push::of_robot_ahead(&settings.zoning, robot.position, there.position);
            add(push, there.velocity, &mut forces.robots, &mut powers.robots);
        }
        for index in self.obstacles_near(around, moment.since, robot.position) {
            let approach = self.approach(around, moment.since, index, robot.position);
            let push = Push::of_obstacle(&settings.potential, approach);
            add(push, around.velocity(index), &mut forces.obstacles, &mut powers.obstacles);
        }
        steered.acceleration += moment.motion.at(robot.position).acceleration;
        steered
    }

    /// The obstacles that may push a robot, by their indices: the others' potential is cut before it reaches so far.
    fn obstacles_near(
        &self,
        around: &Surroundings<'_>,
        since: f64,
        robot: Vector2<f64>,
    ) -> impl Iterator<Item = usize> {
        let cut = self.settings.potential.cut();
        let near = move |(index, obstacle): &(usize, &ApparentObstacle)| {
            self.remedy.concerns(obstacle.id)
                || !obstacle.shape.is_beyond(robot - around.displacement(*index, since), cut)
        };
        around.apparent.iter().enumerate().filter(near).map(|(index, _)| index)
    }

    fn approach(&self, around: &Surroundings<'_>, since: f64, index: usize, robot: Vector2<f64>) -> Approach {
        self.remedy.approach(around, since, index, robot)
    }

    /// A push against the attraction, turned to the robot's right where it would only stop it.
    fn sidestepped(&self, push: Push, target: Option<Vector2<f64>>) -> Push {
        let Some(target) = target.filter(|_| self.settings.sidesteps) else { return push };
        let (against, across) = (push.force.dot(&target), push.force.perp(&target));
        if against >= 0.0 || across.abs() > HEAD_ON * -against {
            return push;
        }
        let (sine, cosine) = libm::sincos(SIDESTEP);
        let [x, y] = [push.force.x, push.force.y];
        Push { force: Vector2::new(cosine * x - sine * y, sine * x + cosine * y), ..push }
    }
}
