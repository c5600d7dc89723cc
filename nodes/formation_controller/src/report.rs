//! What the robot tells those that follow it, and everyone who watches.

use crate::inputs::point;
use crate::ports::MAP;
use crate::tick::{Command, Tick, pose_of};
use trench_core::Times;
use trench_formation::Vector2;
use trench_msgs::msg::LeaderState;
use trench_msgs::std_msgs::Header;

impl Tick {
    /// The leader state that goes with `command`.
    pub(crate) fn leader_state(&self, at: Times, command: &Command) -> LeaderState {
        let (settings, inputs) = (&self.settings, &self.inputs);
        let state = inputs.robot(&settings.robot);
        let position = state.map_or_else(Vector2::zeros, |state| pose_of(state).position());
        let velocity = state.map_or_else(Vector2::zeros, |state| state.v * pose_of(state).heading());
        let (steered, steered_velocity) = self.steered_point(at.steady, command).unwrap_or((position, velocity));
        let wanted = command.wanted;
        let mut message = LeaderState {
            header: Header { stamp: command.exposure.into(), frame_id: MAP.to_owned() },
            robot: settings.robot.clone(),
            hears: inputs.others.heard(at.steady, settings.leader_state_age_limit).map(str::to_owned).collect(),
            position: point(position),
            theta: state.map_or(0.0, |state| state.theta),
            velocity: point(velocity),
            acceleration: wanted.map(|wanted| point(wanted.acceleration)).unwrap_or_default(),
            point: point(steered),
            point_velocity: point(steered_velocity),
            goal: wanted.and_then(|wanted| wanted.drawn).map(point).unwrap_or_default(),
            goal_distance: self.distance.unwrap_or(0.0),
            place: point(self.place(command, steered)),
            error_bound: wanted.and_then(|wanted| wanted.error).map_or(f64::INFINITY, |(_, bound)| bound),
            lyapunov: wanted.map_or(0.0, |wanted| wanted.lyapunov.value),
            lyapunov_rate: wanted.map_or(0.0, |wanted| wanted.lyapunov.rate),
            limited_by: command.limits,
            ..LeaderState::default()
        };
        if let Some(assignment) = &inputs.assignment {
            (message.epoch, message.formation_hash) = (assignment.epoch, assignment.formation_hash);
            if let Some(member) = assignment.members.iter().find(|member| member.robot == settings.robot) {
                (message.queue, message.rank) = (member.queue, member.rank);
            }
        }
        if let Some((distance, tolerance)) = self.segment_distance(command) {
            message.segment_distance = distance;
            message.conforms = distance <= tolerance;
        }
        message
    }

    /// Where the robot means to stand, m, frame of the formation: where it is (`point`, map) if it has chosen nothing.
    fn place(&self, command: &Command, point: Vector2<f64>) -> Vector2<f64> {
        let chosen = command.wanted.and_then(|wanted| wanted.place);
        let here = || {
            let (map_from_segment, _) = self.inputs.goals.frame(command.exposure)?;
            Some(map_from_segment.inverse_transform_point(&point.into()).coords)
        };
        chosen.or_else(here).unwrap_or(point)
    }
}
