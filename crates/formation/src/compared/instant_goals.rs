//! Instant goals, after reference 28 of the thesis.
use super::{Course, Guide};
use crate::Vector2;
use core::f64::consts::TAU;

/// Directions that are looked at.
const DIRECTIONS: i32 = 72;

/// While the straight way to the goal is obstructed within sight, an instant goal before the goal itself: the first free direction
/// along the obstacle, kept to one side until the way is clear and the goal nearer than where the detour began. Trajectory C of Fig. 7.15.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InstantGoals {
    /// m.
    pub sight: f64,
    /// m.
    pub clearance: f64,
    /// Distance to the goal when the detour began, m.
    detour: Option<f64>,
}

impl InstantGoals {
    /// Before any detour.
    pub fn new(sight: f64, clearance: f64) -> Self {
        Self { sight, clearance, detour: None }
    }
}

impl Guide for InstantGoals {
    fn target(&mut self, course: &Course, _time: f64, robot: Vector2<f64>) -> Vector2<f64> {
        let to_goal = course.goal - robot;
        let distance = to_goal.norm();
        let seen = robot + to_goal * (self.sight.min(distance) / distance.max(1e-9));
        let is_clear = course.is_clear(robot, seen, self.clearance);
        if is_clear && self.detour.is_none_or(|began| distance < began) {
            self.detour = None;
            return course.goal;
        }
        self.detour.get_or_insert(distance);
        // From the nearest wall leftwards, so that the obstacle stays to the right.
        let wall = course.approach(robot).towards;
        let (from, reach) = (libm::atan2(wall.y, wall.x), 2.0 * self.clearance);
        let place = |turn: i32| {
            let (sine, cosine) = libm::sincos(from + TAU * f64::from(turn) / f64::from(DIRECTIONS));
            robot + reach * Vector2::new(cosine, sine)
        };
        let free = |place: &Vector2<f64>| course.is_clear(robot, *place, self.clearance);
        (0..DIRECTIONS).map(place).find(free).unwrap_or(robot)
    }
}
