//! What is drawn before an apparent obstacle to turn its repulsion aside.
use crate::Vector2;
use crate::hull::{Approach, Outline};

/// Nearer to the axis than this part of the chord, the repulsion is turned by [`TILT`] (rad): a robot exactly before the middle
/// would stay there.
const MIDDLE: f64 = 0.01;
const TILT: f64 = 0.1;

/// Points that stand for a drawn guard.
const OUTLINE: usize = 17;

/// An auxiliary arc or auxiliary lines from P1 to P2, seen from P0 on the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    /// P0, m.
    pub centre: Vector2<f64>,
    /// P1 and P2, counter-clockwise about P0.
    pub ends: [Vector2<f64>; 2],
    /// P4 of Fig. 7.13; without it the guard is the arc about P0 through P1 and P2.
    pub apex: Option<Vector2<f64>>,
    /// By how much all is rounded off, like the obstacle, m.
    pub radius: f64,
}

impl Guard {
    /// Whether `point` lies in the angle P1 P0 P2: only there the guard matters.
    pub fn shields(&self, point: Vector2<f64>) -> bool {
        let [first, second] = self.ends.map(|end| end - self.centre);
        let arm = point - self.centre;
        first.perp(&arm) >= 0.0 && arm.perp(&second) >= 0.0
    }

    /// The guard sunk by `depth` (m) towards the obstacle. A guard that sprang up under a robot would throw it away, so it rises.
    #[must_use]
    pub fn sunk(self, depth: f64) -> Self {
        Self { radius: self.radius - depth, ..self }
    }

    /// The guard displaced by `by` (m), with an obstacle that moves.
    #[must_use]
    pub fn moved(self, by: Vector2<f64>) -> Self {
        let Self { centre, ends, apex, radius } = self;
        Self { centre: centre + by, ends: ends.map(|end| end + by), apex: apex.map(|apex| apex + by), radius }
    }

    /// Distance and direction of obstacle and guard together: whichever is nearer.
    pub fn approach(&self, outline: &Outline<'_>, point: Vector2<f64>) -> Approach {
        let bare = outline.approach(point);
        if !self.shields(point) {
            return bare;
        }
        let guard = self.alone(point);
        if guard.gap < bare.gap { self.unbalanced(guard, point) } else { bare }
    }

    /// Points along it from P1 to P2, grown as it is, m.
    pub fn outline(&self) -> [Vector2<f64>; OUTLINE] {
        let [first, second] = self.ends.map(|end| end - self.centre);
        core::array::from_fn(|index| {
            let share = index as f64 / (OUTLINE - 1) as f64;
            let arm = match self.apex.map(|apex| apex - self.centre) {
                Some(apex) if share < 0.5 => first + 2.0 * share * (apex - first),
                Some(apex) => apex + (2.0 * share - 1.0) * (second - apex),
                None => {
                    let (sine, cosine) = libm::sincos(share * libm::atan2(first.perp(&second), first.dot(&second)));
                    Vector2::new(cosine * first.x - sine * first.y, sine * first.x + cosine * first.y)
                }
            };
            self.centre + arm + self.radius * arm / arm.norm().max(f64::MIN_POSITIVE)
        })
    }

    /// By how much the guard is nearer than the obstacle, m.
    pub fn protrusion(&self, outline: &Outline<'_>, point: Vector2<f64>) -> f64 {
        outline.approach(point).gap - self.alone(point).gap
    }

    fn alone(&self, point: Vector2<f64>) -> Approach {
        match self.apex {
            Some(apex) => {
                let corners = [self.ends[0], apex, self.ends[1]];
                Outline { points: &corners, radius: self.radius }.approach(point)
            }
            None => {
                let arm = point - self.centre;
                let distance = arm.norm();
                let gap = distance - (self.ends[0] - self.centre).norm() - self.radius;
                Approach { gap, towards: -arm / distance.max(f64::MIN_POSITIVE) }
            }
        }
    }

    /// Turns the repulsion near the axis, to one side.
    fn unbalanced(&self, approach: Approach, point: Vector2<f64>) -> Approach {
        let chord = self.ends[1] - self.ends[0];
        let top = self.apex.unwrap_or_else(|| 0.5 * (self.ends[0] + self.ends[1]));
        let axis = (top - self.centre).normalize();
        if axis.perp(&(point - self.centre)).abs() > MIDDLE * chord.norm() {
            return approach;
        }
        let (sine, cosine) = libm::sincos(TILT);
        let [x, y] = [approach.towards.x, approach.towards.y];
        Approach { towards: Vector2::new(cosine * x - sine * y, sine * x + cosine * y), ..approach }
    }
}
