//! By how much the gap between a curve and an outline exceeds a reach, with bounds of second and third order.
use super::Placed;
use super::level::Level;
use super::primitive::Jet;
use crate::Vector2;
use crate::hull::{Feature, Outline};
use core::cell::Cell;

/// What bounds the excess e(u) = gap(p(u)) - reach along a primitive p, m.
#[derive(Clone, Copy)]
pub(super) struct Excess<'a> {
    pub(super) segment: &'a Placed<'a>,
    pub(super) outline: &'a Outline<'a>,
    pub(super) reach: f64,
    /// What |p'| may be more elsewhere than where it is looked at.
    pub(super) slack: f64,
    /// Upper bounds of |p''| and |p'''|.
    pub(super) second: f64,
    pub(super) third: f64,
    /// Centre and radius if it is a circle by its angle.
    pub(super) circle: Option<(Vector2<f64>, f64)>,
    /// How often the gap was asked for.
    pub(super) evaluations: &'a Cell<u32>,
}

/// The excess as a function of the parameter.
pub(super) struct Along<'a, J> {
    excess: Excess<'a>,
    jet: J,
}

impl<'a> Excess<'a> {
    pub(super) fn along<J: Fn(f64) -> Jet>(self, jet: J) -> Along<'a, J> {
        Along { excess: self, jet }
    }

    /// Bounds of the distance from a point about a part of the primitive, m.
    fn distances(&self, point: Vector2<f64>, jet: &Jet, half: f64) -> (f64, f64) {
        let (arm, speed) = (jet.point - point, jet.first.norm() + self.slack);
        let growth = match self.circle {
            // What is not constant of |p - q|^2 is 2 (centre - q).(p - centre).
            Some((centre, radius)) => 2.0 * (centre - point).norm() * radius,
            None => 6.0 * speed * self.second + 2.0 * (arm.norm() + half * speed) * self.third,
        };
        let terms = [arm.norm_squared(), 2.0 * jet.slope(point), 2.0 * jet.growth(point)];
        let (low, high) = range(terms, growth, half);
        (low.max(0.0).sqrt(), high.max(0.0).sqrt())
    }
}

impl<J: Fn(f64) -> Jet> Level for Along<'_, J> {
    fn at(&self, parameter: f64) -> (f64, f64) {
        let Excess { segment, outline, reach, slack, evaluations, .. } = self.excess;
        evaluations.set(evaluations.get() + 1);
        let jet = (self.jet)(parameter);
        (outline.approach(segment.point_to_map(jet.point)).gap - reach, jet.first.norm() + slack)
    }

    /// The gap is a convex function of the place. So it is nowhere less than on the side of any supporting line, and on a chord nowhere
    /// more than at its ends. Where one corner or one edge is nearest throughout, it is that smooth distance.
    fn bounds(&self, middle: f64, half: f64, ends: [f64; 2]) -> (f64, f64) {
        let Excess { segment, outline, reach, slack, second, third, evaluations, .. } = self.excess;
        evaluations.set(evaluations.get() + 1);
        let jet = (self.jet)(middle);
        let place = segment.point_to_map(jet.point);
        let approach = outline.approach(place);
        let outward = -segment.direction_to_curve(approach.towards);
        let terms = [approach.gap - reach, outward.dot(&jet.first), outward.dot(&jet.second)];
        let (mut low, along) = range(terms, third, half);
        let mut high = ends[0].max(ends[1]) + 0.5 * second * half * half;
        let (grown, moved) = (outline.radius + reach, half * (jet.first.norm() + slack));
        match outline.feature(place) {
            Feature::Corner { at, neighbours } => {
                let (least, greatest) = self.excess.distances(segment.to_curve(at), &jet, half);
                high = high.min(greatest - grown);
                let is_nearest = |other: Vector2<f64>| {
                    let edge = other - at;
                    (place - at).dot(&edge) + moved * edge.norm() <= 0.0
                };
                if neighbours.into_iter().flatten().all(is_nearest) {
                    low = low.max(least - grown);
                }
            }
            Feature::Edge { before, behind } if before.min(behind) >= moved && low + grown >= 0.0 => {
                high = high.min(along);
            }
            Feature::Edge { .. } | Feature::Inside => {}
        }
        (low, high)
    }
}

/// The least and the greatest value for |t| <= `half` of a function with these value, slope and second derivative at 0 whose third derivative
/// is at most `third`.
fn range([value, slope, curvature]: [f64; 3], third: f64, half: f64) -> (f64, f64) {
    let at = |t: f64| value + t * (slope + 0.5 * t * curvature);
    let (first, last) = (at(-half), at(half));
    let (mut low, mut high) = (first.min(last), first.max(last));
    if slope.abs() < half * curvature.abs() {
        let vertex = at(-slope / curvature);
        (low, high) = (low.min(vertex), high.max(vertex));
    }
    let rest = third * half * half * half / 6.0;
    (low - rest, high + rest)
}
