//! A robot's way out of local minima before obstacles (7.6).
use super::Remedies;
use crate::Vector2;
use crate::avoidance::{Guard, Watch, auxiliary_arc, auxiliary_lines};
use crate::curve::{Foot, Placed};
use crate::hull::{ApparentObstacle, Approach};

/// What one robot remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Remedy {
    watch: Watch,
    raised: Option<Raised>,
}

/// A guard before one of the obstacles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Raised {
    obstacle: usize,
    guard: Guard,
    /// How far it still is from its place, m.
    sunk: f64,
}

/// What draws a robot that may be caught.
#[derive(Debug, Clone, Copy)]
pub(super) enum Drawn {
    /// A nearest point, which moves along with the robot or not.
    To(Foot),
    /// A goal point.
    Goal(Vector2<f64>),
}

impl Remedy {
    /// Distance and direction of an obstacle with its guard.
    pub(super) fn approach(&self, index: usize, obstacle: &ApparentObstacle, robot: Vector2<f64>) -> Approach {
        let outline = obstacle.shape.outline();
        match &self.raised {
            Some(raised) if raised.obstacle == index => raised.guard.sunk(raised.sunk).approach(&outline, robot),
            _ => outline.approach(robot),
        }
    }

    /// Raises a guard once the robot is caught, and drops it once the robot is past it. `reach` (m) is how far repulsion goes.
    pub(super) fn update(
        &mut self,
        remedies: &Remedies,
        (time, step): (f64, f64),
        robot: Vector2<f64>,
        (segment, drawn): (&Placed<'_>, Drawn),
        (obstacles, reach): (&[ApparentObstacle], f64),
    ) {
        if let Some(raised) = &mut self.raised {
            raised.sunk = (raised.sunk - remedies.rising * step).max(0.0);
            if !raised.guard.shields(robot) {
                self.raised = None;
                self.watch.restart();
            }
            return;
        }
        let gap = |obstacle: &ApparentObstacle| obstacle.shape.outline().approach(robot).gap;
        let nearest = obstacles.iter().enumerate().min_by(|a, b| gap(a.1).total_cmp(&gap(b.1)));
        let Some((index, obstacle)) = nearest else { return };
        let target = match drawn {
            Drawn::To(foot) => foot.point,
            Drawn::Goal(goal) => goal,
        };
        let repelled = gap(obstacle) < reach + remedies.watch.radius;
        if self.watch.is_caught(&remedies.watch, time, robot, (target - robot).norm(), repelled) {
            let outline = obstacle.shape.outline();
            self.raised = guard(segment, drawn, obstacle, robot, remedies.watch.radius).map(|guard| Raised {
                obstacle: index,
                guard,
                sunk: guard.protrusion(&outline, robot).max(0.0),
            });
        }
    }
}

/// The arc where the nearest point follows a robot that moves by `aside` (m) along the obstacle, lines where it does not.
fn guard(
    segment: &Placed<'_>,
    drawn: Drawn,
    obstacle: &ApparentObstacle,
    robot: Vector2<f64>,
    aside: f64,
) -> Option<Guard> {
    let outline = obstacle.shape.outline();
    match drawn {
        Drawn::Goal(goal) => auxiliary_lines(&outline, robot, goal),
        Drawn::To(foot) => {
            let towards = outline.approach(robot).towards;
            let beside = segment.track(robot + aside * Vector2::new(-towards.y, towards.x), foot.arc_length);
            let (arc, lines) =
                (|| auxiliary_arc(&outline, robot, &foot), || auxiliary_lines(&outline, robot, foot.point));
            if (beside.point - foot.point).norm() > 0.5 * aside { arc().or_else(lines) } else { lines().or_else(arc) }
        }
    }
}
