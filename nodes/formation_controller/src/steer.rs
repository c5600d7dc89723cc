//! A dynamic law's part of a tick: what is around the robot, the law up to the next tick, a twist.

use crate::dynamic::{Ahead, Around, DynamicSettings, Encroaching, Frame, MovingHull};
use crate::hold::Hold;
use crate::tick::{Command, Tick, Wanted};
use trench_core::{RosTime, Times};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, Placed};
use trench_formation::hull::{Obstacle, Outline, Shape};
use trench_formation::kinematics::{PointState, Pose, Twist, twist_of_hand};
use trench_formation::laws::{GoalMotion, Lyapunov};
use trench_formation::seek::{Fragments, apparent_obstacles};
use trench_msgs::msg::{LeaderState, Member};

/// Twists that differ by less than this are the same.
const SAME: f64 = 1e-9;

impl Tick {
    /// Steers by a dynamic law from the pose at which the command will act.
    pub(crate) fn steer(
        &mut self,
        settings: &DynamicSettings,
        (at, acts): (Times, RosTime),
        ahead: Pose,
        goal: GoalMotion,
        command: &mut Command,
    ) -> Result<Wanted, Hold> {
        let member = self.inputs.member(&self.settings.robot).ok_or(Hold::NoPlace)?.clone();
        let frame = self.inputs.frame(acts).ok_or(Hold::NoGoal)?;
        let duration = self.inputs.interval().min(self.settings.period);
        let robot = PointState {
            position: ahead.position() + settings.look_ahead * ahead.heading(),
            velocity: self.reference.unwrap_or_else(|| self.told(settings, ahead, acts)),
        };
        // Who follows nobody is drawn to its goal point as the chain leader is (Remark 8.4.1).
        let follows = !(member.leader.is_empty() || command.lost);
        let rank = if follows { member.rank } else { 1 };
        let ahead_in_chain = if follows { self.robots_ahead(settings, &member, (at, acts)) } else { Ok(Vec::new()) };
        let others = match ahead_in_chain {
            Ok(others) => others,
            Err(hold) => return self.slow_down(settings, robot, ahead, duration, hold, command),
        };
        let apart = others.last().map(|leader| (leader.state.position - robot.position).norm());
        command.beyond_reach = apart.filter(|apart| *apart > settings.zoning.radii().rho_bar);
        let segments = self.inputs.segments.clone().ok_or(Hold::NoPlace)?;
        let segment = segments.curve(member.queue);
        if settings.law.seeks(rank) && segment.is_none() {
            return Err(Hold::NoPlace);
        }
        let hulls = self.hulls();
        let fragments =
            segment.map_or_else(Fragments::default, |curve| self.fragments(settings, curve, &frame, (&hulls, &others)));
        let around = Around { goal, frame, segment, rank, ahead: &others, hulls: &hulls, fragments: &fragments };
        let driven = self.agent.drive(settings, &around, robot, duration);
        if driven.cut {
            command.limits |= LeaderState::LIMIT_WHEELS;
        }
        self.reference = Some(driven.end);
        let distance = driven.drawn.map_or(0.0, |drawn| (drawn - robot.position).norm());
        Ok(Wanted {
            twist: self.twist(settings, ahead, driven.mean, duration),
            drawn: driven.drawn,
            distance,
            lyapunov: Lyapunov { value: driven.steered.lyapunov, rate: driven.steered.lyapunov_rate + driven.limited },
            acceleration: driven.acceleration,
            detour: driven.drawn.filter(|_| settings.detours),
        })
    }

    /// The twist that moves the steered point by `mean` (m/s), at the heading of the middle of the tick.
    fn twist(&self, settings: &DynamicSettings, ahead: Pose, mean: Vector2<f64>, duration: f64) -> Twist {
        if mean.norm() < settings.rest_speed {
            return Twist::ZERO;
        }
        let first = twist_of_hand(ahead.theta, settings.look_ahead, mean);
        let most = self.settings.max_wheel_speed / self.settings.axle.half_track;
        let middle = ahead.theta + 0.5 * duration * first.omega.clamp(-most, most);
        twist_of_hand(middle, settings.look_ahead, mean)
    }

    /// The velocity of the steered point under the command that is in force at `time`.
    fn told(&self, settings: &DynamicSettings, ahead: Pose, time: RosTime) -> Vector2<f64> {
        hand_velocity(settings.look_ahead, ahead, self.predictor.in_force(time))
    }

    /// Where limits or the filter changed the twist, the law goes on from what the robot really does.
    pub(crate) fn follow_limits(&mut self, ahead: Pose, wanted: Twist, sent: Twist) {
        let Some(settings) = &self.settings.dynamic else { return };
        let differs = (wanted.v - sent.v).abs() + (wanted.omega - sent.omega).abs() > SAME;
        if differs {
            self.reference = Some(hand_velocity(settings.look_ahead, ahead, sent));
        }
    }

