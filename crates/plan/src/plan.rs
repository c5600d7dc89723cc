//! A formation with its curves.

use crate::ChainPlaces;
use crate::segment::message_from_shape;
use std::hash::Hasher;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};
use trench_msgs::Encode;
use trench_msgs::msg::{Formation, Point2, Queue};
use trench_msgs::std_msgs::Header;

/// The frame a formation is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Fixed on the field.
    Map,
    /// Moves with the target.
    Target,
}

impl Frame {
    /// Its frame id in messages.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Target => "target",
        }
    }
}

/// How the virtual points of section 4.6 move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Seconds from t0 during which each robot drives to the nearest point of its segment.
    pub approach: f64,
    /// m/s, along the segment.
    pub speed: f64,
}

/// One robot's place in a queue, as arc lengths on its segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where its virtual point starts, m.
    pub start: f64,
    /// Where it ends, m: at a vertex.
    pub end: f64,
}

/// A queue Q = (S, X, C, epsilon) of Definition 2.1.1.
#[derive(Debug, Clone, PartialEq)]
pub struct QueuePlan {
    /// Its name.
    pub name: String,
    /// How its segment was written.
    pub shape: CurveShape,
    /// S.
    pub curve: Curve,
    /// X: its vertices, m, in the formation's frame, one at least. The first is the team goal, and all that a chain has.
    pub vertices: Vec<Vector2<f64>>,
    /// C: fraction of the robots.
    pub share: f64,
    /// epsilon, m.
    pub tolerance: f64,
    /// How its places follow from the first vertex; none where each vertex is a place.
    pub chain: Option<ChainPlaces>,
    /// Places, one a robot.
    pub places: Vec<Place>,
}

/// A formation.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Its name.
    pub name: String,
    /// The frame its queues are in.
    pub frame: Frame,
    /// Motion of the virtual points.
    pub motion: Motion,
    /// Its queues; their shares add up to 1.
    pub queues: Vec<QueuePlan>,
}

impl Plan {
    /// How many robots it has places for.
    #[must_use]
    pub fn places(&self) -> usize {
        self.queues.iter().map(|queue| queue.places.len()).sum()
    }

    /// The formation as a message, with the hash of its content.
    #[must_use]
    pub fn message(&self, header: Header) -> Formation {
        let header = Header { frame_id: self.frame.id().to_owned(), ..header };
        let mut formation =
            Formation { header: Header::default(), name: self.name.clone(), hash: 0, queues: Vec::new() };
        formation.queues.extend(self.queues.iter().map(QueuePlan::message));
        formation.hash = content_hash(&formation);
        Formation { header, ..formation }
    }
}

impl QueuePlan {
    fn message(&self) -> Queue {
        let (from, to) = self.curve.domain();
        Queue {
            name: self.name.clone(),
            segment: message_from_shape(&self.shape, from.is_infinite(), to.is_infinite()),
            vertices: self.vertices.iter().map(|vertex| Point2 { x: vertex.x, y: vertex.y }).collect(),
            spacing: self.chain.map_or(0.0, |chain| chain.spacing),
            places: self.chain.map_or(0, |chain| chain.robots),
            share: self.share,
            tolerance: self.tolerance,
        }
    }
}

/// FNV-1a over the CDR of a formation without header and hash: equal on every host.
fn content_hash(formation: &Formation) -> u64 {
    let mut hasher = fnv::FnvHasher::default();
    hasher.write(&formation.to_cdr());
    hasher.finish()
}
