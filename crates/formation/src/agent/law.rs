//! What a robot's law says, term by term.
use super::attract::{Attracted, Tie};
use super::surroundings::Moment;
use super::{Agent, Forces, Method, Powers, Surroundings, Values};
use crate::Vector2;
use crate::curve::Foot;
use crate::hull::Approach;
use crate::kinematics::PointState;
use crate::laws::{Attraction, NearestAttraction, Push, Seen, Steered, Unpushed, ZonedAttraction};
use crate::trench::{Damping, Trench};

/// A push within this of straight against the attraction (its sine) is turned by [`SIDESTEP`] (rad).
const HEAD_ON: f64 = 0.05;
const SIDESTEP: f64 = 0.15;
/// An obstacle whose middle is farther aside from the attraction than this (its sine) is passed on the other side, round the nearer end: at
/// the tip of a long one a turn towards the rest of it holds the robot there.
const ASIDE: f64 = 0.5;
/// A nearest point this far (m, per metre of distance and at all) from straight beside the robot is a corner or an end, which does not slide.
const BESIDE: f64 = 1e-9;

/// A law as far as its terms are added up.
#[derive(Default)]
pub(super) struct Sum {
    pub(super) steered: Steered,
    pub(super) forces: Forces,
    pub(super) powers: Powers,
    pub(super) values: Values,
    /// The point of attraction of (6.1), where that is the law, m.
    pub(super) met: Option<Vector2<f64>>,
}

/// What pushes a robot.
#[derive(Clone, Copy)]
enum By {
    Leader,
    Robot,
    Obstacle,
}

impl Sum {
    /// Adds the push of something that moves at `velocity` relative to the segment (m/s).
    #[inline(always)]
    fn add(&mut self, by: By, push: Push, velocity: Vector2<f64>) {
        self.steered.acceleration += push.force;
        self.steered.lyapunov += push.value;
        self.account(by, push, push.force, velocity);
    }

    /// Adds a push that a robot which slides at `sliding` relative to the segment (m/s) feels as `felt`: what was turned of it is no
    /// gradient, and does work of its own.
    #[inline(always)]
    fn add_turned(
        &mut self,
        by: By,
        (push, felt): (Push, Vector2<f64>),
        velocity: Vector2<f64>,
        sliding: Vector2<f64>,
    ) {
        self.steered.acceleration += felt;
        self.steered.lyapunov += push.value;
        self.account(by, push, felt, velocity);
        if felt != push.force {
            self.steered.lyapunov_rate += (felt - push.force).dot(&sliding);
        }
    }

    /// Notes down a push that the acceleration has already, as the robot feels it.
    #[inline(always)]
    fn account(&mut self, by: By, push: Push, felt: Vector2<f64>, velocity: Vector2<f64>) {
        let (force, power, value) = self.share(by);
        *force += felt;
        *power += push.force.dot(&velocity);
        *value += push.value;
    }

    #[inline(always)]
    fn share(&mut self, by: By) -> (&mut Vector2<f64>, &mut f64, &mut f64) {
        let Self { forces, powers, values, .. } = self;
        match by {
            By::Leader => (&mut forces.zoning, &mut powers.leader, &mut values.leader),
            By::Robot => (&mut forces.robots, &mut powers.robots, &mut values.robots),
            By::Obstacle => (&mut forces.obstacles, &mut powers.obstacles, &mut values.obstacles),
        }
    }
}

impl<T: Trench> Agent<T> {
    /// The law for a robot that is drawn so, and what its leader does.
    #[inline(always)]
    pub(super) fn law(
        &self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        (robot, leader): (PointState, Option<PointState>),
        attracted: &Attracted,
    ) -> Sum {
        let foot = attracted.foot.as_ref().filter(|_| attracted.tie == Tie::Whole);
        let mut sum = match (self.settings.method, foot, leader) {
            (Method::Directed { direction, compensates }, Some(foot), Some(leader)) => {
                let direction = direction.map(|direction| moment.segment.direction_in_map(direction));
                self.directed(around, moment, (robot, leader), (direction, compensates), foot)
            }
            _ => self.nearest(around, moment, (robot, leader), attracted),
        };
        let Forces { trench, sliding, zoning, robots, obstacles, .. } = sum.forces;
        sum.forces.damping = sum.steered.acceleration - trench - sliding - zoning - robots - obstacles;
        sum
    }

