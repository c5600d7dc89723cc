//! What is in a robot's way to its segment, by ground truth: it tells a field that disturbs from one that is over.

use std::collections::{BTreeMap, BTreeSet};
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::hull::{ApparentObstacle, Obstacle, Shape, combine};
use trench_msgs::Message;
use trench_msgs::msg::{Obstacle as ObstacleMessage, ObstacleArray};

/// m: rho_clearance of (7.8), and how far obstacles reach, in config/profiles/chain.yaml.
const CLEARANCE: f64 = 0.3;
const REACH: f64 = 0.26;

/// Obstacles as they were, combined to apparent ones. Times are ns of ROS time.
#[derive(Default)]
pub(crate) struct Field(BTreeMap<i64, Vec<ApparentObstacle>>);

/// Who was hindered.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hindrance {
    /// When anybody was last, s since t0.
    pub(crate) until: f64,
    /// Real obstacles by number, and the robots that they hindered, alone or combined with others.
    pub(crate) by: BTreeMap<u32, BTreeSet<String>>,
    /// When each robot was, s since t0, in order.
    pub(crate) of: BTreeMap<String, Vec<f64>>,
}

impl Field {
    /// An /obstacles message.
    pub(crate) fn take(&mut self, cdr: &[u8]) {
        let array = ObstacleArray::decode(cdr).unwrap();
        let real: Vec<Obstacle> = array.obstacles.iter().map(obstacle).collect();
        self.0.insert(RosTime::from(&array.header.stamp).0, combine(&real, CLEARANCE).unwrap());
    }

    /// Notes at `time` (s since t0; ROS time `stamp`) what is within reach of the straight way of a robot to its segment.
    pub(crate) fn look(&self, into: &mut Hindrance, (robot, stamp, time): (&str, i64, f64), way: [Vector2<f64>; 2]) {
        let Some((_, obstacles)) = self.0.range(..=stamp).next_back() else { return };
        let way = Shape::new(&way, 0.0).unwrap();
        let mut hindered = false;
        for obstacle in obstacles {
            if obstacle.shape.outline().gap(&way.outline()) < REACH {
                into.until = into.until.max(time);
                hindered = true;
                for member in &obstacle.members {
                    into.by.entry(*member).or_default().insert(robot.to_owned());
                }
            }
        }
        if hindered {
            into.of.entry(robot.to_owned()).or_default().push(time);
        }
    }
}

fn obstacle(message: &ObstacleMessage) -> Obstacle {
    let points: Vec<Vector2<f64>> = message.polygon.iter().map(|point| Vector2::new(point.x, point.y)).collect();
    Obstacle { id: message.id, shape: Shape::new(&points, message.radius).unwrap() }
}
