//! A dynamic law's part of a tick: what is around the robot, the law up to the next tick, a twist.

use crate::chain::Chain;
use crate::dynamic::{DynamicLaw, DynamicSettings, Reference};
use crate::hold::Hold;
use crate::markers::Picture;
use crate::monitor::Driving;
use crate::tick::{Command, Tick, Wanted};
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::agent::Surroundings;
use trench_formation::kinematics::{PointState, Pose, Twist, twist_of_hand};
use trench_formation::laws::{GoalMotion, Lyapunov};
use trench_formation::stability::Supply;
use trench_msgs::msg::LeaderState;

/// Step of the integration, s.
const STEP: f64 = 1e-3;

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
        let (map_from_segment, motion) = self.inputs.goals.frame(acts).ok_or(Hold::NoGoal)?;
        let duration = self.inputs.interval().min(self.settings.period);
        let point = ahead.position() + settings.look_ahead * ahead.heading();
        let told = self.told(settings, ahead, acts);
        let aside = self.face.ahead(at.steady, (point, told));
        let robot = PointState {
            position: aside.map_or(point, |(aside, _)| point + aside),
            velocity: self
                .reference
                .and_then(|reference| reference.at(acts))
                .unwrap_or_else(|| aside.map_or(told, |(_, parting)| told + parting)),
        };
        // Who follows nobody is drawn to its goal point as the chain leader is (Remark 8.4.1).
        let follows = !(member.leader.is_empty() || command.lost);
        let rank = if follows { member.rank } else { 1 };
        let ahead_in_chain = if follows {
            self.robots_ahead(settings, &member, (at, acts), map_from_segment)
        } else {
            Ok(Chain::default())
        };
        let chain = match ahead_in_chain {
            Ok(chain) => chain,
            Err(hold) => return self.slow_down(settings, (robot, acts), ahead, duration, hold, command),
        };
        let segments = self.inputs.segments.clone().ok_or(Hold::NoPlace)?;
        let apart = chain.leader.map(|ahead| (ahead.leader.state.position - robot.position).norm());
        command.beyond_reach = apart.filter(|apart| *apart > settings.agent.zoning.radii().rho_bar);
        let mut hulls = self.inputs.obstacles.as_ref().map(|heard| heard.message.at(acts)).unwrap_or_default();
        for stranger in self.inputs.strangers(&self.settings.robot) {
            hulls.to_mut().add_body(Vector2::new(stranger.x, stranger.y), self.settings.body_radius);
        }
        let zoned = settings.law.is_zoned();
        let around = Surroundings {
            clear: 0.0,
            // A clock that never runs back: what the controller remembers has times.
            time: at.steady.0 as f64 * 1e-9,
            curve: segments.curve(member.queue).ok_or(Hold::NoPlace)?,
            map_from_segment,
            motion,
            goal: self.drawing(settings, (&member.leader, rank), acts, goal, &chain)?,
            leader: chain.leader.filter(|_| zoned).map(|ahead| ahead.leader),
            ahead: if zoned { &chain.others } else { &[] },
            places: if zoned { &chain.places } else { &[] },
            behind: self.inputs.members_behind(&member),
            real: &hulls.real,
            apparent: &hulls.apparent,
            velocities: &hulls.velocities,
        };
        let agent = self.agent.as_mut().ok_or(Hold::NotFinite)?;
        let foreseen = self.news.take().map(|news| (news.foreseen(agent, around.curve, robot, acts), news));
        agent.sense(&around).map_err(|_| Hold::NotFinite)?;
        let driven = agent.drive(&around, robot, duration, STEP);
        if driven.cut {
            command.limits |= LeaderState::LIMIT_WHEELS;
        }
        self.reference = Some(Reference { from: acts, duration, start: robot.velocity, end: driven.end.velocity });
        let action = driven.first;
        let epoch = self.inputs.assignment.as_ref().map_or(0, |assignment| assignment.epoch);
        let error = self.recursion.observe(settings, &around, robot, chain.leader, &driven);
        let driving =
            Driving { settings, around: &around, leader: chain.leader, driven: &driven, robot, acts, duration, epoch };
        let news = foreseen.map_or_else(Supply::default, |(foreseen, news)| {
            news.compared(&foreseen, (&around, &action, robot.position), &settings.agent.law.trench)
        });
        let watched = driving.watched(news);
        self.news = Some(driving.expected());
        if self.draws {
            let radii = zoned.then(|| settings.agent.zoning.radii());
            let picture = Picture {
                robot: &self.settings.robot,
                agent,
                around: &around,
                point: robot.position,
                action: &action,
                radii,
            };
            self.picture = Some(picture.markers(acts));
        }
        let zone = action
            .zone
            .zip(chain.leader)
            .map(|(zone, leader)| (zone, (leader.leader.state.position - robot.position).norm()));
        let mean = driven.mean_velocity;
        let deviation = Some(action.deviation).filter(|deviation| deviation.is_finite());
        Ok(Wanted {
            twist: self.twist(settings, ahead, aside.map_or(mean, |(_, parting)| mean - parting), duration),
            rests: mean.norm() < settings.rest_speed,
            drawn: action.attraction,
            place: action.place.map(|place| map_from_segment.inverse_transform_point(&place.into()).coords),
            error,
            distance: deviation.or(self.distance).unwrap_or(0.0),
            lyapunov: Lyapunov {
                value: action.steered.lyapunov,
                rate: action.steered.lyapunov_rate + action.cut_power,
            },
            acceleration: driven.mean_acceleration,
            detour: action.attraction.filter(|_| settings.detours),
            pace: settings.pace(&action, chain.leader.is_some()),
            // Of a robot that catches up with its law there is nothing to watch.
            watched: aside.is_none().then_some(watched),
            zone,
        })
    }

    /// The goal point that draws the robot; none where the segment does.
    fn drawing(
        &self,
        settings: &DynamicSettings,
        (leader_name, rank): (&str, u32),
        acts: RosTime,
        goal: GoalMotion,
        chain: &Chain,
    ) -> Result<Option<GoalMotion>, Hold> {
        if settings.law.seeks(rank) {
            return Ok(None);
        }
        let Some(leader) = chain.leader else { return Ok(Some(settings.law.goal(goal))) };
        let (leaders, _) = self.inputs.goals.of(leader_name, acts).ok_or(Hold::NoGoal)?;
        Ok(Some(DynamicLaw::behind(leader.leader.state, leaders, goal)))
    }

    /// The twist that moves the steered point by `mean` (m/s), at the heading of the middle of the tick.
    pub(crate) fn twist(&self, settings: &DynamicSettings, ahead: Pose, mean: Vector2<f64>, duration: f64) -> Twist {
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
    pub(crate) fn follow_limits(&mut self, now: Steady, ahead: Pose, wanted: Twist, sent: Twist) {
        let differs = (wanted.v - sent.v).abs() + (wanted.omega - sent.omega).abs() > SAME;
        if differs {
            let driven = self.steered_velocity(ahead, sent);
            let aside = self.face.ahead(now, (ahead.position(), driven));
            let velocity = aside.map_or(driven, |(_, parting)| driven + parting);
            self.reference = self.reference.map(|reference| reference.replaced(velocity));
        }
    }

    /// How the steered point moves under `twist`; without a dynamic law that is the middle of the axle.
    pub(crate) fn steered_velocity(&self, pose: Pose, twist: Twist) -> Vector2<f64> {
        hand_velocity(self.settings.look_ahead(), pose, twist)
    }

    /// What followers hear of the steered point: where it was at the exposure, and how it moved.
    pub(crate) fn steered_point(&self, now: Steady, command: &Command) -> Option<(Vector2<f64>, Vector2<f64>)> {
        let (settings, pose) = (self.settings.dynamic.as_ref()?, command.pose?);
        let point = pose.position() + settings.look_ahead * pose.heading();
        let velocity = self.told(settings, pose, command.exposure);
        let aside = self.face.ahead(now, (point, velocity));
        Some(aside.map_or((point, velocity), |(aside, parting)| (point + aside, velocity + parting)))
    }

    /// Distance of the robot's centre at the exposure from its segment, and the queue's tolerance, m.
    pub(crate) fn segment_distance(&self, command: &Command) -> Option<(f64, f64)> {
        let member = self.inputs.member(&self.settings.robot)?;
        let (map_from_segment, _) = self.inputs.goals.frame(command.exposure)?;
        self.inputs.segments.as_ref()?.distance(command.pose?.position(), member.queue, map_from_segment)
    }
}

/// How the point `look_ahead` metres in front of the axle moves under `twist`.
fn hand_velocity(look_ahead: f64, pose: Pose, twist: Twist) -> Vector2<f64> {
    let heading = pose.heading();
    twist.v * heading + look_ahead * twist.omega * Vector2::new(-heading.y, heading.x)
}
