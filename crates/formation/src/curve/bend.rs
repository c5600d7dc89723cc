//! What is known beforehand of a piece that is not straight, so that questions evaluate its primitive only where they must.
use super::arc_table::ArcTable;
use super::primitive::{Jet, Primitive};
use nalgebra::Vector2;

/// A curved piece at its ends and in its middle, and its arc length as a polynomial.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bend {
    /// At the start and at the end.
    pub(super) ends: [Jet; 2],
    pub(super) middle: Middle,
    pub(super) arc: ArcTable,
}

impl Bend {
    /// Nothing for straight pieces and circles, whose answers are in closed form.
    pub(super) fn of(primitive: &Primitive, from: f64, to: f64, length: f64) -> Option<Box<Self>> {
        if matches!(primitive, Primitive::Line { .. }) || primitive.circle().is_some() {
            return None;
        }
        let ends = [primitive.evaluate(from), primitive.evaluate(to)];
        let middle = Middle::of(primitive, from, to);
        Some(Box::new(Self { ends, middle, arc: ArcTable::of(primitive, (from, to), length) }))
    }

    /// Where the slope of the squared distance, which grows all over the piece and changes sign, is about zero: its inverse as the
    /// cubic that fits value and slope at both ends of the half that holds the zero. That half, and the zero, as parameters.
    pub(super) fn guess(&self, from: f64, to: f64, point: Vector2<f64>) -> ((f64, f64), f64) {
        let [start, end] = &self.ends;
        let middle = &self.middle.jet;
        let half = 0.5 * (from + to);
        let forward = (middle.point - point).dot(&middle.first) < 0.0;
        let (low, high, a, b) = if forward { (middle, end, half, to) } else { (start, middle, from, half) };
        let slope = |jet: &Jet| (jet.point - point).dot(&jet.first);
        let growth = |jet: &Jet| jet.first.norm_squared() + (jet.point - point).dot(&jet.second);
        let (below, above) = (slope(low), slope(high));
        let rise = above - below;
        let share = -below / rise;
        let rest = 1.0 - share;
        let bend = rise * share * rest * (rest / growth(low) - share / growth(high));
        let guess = a + share * share * (3.0 - 2.0 * share) * (b - a) + bend;
        ((a, b), guess)
    }
}

/// A part of a primitive seen from its middle, with bounds of the derivatives all over it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Middle {
    pub(super) jet: Jet,
    half: f64,
    second: f64,
    third: f64,
    most_speed: f64,
}

impl Middle {
    pub(super) fn of(primitive: &Primitive, from: f64, to: f64) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let jet = primitive.evaluate(middle);
        let (second, third) = primitive.derivative_bounds(middle, half);
        let most_speed = jet.first.norm() + half * second;
        Self { jet, half, second, third, most_speed }
    }

    /// Whether g', see [`minimum`](super::minimum), is positive (true) or negative (false) all over the part; `None` if the
    /// bounds do not tell.
    pub(super) fn slope_sign(&self, point: Vector2<f64>) -> Option<bool> {
        let away = self.jet.point - point;
        let most_distance = away.norm() + self.half * self.most_speed;
        let slope = self.jet.first.norm_squared() + away.dot(&self.jet.second);
        let change = self.half * (3.0 * self.most_speed * self.second + most_distance * self.third);
        (slope.abs() > change).then_some(slope > 0.0)
    }
}
