//! What the robots should do: formation, assignment, goal points, the state of the run.

use crate::{Point, point, seconds, short};
use serde::Serialize;
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::msg;
use trench_plan::{curve_from_message, sampled, shape_from_message};

/// How far the open end of a queue is drawn, m.
const EXTENSION: f64 = 0.5;

/// A formation with its curves as chains of straight pieces, in its own frame.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Formation {
    name: String,
    /// `map` or `target`.
    frame: String,
    queues: Vec<Queue>,
}

#[derive(Debug, Clone, Serialize)]
struct Queue {
    name: String,
    /// Empty where the message describes no curve.
    line: Vec<Point>,
    vertices: Vec<Point>,
    share: Option<f64>,
    tolerance: Option<f64>,
}

impl Formation {
    pub(crate) fn of(formation: &msg::Formation) -> Self {
        let queues = formation.queues.iter().map(Queue::of).collect();
        Self { name: formation.name.clone(), frame: formation.header.frame_id.clone(), queues }
    }
}

impl Queue {
    fn of(queue: &msg::Queue) -> Self {
        let points = |shape, curve| sampled(&shape, &curve, EXTENSION).iter().map(|at| point(at.x, at.y)).collect();
        let shape = shape_from_message(&queue.segment).ok();
        let line = shape.zip(curve_from_message(&queue.segment).ok()).map(|(shape, curve)| points(shape, curve));
        Self {
            name: queue.name.clone(),
            line: line.unwrap_or_default(),
            vertices: queue.vertices.iter().map(|vertex| point(vertex.x, vertex.y)).collect(),
            share: short(queue.share),
            tolerance: short(queue.tolerance),
        }
    }
}

/// A robot's place.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Place {
    queue: u32,
    rank: u32,
    /// Empty for the chain leader.
    leader: String,
}

/// Places by robot.
pub(crate) fn places(assignment: &msg::Assignment) -> BTreeMap<String, Place> {
    let place = |member: &msg::Member| Place { queue: member.queue, rank: member.rank, leader: member.leader.clone() };
    assignment.members.iter().map(|member| (member.robot.clone(), place(member))).collect()
}

/// A robot's goal point.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Goal {
    at: Point,
    phase: &'static str,
}

/// Goal points, and where the formation's frame is.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Goals {
    at: Point,
    theta: Option<f64>,
    by_robot: BTreeMap<String, Goal>,
}

impl Goals {
    pub(crate) fn of(goals: &msg::Goals) -> Self {
        let goal = |goal: &msg::Goal| {
            let phase = match goal.phase {
                msg::Goal::PHASE_APPROACH => "approach",
                msg::Goal::PHASE_MOVING => "moving",
                _ => "hold",
            };
            (goal.robot.clone(), Goal { at: point(goal.position.x, goal.position.y), phase })
        };
        let frame = &goals.frame;
        Self {
            at: point(frame.position.x, frame.position.y),
            theta: short(frame.theta),
            by_robot: goals.goals.iter().map(goal).collect(),
        }
    }
}

/// The state of the run.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Run {
    state: &'static str,
    reason: String,
    epoch: u64,
    /// s, ROS time; nothing before the first tick of the run.
    t0: Option<f64>,
}

impl Run {
    pub(crate) fn of(run: &msg::RunState) -> Self {
        let state = match run.state {
            msg::RunState::IDLE => "idle",
            msg::RunState::ARMED => "armed",
            msg::RunState::RUNNING => "running",
            _ => "stopped",
        };
        let t0 = RosTime::from(&run.t0);
        Self { state, reason: run.reason.clone(), epoch: run.epoch, t0: (t0.0 != 0).then(|| seconds(t0)) }
    }
}