    /// (7.13), and the laws of which only the goal point is another.
    #[inline(always)]
    fn nearest(
        &self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        (robot, leader): (PointState, Option<PointState>),
        attracted: &Attracted,
    ) -> Sum {
        let (settings, attracting) = (&self.settings, attracted.attracting);
        let target = attracting.draws.then(|| attracting.foot.position - robot.position);
        let mut law = NearestAttraction {
            trench: &settings.law.trench,
            damping: settings.law.damping,
            leader_damping: settings.law.leader_damping,
        };
        if let (Method::Goal(Some(damping)), Some(offset)) = (settings.method, target) {
            law.damping = damping.coefficient(offset.norm());
        }
        let (position, still) = (robot.position, attracting.foot.velocity);
        // Where the segment turns, robots at rest in it have different velocities: compared is what they do in it.
        let alike = leader.map(|leader| leader.velocity - moment.motion.velocity_at(leader.position) + still);
        let seen = Seen {
            robot: (position, robot.velocity),
            foot: attracting.foot.into(),
            draws: attracting.draws,
            leader_velocity: alike,
        };
        let Unpushed { acceleration, trench, lyapunov, lyapunov_rate } = law.unpushed(&seen);
        let steered = Steered { acceleration, lyapunov, lyapunov_rate };
        let mut sum = Sum { steered, forces: Forces { trench, ..Forces::default() }, ..Sum::default() };
        let sliding = robot.velocity - still;
        for other in around.ahead {
            let there = other.coasted(moment.since);
            let push = Push::of_robot_ahead(&settings.zoning, position, there.position);
            sum.add_turned(By::Robot, self.sidestepped(push, target, None), there.velocity - still, sliding);
        }
        if let Some(leader) = leader {
            let push = match attracted.tie {
                Tie::Whole => Push::of_leader(&settings.zoning, position, leader.position),
                Tie::Gentle => Push::of_leader_by(&settings.law.trench, &settings.zoning, position, leader.position),
                Tie::Loose => Push::of_robot_ahead(&settings.zoning, position, leader.position),
            };
            sum.add(By::Leader, push, leader.velocity - still);
        }
        for index in self.obstacles_near(around, moment.since, position) {
            let (approach, rising) = self.approach(around, moment.since, index, position);
            let push = Push::of_obstacle(&settings.potential, approach);
            let middle = around.apparent[index].shape.middle() + around.displacement(index, moment.since) - position;
            sum.add_turned(
                By::Obstacle,
                self.sidestepped(push, target, Some(middle)),
                around.velocity(index) + rising - still,
                sliding,
            );
        }
        sum
    }

    /// (6.1), seen from the segment's frame, which it is written for.
    fn directed(
        &self,
        around: &Surroundings<'_>,
        moment: &Moment<'_>,
        (robot, leader): (PointState, PointState),
        (direction, compensates): (Option<Vector2<f64>>, bool),
        foot: &Foot,
    ) -> Sum {
        let settings = &self.settings;
        let seen = |state: PointState| PointState {
            velocity: state.velocity - moment.motion.velocity_at(state.position),
            ..state
        };
        let (robot_seen, leader_seen) = (seen(robot), seen(leader));
        let (direction, met) = self.point_of_attraction(moment, robot.position, direction, foot);
        let (point, slides) = (met.0.point, met.1);
        let velocity = Attraction::on_line(robot_seen, direction, point, met.0.tangent)
            .filter(|_| slides)
            .map_or(Vector2::zeros(), |attraction| attraction.velocity);
        let attraction = Attraction { point, velocity };
        let law = ZonedAttraction {
            trench: &settings.law.trench,
            zoning: settings.zoning,
            damping: settings.law.damping,
            leader_damping: settings.law.leader_damping,
            compensates,
        };
        let mut sum = Sum { steered: law.steer(robot_seen, attraction, leader_seen, &[]), ..Sum::default() };
        sum.forces.trench = crate::laws::pull(&settings.law.trench, point - robot.position);
        if slides {
            sum.forces.sliding = Attraction::sliding(sum.forces.trench, direction, met.0.tangent);
        }
        sum.met = Some(point);
        let (target, sliding) = (Some(point - robot.position), robot_seen.velocity);
        let push = Push::of_leader(&settings.zoning, robot.position, leader.position);
        // The law has the leader's push as it is.
        let repels = push.force.dot(&(leader.position - robot.position)) < 0.0;
        let (_, felt) = self.sidestepped(push, target.filter(|_| repels), None);
        if felt != push.force {
            sum.steered.acceleration += felt - push.force;
            sum.steered.lyapunov_rate += (felt - push.force).dot(&sliding);
        }
        sum.account(By::Leader, push, felt, leader_seen.velocity);
        let frame = moment.motion.at(robot.position);
        for other in around.ahead {
            let there = other.coasted(moment.since);
            let push = Push::of_robot_ahead(&settings.zoning, robot.position, there.position);
            let turned = self.sidestepped(push, target, None);
            sum.add_turned(By::Robot, turned, there.velocity - frame.velocity, sliding);
        }
        for index in self.obstacles_near(around, moment.since, robot.position) {
            let (approach, rising) = self.approach(around, moment.since, index, robot.position);
            let push = Push::of_obstacle(&settings.potential, approach);
            let middle = around.apparent[index].shape.middle() + around.displacement(index, moment.since);
            let turned = self.sidestepped(push, target, Some(middle - robot.position));
            sum.add_turned(By::Obstacle, turned, around.velocity(index) + rising - frame.velocity, sliding);
        }
        sum.steered.acceleration += frame.acceleration;
        sum
    }

