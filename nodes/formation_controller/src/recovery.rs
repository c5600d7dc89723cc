//! A robot that has lost its team (Remark 6.2.1): with its collision avoidance activated it approaches the segment and moves
//! along it, as fast as it may, towards the team goal, until it hears another robot of its queue. Whom it sees on its way there it comes up to as a
//! follower does, and no nearer: who went on would push those who stand in formation out of its way.

use crate::segments::Way;
use crate::tick::Tick;
use nalgebra::Isometry2;
use trench_core::{RosTime, Times};
use trench_formation::Vector2;
use trench_formation::avoidance::behind_obstacles;
use trench_formation::curve::Placed;
use trench_formation::hull::ApparentObstacle;
use trench_formation::kinematics::Pose;
use trench_formation::laws::{GoalMotion, RigidMotion};

/// The point that leads the robot along the segment is this far ahead, m: far enough to be followed at full speed.
const LEAD: f64 = 0.3;

/// Nearer to the segment than so many tolerances the robot turns along it.
const CLOSE: f64 = 3.0;

impl Tick {
    /// The point that draws the robot if it follows others and has lost them.
    pub(crate) fn recovery(&mut self, at: Times, acts: RosTime, robot: Pose) -> Option<GoalMotion> {
        let dynamic = self.settings.dynamic.as_ref().filter(|dynamic| dynamic.law.is_chained())?;
        let inputs = &self.inputs;
        // The chain leader has its goal and follows nobody.
        let member = inputs.member(&self.settings.robot).filter(|member| member.rank > 1)?;
        let hears = inputs.hears_of_queue(member, at.steady, self.settings.leader_state_age_limit);
        let speed = dynamic.capability.speed;
        if !self.team_link.lost(at.steady, hears, self.settings.team_age_limit) {
            return None;
        }
        let frame = inputs.goals.frame(acts)?;
        let hulls = inputs.obstacles.as_ref().map(|heard| heard.message.at(acts)).unwrap_or_default();
        let obstacles = (&hulls.apparent[..], dynamic.agent.potential.cut());
        let others: Vec<Vector2<f64>> = inputs.queue_seen(member).collect();
        let others = (&others[..], dynamic.agent.zoning.radii().rho);
        let way = inputs.segments.as_ref()?.way(member.queue)?;
        Some(point_ahead(&way, frame, robot.position(), speed, others, obstacles))
    }
}

/// Where a robot at `robot` (map, m) goes next on its way to the team goal at `speed` (m/s): no nearer than `apart` (m) to others on the segment,
/// and behind obstacles on it that repel it within `reach` (m).
fn point_ahead(
    way: &Way<'_>,
    (map_from_segment, motion): (Isometry2<f64>, RigidMotion),
    robot: Vector2<f64>,
    speed: f64,
    (others, apart): (&[Vector2<f64>], f64),
    (apparent, reach): (&[ApparentObstacle], f64),
) -> GoalMotion {
    let segment = Placed::new(way.curve, map_from_segment);
    let here = segment.nearest(robot);
    let left = way.curve.way(here.arc_length, way.curve.nearest(way.team_goal).arc_length);
    if let Some(behind) = behind_obstacles(&segment, apparent, reach, (here.arc_length, left)) {
        return motion.at(segment.at(behind).point);
    }
    if here.distance > CLOSE * way.tolerance {
        return motion.at(here.point);
    }
    let before = |other: &Vector2<f64>| {
        let foot = segment.nearest(*other);
        let ahead = way.curve.way(here.arc_length, foot.arc_length) * left.signum();
        (foot.distance < apart && ahead > 0.0).then_some(ahead - apart)
    };
    let room = others.iter().filter_map(before).fold(f64::INFINITY, f64::min).max(0.0);
    let lead = LEAD.min(room);
    if left.abs() <= lead {
        return motion.at(segment.at(here.arc_length + left).point);
    }
    let ahead = segment.at(here.arc_length + lead.copysign(left));
    let carried = motion.at(ahead.point);
    GoalMotion { velocity: carried.velocity + lead / LEAD * speed.copysign(left) * ahead.tangent, ..carried }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_formation::curve::{Curve, CurveShape};
    use trench_formation::hull::{Obstacle, Shape, combine};

    #[test]
    fn first_to_the_segment_then_along_it_then_rest_at_the_team_goal() {
        let line = CurveShape::Line(Vector2::new(-2.0, 0.0), Vector2::new(0.0, 0.0));
        let curve = Curve::new(&line, false, false).unwrap();
        let way = Way { curve: &curve, team_goal: Vector2::zeros(), tolerance: 0.05 };
        let origin = GoalMotion {
            position: Vector2::new(3.0, 1.0),
            velocity: Vector2::new(0.06, 0.0),
            acceleration: Vector2::zeros(),
        };
        let frame = (Isometry2::translation(3.0, 1.0), RigidMotion { origin, ..RigidMotion::at_rest() });
        let check = |robot: [f64; 2], point: [f64; 2], speed: f64| {
            let goal = point_ahead(&way, frame, robot.into(), 0.2, (&[], 0.3), (&[], 0.3));
            let expected = Vector2::from(point);
            assert!((goal.position - expected).norm() < 1e-9, "{robot:?}: {goal:?}");
            assert!((goal.velocity - Vector2::new(speed, 0.0)).norm() < 1e-9, "{robot:?}: {goal:?}");
        };
        check([1.5, 2.0], [1.5, 1.0], 0.06);
        check([1.5, 1.1], [1.8, 1.0], 0.26);
        check([2.9, 1.0], [3.0, 1.0], 0.06);
        // No nearer to others than a follower: not to those beside the segment, behind it and beyond.
        let others = [[1.9, 1.5], [1.4, 1.0], [2.8, 1.1], [2.0, 1.1]].map(Vector2::from);
        let among = |robot: [f64; 2], others: &[Vector2<f64>]| {
            let goal = point_ahead(&way, frame, robot.into(), 0.2, (others, 0.3), (&[], 0.3));
            [goal.position.x, goal.position.y, goal.velocity.x]
        };
        let same = |goal: [f64; 3], expected: [f64; 3]| {
            assert!(goal.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-9), "{goal:?}");
        };
        same(among([1.5, 1.0], &others[..3]), [1.8, 1.0, 0.26]);
        same(among([1.5, 1.0], &others), [1.7, 1.0, 0.06 + 0.2 * 0.2 / 0.3]);
        same(among([1.75, 1.0], &others), [1.75, 1.0, 0.06]);
        same(among([2.95, 1.0], &[Vector2::new(3.0, 1.0)]), [2.95, 1.0, 0.06]);
        // Behind what stands on the segment there is a point that goes with it.
        let disc = Obstacle { id: 1, shape: Shape::new(&[Vector2::new(2.0, 1.0)], 0.1).unwrap() };
        let apparent = combine(&[disc], 0.0).unwrap();
        let goal = point_ahead(&way, frame, Vector2::new(1.6, 1.1), 0.2, (&[], 0.3), (&apparent, 0.3));
        assert!((2.4..2.5).contains(&goal.position.x) && goal.velocity == Vector2::new(0.06, 0.0), "{goal:?}");
    }
}
