//! Formations as messages ask for them.

use crate::plan::{Frame, Motion, Place, Plan, QueuePlan};
use crate::segment::{SegmentError, shape_from_message};
use crate::{ChainPlaces, LEAST_TOLERANCE, MOST_ROBOTS, NO_VERTEX, NoRoom, ON_SEGMENT, ONE_VERTEX, SHARES};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveError};
use trench_msgs::msg::{Formation, Queue};

/// A message that describes no formation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FormationError {
    /// Neither map nor target.
    #[error("frame_id is `{0}`: write map or target")]
    Frame(String),
    /// No queue.
    #[error("a formation without segments: give at least one queue")]
    Empty,
    /// Shares that are no fractions of one whole.
    #[error("the shares add up to {0}: make them add up to 1, none of them negative")]
    Shares(f64),
    /// A queue without a vertex.
    #[error("queue {queue}: {NO_VERTEX}; give one or two points of its segment")]
    NoVertex {
        /// Its name.
        queue: String,
    },
    /// A chain with several.
    #[error("queue {queue}: {count} vertices, but {ONE_VERTEX}")]
    Vertices {
        /// Its name.
        queue: String,
        /// How many.
        count: usize,
    },
    /// Two queues that cannot be told apart.
    #[error("two queues are called {queue}: give each its own name")]
    Twice {
        /// Their name.
        queue: String,
    },
    /// A vertex off its segment.
    #[error("a vertex of queue {queue} is {distance:.4} m away from its segment")]
    Vertex {
        /// The queue's name.
        queue: String,
        /// m.
        distance: f64,
    },
    /// A chain that is longer than its segment.
    #[error("queue {queue}: {error}; {}", error.remedy())]
    Chain {
        /// The queue's name.
        queue: String,
        /// What there is, and what it needs.
        error: NoRoom,
    },
    /// A tolerance that no robot keeps.
    #[error("queue {queue}: tolerance is {value}: it must be {LEAST_TOLERANCE} m or more")]
    Tolerance {
        /// The queue's name.
        queue: String,
        /// m.
        value: f64,
    },
    /// A number that is no number, or negative where that means nothing.
    #[error("queue {queue}: {name} is {value}: it must be finite and not negative")]
    Number {
        /// The queue's name.
        queue: String,
        /// The field.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A segment that is none.
    #[error("queue {queue}: {error}")]
    Segment {
        /// The queue's name.
        queue: String,
        /// What is wrong.
        error: SegmentError,
    },
}

/// The formation of a message; its goal points rest at their places.
///
/// # Errors
/// The first thing that is wrong with it.
pub fn plan_from_message(formation: &Formation) -> Result<Plan, FormationError> {
    let frame = match formation.header.frame_id.as_str() {
        "map" | "" => Frame::Map,
        "target" => Frame::Target,
        other => return Err(FormationError::Frame(other.to_owned())),
    };
    if formation.queues.is_empty() {
        return Err(FormationError::Empty);
    }
    let total: f64 = formation.queues.iter().map(|queue| queue.share).sum();
    let fractions = formation.queues.iter().all(|queue| queue.share >= 0.0);
    if !(fractions && (total - 1.0).abs() <= SHARES) {
        return Err(FormationError::Shares(total));
    }
    for (index, queue) in formation.queues.iter().enumerate() {
        if formation.queues[..index].iter().any(|earlier| earlier.name == queue.name) {
            return Err(FormationError::Twice { queue: queue.name.clone() });
        }
    }
    let queues = formation.queues.iter().map(|queue| queue_from_message(queue, total)).collect::<Result<_, _>>()?;
    Ok(Plan { name: formation.name.clone(), frame, motion: Motion { approach: 0.0, speed: 0.0 }, queues })
}