    /// The direction of attraction in frame `map`, the point where it meets the qualified fragments, and whether that slides as the robot
    /// moves. Where a direction meets nothing it is not proper (6.3): what it passes most closely draws instead, and rests. Across the
    /// segment that point is the nearest one.
    fn point_of_attraction(
        &self,
        moment: &Moment<'_>,
        robot: Vector2<f64>,
        direction: Option<Vector2<f64>>,
        foot: &Foot,
    ) -> (Vector2<f64>, (Foot, bool)) {
        let Some(direction) = direction else {
            let offset = foot.point - robot;
            let is_beside = offset.dot(&foot.tangent).abs() <= BESIDE * (1.0 + offset.norm());
            return (Vector2::new(-foot.tangent.y, foot.tangent.x), (*foot, is_beside));
        };
        let met = moment.segment.attracting_along(robot, direction, self.fragments.intervals());
        (direction, met.unwrap_or((*foot, false)))
    }

    /// The obstacles that may push a robot, by their indices: the others' potential is cut before it reaches so far.
    fn obstacles_near(
        &self,
        around: &Surroundings<'_>,
        since: f64,
        robot: Vector2<f64>,
    ) -> impl Iterator<Item = usize> {
        let cut = self.settings.potential.cut();
        let near = move |index: &usize| {
            around.is_near(*index, since, robot, cut)
                || self.remedy.as_ref().is_some_and(|remedy| remedy.concerns(around.apparent[*index].id))
        };
        // A guard stands before an obstacle, by less than its potential reaches from the robot that it is for.
        let known = if around.clear > cut && self.remedy.is_none() { 0 } else { around.apparent.len() };
        (0..known).filter(near)
    }

    /// How an apparent obstacle lies to the robot, as the law sees it, and the velocity at which it rises, m/s.
    fn approach(
        &self,
        around: &Surroundings<'_>,
        since: f64,
        index: usize,
        robot: Vector2<f64>,
    ) -> (Approach, Vector2<f64>) {
        let id = around.apparent[index].id;
        let remedy = self.remedy.as_ref().filter(|remedy| remedy.concerns(id));
        let risen = self.risen.as_ref().filter(|_| remedy.is_none()).and_then(|risen| risen.seen(id));
        risen.unwrap_or_else(|| {
            let whole = || around.approach(index, since, robot);
            (remedy.map_or_else(whole, |remedy| remedy.approach(around, since, index, robot)), Vector2::zeros())
        })
    }

    /// A push, and its force as the robot feels it: against the attraction, where it would only stop the robot, turned to its right, or,
    /// where the `middle` of what pushes (from the robot, m) lies far to the right, to its left.
    fn sidestepped(
        &self,
        push: Push,
        target: Option<Vector2<f64>>,
        middle: Option<Vector2<f64>>,
    ) -> (Push, Vector2<f64>) {
        let Some(target) = target.filter(|_| self.settings.sidesteps) else { return (push, push.force) };
        let (against, across) = (push.force.dot(&target), push.force.perp(&target));
        if against >= 0.0 || across.abs() > HEAD_ON * -against {
            return (push, push.force);
        }
        let lies_right = middle.is_some_and(|middle| target.perp(&middle) < -ASIDE * target.norm() * middle.norm());
        let (sine, cosine) = libm::sincos(if lies_right { -SIDESTEP } else { SIDESTEP });
        let [x, y] = [push.force.x, push.force.y];
        (push, Vector2::new(cosine * x - sine * y, sine * x + cosine * y))
    }
}