    /// The robots ahead in the chain at `acts`, the leader last.
    fn robots_ahead(
        &self,
        settings: &DynamicSettings,
        member: &Member,
        (at, acts): (Times, RosTime),
    ) -> Result<Vec<Ahead>, Hold> {
        if !settings.law.is_chained() || member.rank <= 1 {
            return Ok(Vec::new());
        }
        let mut others: Vec<(u32, Ahead)> = Vec::new();
        for other in self.inputs.members_ahead(member) {
            match self.inputs.teammate(&other.robot, (at.steady, acts), settings.leader_age) {
                Some(ahead) => others.push((other.rank, ahead)),
                // Those farther ahead only matter when they come near, and then the filter sees them.
                None if other.rank + 1 < member.rank => {}
                None => return Err(Hold::NoLeader(other.robot.clone())),
            }
        }
        if others.last().is_none_or(|(rank, _)| rank + 1 != member.rank) {
            return Err(Hold::NoLeader(member.leader.clone()));
        }
        Ok(others.into_iter().map(|(_, ahead)| ahead).collect())
    }

    /// A follower whose leader is silent comes to rest as its limits let it.
    fn slow_down(
        &mut self,
        settings: &DynamicSettings,
        robot: PointState,
        ahead: Pose,
        duration: f64,
        hold: Hold,
        command: &mut Command,
    ) -> Result<Wanted, Hold> {
        command.limits |= LeaderState::LIMIT_STALE;
        let slower = robot.velocity.norm() - settings.capability.acceleration * duration;
        if slower <= settings.rest_speed {
            return Err(hold);
        }
        let end = robot.velocity.cap_magnitude(slower);
        self.reference = Some(end);
        command.hold = Some(hold);
        Ok(Wanted {
            twist: self.twist(settings, ahead, 0.5 * (robot.velocity + end), duration),
            drawn: None,
            distance: 0.0,
            lyapunov: Lyapunov::default(),
            acceleration: (end - robot.velocity) / duration,
            detour: None,
        })
    }

    /// The apparent obstacles as the law sees them, and the robots that have no part in the formation.
    fn hulls(&self) -> Vec<MovingHull> {
        let heard = self.inputs.obstacles.iter().flat_map(|heard| &heard.message);
        let hulls = heard.filter_map(|hull| {
            // What is no hull stops the robot in the safety filter.
            let shape = Shape::new(&hull.points, hull.radius).ok()?;
            Some(MovingHull { shape, velocity: hull.velocity })
        });
        let strangers = self.inputs.strangers(&self.settings.robot).filter_map(|stranger| {
            let shape = Shape::new(&[Vector2::new(stranger.x, stranger.y)], self.settings.body_radius).ok()?;
            Some(MovingHull { shape, velocity: Vector2::zeros() })
        });
        hulls.chain(strangers).collect()
    }

    /// Steps (1) to (3) of 7.5.2 for this robot: hulls, and the robots ahead of it where they count, take parts of its
    /// segment away.
    fn fragments(
        &self,
        settings: &DynamicSettings,
        curve: &Curve,
        frame: &Frame,
        (hulls, ahead): (&[MovingHull], &[Ahead]),
    ) -> Fragments {
        let segment = Placed::new(curve, frame.map_from_segment());
        let whole = (0.0, curve.length());
        let find = |outlines: &[Outline<'_>]| {
            Fragments::find(&segment, whole, outlines, settings.potential.cut(), settings.seeking.room)
        };
        let outlines: Vec<Outline<'_>> = hulls.iter().map(|hull| hull.shape.outline()).collect();
        match settings.encroaching {
            Encroaching::Nothing => Fragments::whole(whole),
            Encroaching::Obstacles => find(&outlines),
            Encroaching::ObstaclesAndRobots => {
                let real: Vec<Obstacle> =
                    (0..).zip(hulls).map(|(id, hull)| Obstacle { id, shape: hull.shape.clone() }).collect();
                let positions: Vec<Vector2<f64>> = ahead.iter().map(|other| other.state.position).collect();
                let merged = apparent_obstacles(&real, &positions, self.settings.body_radius, settings.clearance);
                match merged {
                    Ok(merged) => find(&merged.iter().map(|one| one.shape.outline()).collect::<Vec<_>>()),
                    Err(_) => find(&outlines),
                }
            }
        }
    }

    /// What followers hear of the steered point: where it was at the exposure, and how it moved.
    pub(crate) fn steered_point(&self, command: &Command) -> Option<(Vector2<f64>, Vector2<f64>)> {
        let (settings, pose) = (self.settings.dynamic.as_ref()?, command.pose?);
        let position = pose.position() + settings.look_ahead * pose.heading();
        Some((position, self.told(settings, pose, command.exposure)))
    }

    /// Distance of the robot's centre at the exposure from its segment, and the queue's tolerance, m.
    pub(crate) fn segment_distance(&self, command: &Command) -> Option<(f64, f64)> {
        let member = self.inputs.member(&self.settings.robot)?;
        let frame = self.inputs.frame(command.exposure)?;
        self.inputs.segments.as_ref()?.distance(command.pose?.position(), member.queue, &frame)
    }
}

/// How the point `look_ahead` metres in front of the axle moves under `twist`.
fn hand_velocity(look_ahead: f64, pose: Pose, twist: Twist) -> Vector2<f64> {
    let heading = pose.heading();
    twist.v * heading + look_ahead * twist.omega * Vector2::new(-heading.y, heading.x)
}
