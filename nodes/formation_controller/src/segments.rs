//! The segments of the formation in force.

use crate::inputs::vector;
use nalgebra::Isometry2;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, Placed};
use trench_msgs::msg::{Formation, Queue};
use trench_plan::curve_from_message;

/// The curves of a formation, made once; none for a segment that is no curve.
#[derive(Debug, Clone)]
pub(crate) struct Segments {
    pub(crate) formation_hash: u64,
    queues: Vec<QueueWay>,
}

/// What of a queue robots drive by, in the formation's frame.
#[derive(Debug, Clone)]
struct QueueWay {
    curve: Option<Curve>,
    team_goal: Option<Vector2<f64>>,
    /// m.
    tolerance: f64,
}

/// A queue's segment with the team goal on it, in the formation's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way<'a> {
    pub(crate) curve: &'a Curve,
    pub(crate) team_goal: Vector2<f64>,
    /// m.
    pub(crate) tolerance: f64,
}

impl Segments {
    /// Those of `formation`.
    pub(crate) fn of(formation: &Formation) -> Self {
        let way = |queue: &Queue| QueueWay {
            curve: curve_from_message(&queue.segment).ok(),
            team_goal: queue.vertices.first().map(vector),
            tolerance: queue.tolerance,
        };
        Self { formation_hash: formation.hash, queues: formation.queues.iter().map(way).collect() }
    }

    /// The segment of a queue, in the formation's frame.
    pub(crate) fn curve(&self, queue: u32) -> Option<&Curve> {
        self.queues.get(queue as usize)?.curve.as_ref()
    }

    /// The way to the team goal of a queue.
    pub(crate) fn way(&self, queue: u32) -> Option<Way<'_>> {
        let QueueWay { curve, team_goal, tolerance } = self.queues.get(queue as usize)?;
        Some(Way { curve: curve.as_ref()?, team_goal: (*team_goal)?, tolerance: *tolerance })
    }

    /// Distance of `position` (map) from the segment of `queue`, and the queue's tolerance, m.
    pub(crate) fn distance(
        &self,
        position: Vector2<f64>,
        queue: u32,
        map_from_segment: Isometry2<f64>,
    ) -> Option<(f64, f64)> {
        let tolerance = self.queues.get(queue as usize)?.tolerance;
        let segment = Placed::new(self.curve(queue)?, map_from_segment);
        Some((segment.nearest(position).distance, tolerance))
    }
}
