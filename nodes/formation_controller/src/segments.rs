//! The segments of the formation in force.

use crate::dynamic::Frame;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, Placed};
use trench_msgs::msg::{Formation, Queue};
use trench_plan::curve_from_message;

/// The curves of a formation, made once, with their tolerances (m); none for a segment that is no curve.
#[derive(Debug, Clone)]
pub(crate) struct Segments {
    pub(crate) formation_hash: u64,
    queues: Vec<(Option<Curve>, f64)>,
}

impl Segments {
    /// Those of `formation`.
    pub(crate) fn of(formation: &Formation) -> Self {
        let curve = |queue: &Queue| (curve_from_message(&queue.segment).ok(), queue.tolerance);
        Self { formation_hash: formation.hash, queues: formation.queues.iter().map(curve).collect() }
    }

    /// The segment of a queue, in the formation's frame.
    pub(crate) fn curve(&self, queue: u32) -> Option<&Curve> {
        self.queues.get(queue as usize)?.0.as_ref()
    }

    /// Distance of `position` (map) from the segment of `queue`, and the queue's tolerance, m.
    pub(crate) fn distance(&self, position: Vector2<f64>, queue: u32, frame: &Frame) -> Option<(f64, f64)> {
        let (_, tolerance) = self.queues.get(queue as usize)?;
        let segment = Placed::new(self.curve(queue)?, frame.map_from_segment());
        Some((segment.nearest(position).distance, *tolerance))
    }
}
