//! The virtual points of section 4.6: first the nearest point of the segment, then a point that moves to its vertex.

use trench_formation::Vector2;
use trench_formation::curve::Curve;
use trench_formation::laws::GoalMotion;
use trench_msgs::msg::Goal;
use trench_plan::{Motion, Place};

/// A goal point, what it is doing, and for how long it goes on like this.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VirtualPoint {
    /// One of `Goal::PHASE_*`.
    pub phase: u8,
    /// Where it is and how it moves, in the segment's frame or, after [`VirtualPoint::carried`], in the map.
    pub motion: GoalMotion,
    /// Seconds for which velocity and acceleration hold.
    pub remaining: f64,
}

/// The virtual point of `place` on `curve`, `elapsed` seconds after t0, for a robot at `robot` (segment's frame).
#[must_use]
pub fn virtual_point(curve: &Curve, place: Place, motion: Motion, elapsed: f64, robot: Vector2<f64>) -> VirtualPoint {
    if elapsed < motion.approach {
        let nearest = curve.nearest(robot);
        return rest(Goal::PHASE_APPROACH, nearest.point);
    }
    let way = place.end - place.start;
    let duration = if motion.speed > 0.0 { way.abs() / motion.speed } else { 0.0 };
    let moved = elapsed - motion.approach;
    if moved >= duration {
        return rest(Goal::PHASE_HOLD, curve.at(place.end).point);
    }
    let speed = motion.speed.copysign(way);
    let foot = curve.at(place.start + speed * moved);
    let normal = Vector2::new(-foot.tangent.y, foot.tangent.x);
    VirtualPoint {
        phase: Goal::PHASE_MOVING,
        motion: GoalMotion {
            position: foot.point,
            velocity: speed * foot.tangent,
            acceleration: speed * speed * foot.curvature * normal,
        },
        remaining: duration - moved,
    }
}

/// A goal point at rest, for as long as anyone asks.
fn rest(phase: u8, position: Vector2<f64>) -> VirtualPoint {
    VirtualPoint { phase, motion: GoalMotion::at_rest(position), remaining: f64::MAX }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Carrier;
    use trench_formation::curve::CurveShape;

    fn line() -> Curve {
        Curve::new(&CurveShape::Line(Vector2::new(0.0, 0.5), Vector2::new(2.0, 0.5)), false, false).unwrap()
    }

    const PLACE: Place = Place { start: 0.5, end: 1.3 };
    const MOTION: Motion = Motion { approach: 3.0, speed: 0.1 };

    fn at(elapsed: f64) -> VirtualPoint {
        virtual_point(&line(), PLACE, MOTION, elapsed, Vector2::new(0.7, 0.9))
    }

    #[test]
    fn first_the_nearest_point_then_the_moving_one_then_the_vertex() {
        let check = |elapsed, phase, x: f64, speed: f64| {
            let point = at(elapsed);
            assert_eq!(point.phase, phase, "at {elapsed}");
            assert!((point.motion.position.x - x).abs() < 1e-9, "at {elapsed}: {point:?}");
            assert!((point.motion.velocity.x - speed).abs() < 1e-9, "at {elapsed}: {point:?}");
        };
        check(0.0, Goal::PHASE_APPROACH, 0.7, 0.0);
        check(3.0, Goal::PHASE_MOVING, 0.5, 0.1);
        check(7.0, Goal::PHASE_MOVING, 0.9, 0.1);
        check(11.0, Goal::PHASE_HOLD, 1.3, 0.0);
        assert!((at(7.0).remaining - 4.0).abs() < 1e-9);
    }

    #[test]
    fn points_move_backwards_too() {
        let back = Place { start: 1.3, end: 0.5 };
        let point = virtual_point(&line(), back, MOTION, 5.0, Vector2::zeros());
        assert!((point.motion.position.x - 1.1).abs() < 1e-9 && point.motion.velocity.x < 0.0);
    }

    #[test]
    fn a_carried_point_moves_as_its_positions_say() {
        let carrier = |time: f64| Carrier {
            position: Vector2::new(0.3 * time, 0.1),
            theta: 0.2 * time,
            velocity: Vector2::new(0.3, 0.0),
            acceleration: Vector2::zeros(),
            omega: 0.2,
        };
        let carried = |time: f64| at(5.0 + time).carried(&carrier(time)).motion;
        let (step, now) = (1e-4, carried(0.0));
        let (before, after) = (carried(-step), carried(step));
        let velocity = (after.position - before.position) / (2.0 * step);
        let acceleration = (after.velocity - before.velocity) / (2.0 * step);
        assert!((velocity - now.velocity).norm() < 1e-6);
        assert!((acceleration - now.acceleration).norm() < 1e-6);
        let there = carrier(1.0);
        assert!((there.from_map(carried(1.0).position) - at(6.0).motion.position).norm() < 1e-12);
        assert!((there.to_map(at(6.0).motion.position) - carried(1.0).position).norm() < 1e-12);
    }
}
