//! Virtual obstacles, after reference 57 of the thesis.
use super::{Course, Guide};
use crate::Vector2;
use crate::avoidance::{Watch, escape};
use crate::hull::{Outline, Shape};

/// A robot that is caught closes the obstacle that holds it by virtual lines, leaves it, and goes round by via points, one
/// corner after another. It has to be caught first, once an obstacle: trajectory D of Fig. 7.15.
#[derive(Debug, Clone, PartialEq)]
pub struct VirtualObstacles {
    /// How far from walls via points lie, m.
    pub clearance: f64,
    watch: Watch,
    closed: Vec<usize>,
    /// Those of them that the robot has left behind: a hull must not repel a robot that is just coming out of it.
    repelling: Vec<usize>,
    /// Via points still to go to, and those gone to.
    way: Vec<Vector2<f64>>,
    visited: Vec<Vector2<f64>>,
    recoveries: u32,
}

impl VirtualObstacles {
    /// With nothing closed.
    pub fn new(clearance: f64) -> Self {
        Self {
            clearance,
            watch: Watch::default(),
            closed: Vec::new(),
            repelling: Vec::new(),
            way: Vec::new(),
            visited: Vec::new(),
            recoveries: 0,
        }
    }

    /// The shortest way by a corner of a closed hull that has not been gone to.
    fn corner(&self, course: &Course, robot: Vector2<f64>) -> Option<Vector2<f64>> {
        let grown = |obstacle: &usize| {
            let corners = &course.obstacles[*obstacle];
            let middle = corners.iter().sum::<Vector2<f64>>() / corners.len() as f64;
            let out = move |corner: &Vector2<f64>| {
                let away = corner - middle;
                corner + 1.5 * self.clearance * Vector2::new(away.x.signum(), away.y.signum())
            };
            corners.iter().map(out).collect::<Vec<_>>()
        };
        let free = |corner: &Vector2<f64>| {
            !self.visited.contains(corner)
                && course.gap(*corner) >= self.clearance
                && course.is_clear(robot, *corner, 0.9 * self.clearance)
        };
        let cost = |corner: &Vector2<f64>| (corner - robot).norm() + (course.goal - corner).norm();
        self.closed.iter().flat_map(grown).filter(free).min_by(|a, b| cost(a).total_cmp(&cost(b)))
    }

    /// The obstacle that holds the robot becomes a virtual one; the way leads out of it first.
    fn recover(&mut self, course: &Course, robot: Vector2<f64>) {
        let gap = |corners: &[Vector2<f64>]| {
            let walls = corners.windows(2).map(|points| Outline { points, radius: 0.0 }.approach(robot).gap);
            walls.fold(f64::INFINITY, f64::min)
        };
        let open = (0..course.obstacles.len()).filter(|obstacle| !self.closed.contains(obstacle));
        let holds = open.min_by(|a, b| gap(&course.obstacles[*a]).total_cmp(&gap(&course.obstacles[*b])));
        self.recoveries += 1;
        self.visited.clear();
        let Some(obstacle) = holds else { return };
        self.closed.push(obstacle);
        let Ok(hull) = Shape::enclosing(&course.obstacles[obstacle], 0.0) else { return };
        if hull.outline().approach(robot).gap < 0.0 {
            let pairs = course.obstacles.iter().flat_map(|corners| corners.windows(2));
            let walls: Vec<Outline<'_>> = pairs.map(|points| Outline { points, radius: 0.0 }).collect();
            self.way = escape(&hull.outline(), &walls, robot, 0.5 * self.clearance, self.clearance).unwrap_or_default();
        }
    }
}

impl Guide for VirtualObstacles {
    fn target(&mut self, course: &Course, time: f64, robot: Vector2<f64>) -> Vector2<f64> {
        let deviation = (course.goal - robot).norm();
        if self.watch.is_caught(&course.watch, time, robot, deviation, true) {
            self.watch.restart();
            self.way.clear();
            self.recover(course, robot);
        }
        let is_left = |obstacle: &usize| {
            let hull = Shape::enclosing(&course.obstacles[*obstacle], 0.0);
            hull.is_ok_and(|hull| hull.outline().approach(robot).gap >= 0.5 * self.clearance)
        };
        let left = self.closed.iter().copied().filter(|closed| !self.repelling.contains(closed)).find(is_left);
        self.repelling.extend(left);
        if let Some(via) = self.way.first().copied().filter(|via| (via - robot).norm() < 0.5 * self.clearance) {
            self.visited.push(via);
            self.way.remove(0);
        }
        if self.way.is_empty() && !self.closed.is_empty() && !course.is_clear(robot, course.goal, 0.9 * self.clearance)
        {
            self.way.extend(self.corner(course, robot));
        }
        self.way.first().copied().unwrap_or(course.goal)
    }

    fn repelling(&self) -> &[usize] {
        &self.repelling
    }

    fn recoveries(&self) -> u32 {
        self.recoveries
    }
}