fn queue_from_message(queue: &Queue, total: f64) -> Result<QueuePlan, FormationError> {
    let name = || queue.name.clone();
    let places = (queue.places > MOST_ROBOTS).then_some(("places", f64::INFINITY));
    for (field, value) in [("tolerance", queue.tolerance), ("spacing", queue.spacing)].into_iter().chain(places) {
        if !(value.is_finite() && value >= 0.0) {
            return Err(FormationError::Number { queue: name(), name: field, value });
        }
    }
    let segment = |error: SegmentError| FormationError::Segment { queue: name(), error };
    if queue.tolerance < LEAST_TOLERANCE {
        return Err(FormationError::Tolerance { queue: name(), value: queue.tolerance });
    }
    let shape = shape_from_message(&queue.segment).map_err(segment)?;
    let curve = Curve::new(&shape, queue.segment.open_start, queue.segment.open_end)
        .map_err(|error: CurveError| segment(error.into()))?;
    let vertices: Vec<Vector2<f64>> = queue.vertices.iter().map(|vertex| Vector2::new(vertex.x, vertex.y)).collect();
    let mut ends = Vec::new();
    for vertex in &vertices {
        let foot = curve.nearest(*vertex);
        if foot.distance.is_nan() || foot.distance > ON_SEGMENT {
            return Err(FormationError::Vertex { queue: name(), distance: foot.distance });
        }
        ends.push(foot.arc_length);
    }
    let Some(&first) = ends.first() else { return Err(FormationError::NoVertex { queue: name() }) };
    let chain = (queue.places > 0).then_some(ChainPlaces { robots: queue.places, spacing: queue.spacing });
    let places = match chain {
        Some(_) if ends.len() > 1 => return Err(FormationError::Vertices { queue: name(), count: ends.len() }),
        Some(chain) => chain.along(&curve, first).map_err(|error| FormationError::Chain { queue: name(), error })?,
        None => ends.iter().map(|&end| Place { start: end, end }).collect(),
    };
    let (share, tolerance) = (queue.share / total, queue.tolerance);
    Ok(QueuePlan { name: name(), shape, curve, vertices, share, tolerance, chain, places })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;
    use trench_msgs::std_msgs::Header;

    const WINGS: &str = "name: wings\nframe: target\nqueues:\n\
        - name: left\n  segment: {kind: line, points: [[-2.0, 0.3], [0.0, 0.3]]}\n  vertices: [[0.0, 0.3]]\n  \
          chain: {robots: 4, spacing: 0.4}\n  share: 0.5\n  tolerance: 0.05\n\
        - name: right\n  segment: {kind: line, points: [[-2.0, -0.3], [0.0, -0.3]]}\n  vertices: [[0.0, -0.3]]\n  \
          chain: {robots: 4, spacing: 0.4}\n  share: 0.5\n  tolerance: 0.05\n";

    #[test]
    fn a_message_of_a_file_s_formation_is_that_formation() {
        let plan = parse("wings.yaml", WINGS).unwrap();
        assert_eq!(plan_from_message(&plan.message(Header::default())).unwrap(), plan);
        let ends: Vec<f64> = plan.queues[0].places.iter().map(|place| place.end).collect();
        for (end, expected) in ends.iter().zip([2.0, 1.6, 1.2, 0.8]) {
            assert!((end - expected).abs() < 1e-12, "{ends:?}");
        }
    }

    #[test]
    fn a_larger_one_is_larger_in_everything() {
        let plan = parse("wings.yaml", WINGS).unwrap();
        let twice = plan.scaled(2.0).unwrap();
        assert_eq!(twice.queues[0].vertices[0], 2.0 * plan.queues[0].vertices[0]);
        assert_eq!(twice.queues[0].places[1].end, 2.0 * plan.queues[0].places[1].end);
        assert_eq!(plan_from_message(&twice.message(Header::default())).unwrap(), twice);
        assert_ne!(twice.message(Header::default()).hash, plan.message(Header::default()).hash);
    }

    #[test]
    fn what_is_no_formation_is_refused_with_its_reason() {
        let good = parse("wings.yaml", WINGS).unwrap().message(Header::default());
        let check = |spoil: &dyn Fn(&mut Formation), expected: &str| {
            let mut bad = good.clone();
            spoil(&mut bad);
            let refusal = plan_from_message(&bad).unwrap_err().to_string();
            assert!(refusal.contains(expected), "{refusal}");
        };
        check(&|bad| bad.queues.clear(), "without segments");
        check(&|bad| bad.header.frame_id = "moon".to_owned(), "frame_id is `moon`");
        check(&|bad| bad.queues[0].share = -0.5, "add up to 0");
        check(&|bad| bad.queues[0].share = f64::NAN, "add up to NaN");
        check(&|bad| bad.queues[0].vertices.clear(), "queue left: a queue without a vertex");
        check(
            &|bad| bad.queues[0].vertices.extend(good.queues[0].vertices.clone()),
            "queue left: 2 vertices, but a chain",
        );
        check(&|bad| bad.queues[1].name = "left".to_owned(), "two queues are called left");
        check(&|bad| bad.queues[1].tolerance = 0.0, "queue right: tolerance is 0: it must be 0.001 m or more");
        check(&|bad| bad.queues[0].vertices[0].y = 1.0, "0.7000 m away");
        check(&|bad| bad.queues[0].vertices[0].x = f64::NAN, "away from its segment");
        check(&|bad| bad.queues[0].places = u32::MAX, "queue left: places");
        check(&|bad| bad.queues[0].places = 400, "the chain does not fit: it is 159.600 m long");
        check(&|bad| bad.queues[1].tolerance = f64::INFINITY, "queue right: tolerance is inf");
        check(&|bad| bad.queues[1].segment.points.clear(), "needs two points");
        check(&|bad| bad.queues[1].segment.points[0].x = f64::NAN, "queue right");
    }
}
