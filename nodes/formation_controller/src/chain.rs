//! The robots ahead in the chain, and what a follower does that hears no leader.

use crate::dynamic::{DynamicSettings, Reference};
use crate::hold::Hold;
use crate::inputs::Ahead;
use crate::tick::{Command, Tick, Wanted};
use nalgebra::Isometry2;
use trench_core::{RosTime, Times};
use trench_formation::Vector2;
use trench_formation::kinematics::{PointState, Pose};
use trench_formation::laws::Lyapunov;
use trench_msgs::msg::{LeaderState, Member};

/// Robots ahead in the chain.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Chain {
    /// Whom the robot follows.
    pub(crate) leader: Option<Ahead>,
    /// Those before.
    pub(crate) others: Vec<PointState>,
    /// The places that all of them have chosen, the leader's last, m, map; where they are if they have chosen none.
    pub(crate) places: Vec<Vector2<f64>>,
}

impl Tick {
    /// The robots ahead in the chain at `acts`, when the formation's frame is at `map_from_segment`.
    pub(crate) fn robots_ahead(
        &self,
        settings: &DynamicSettings,
        member: &Member,
        (at, acts): (Times, RosTime),
        map_from_segment: Isometry2<f64>,
    ) -> Result<Chain, Hold> {
        let mut chain = Chain::default();
        if !settings.law.follows(member.rank) {
            return Ok(chain);
        }
        for other in self.inputs.members_ahead(member) {
            let ahead = self.inputs.teammate(&other.robot, (at, acts), settings.leader_age);
            let leads = other.rank + 1 == member.rank;
            let Some(ahead) = ahead else {
                if leads {
                    return Err(Hold::NoLeader(other.robot.clone()));
                }
                // Those farther ahead only matter when they come near: one that is silent the filter sees then.
                continue;
            };
            if leads {
                chain.leader = Some(ahead);
            } else {
                chain.others.push(ahead.leader.state);
                chain.places.push(ahead.place_in(map_from_segment));
            }
        }
        let leader = chain.leader.ok_or_else(|| Hold::NoLeader(member.leader.clone()))?;
        chain.places.push(leader.place_in(map_from_segment));
        Ok(chain)
    }

    /// A follower whose leader is silent comes to rest as its limits let it.
    pub(crate) fn slow_down(
        &mut self,
        settings: &DynamicSettings,
        (robot, acts): (PointState, RosTime),
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
        self.reference = Some(Reference { from: acts, duration, start: robot.velocity, end });
        command.hold = Some(hold);
        Ok(Wanted {
            twist: self.twist(settings, ahead, 0.5 * (robot.velocity + end), duration),
            rests: false,
            drawn: None,
            place: None,
            error: None,
            distance: self.distance.unwrap_or(0.0),
            lyapunov: Lyapunov::default(),
            acceleration: (end - robot.velocity) / duration,
            detour: None,
            pace: 0.0,
            watched: None,
            zone: None,
        })
    }
}
