//! A curve seen from the frame in which its formation moves.
use super::{Curve, Feet, Foot, Interval, NearestSet, Warm};
use crate::lanes::{LANES, Lanes, Plane, Vectors};
use nalgebra::{Isometry2, Vector2};

/// A curve and the pose of its frame, for instance the target's: all queries are in frame `map`.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    curve: &'a Curve,
    map_from_curve: Isometry2<f64>,
}

impl<'a> Placed<'a> {
    /// Places `curve` by the transform that takes its frame to `map`.
    pub fn new(curve: &'a Curve, map_from_curve: Isometry2<f64>) -> Self {
        Self { curve, map_from_curve }
    }

    /// The curve in its own frame.
    pub fn curve(&self) -> &'a Curve {
        self.curve
    }

    /// Point, tangent and curvature at `arc_length`, as [`Curve::at`].
    pub fn at(&self, arc_length: f64) -> Foot {
        self.to_map(self.curve.at(arc_length))
    }

    /// As [`Curve::nearest`].
    pub fn nearest(&self, point: Vector2<f64>) -> Foot {
        self.to_map(self.curve.nearest(self.to_curve(point)))
    }

    /// As [`Curve::nearest_again`].
    pub fn nearest_again(&self, point: Vector2<f64>, warm: &mut Warm) -> Foot {
        self.to_map(self.curve.nearest_again(self.to_curve(point), warm))
    }

    /// As [`Curve::nearest_abreast`].
    #[inline(always)]
    pub(crate) fn nearest_abreast<L: Lanes>(&self, points: Vectors<L>, warm: [&Warm; LANES]) -> Option<Feet<L>> {
        let (rotation, translation) = (self.map_from_curve.rotation, self.map_from_curve.translation.vector);
        let turned = |re: f64, im: f64, vectors: Vectors<L>| {
            let (re, im) = (L::splat(re), L::splat(im));
            Vectors { x: re * vectors.x - im * vectors.y, y: im * vectors.x + re * vectors.y }
        };
        let translation = Vectors::splat(translation);
        let feet = self.curve.nearest_abreast(turned(rotation.re, -rotation.im, points - translation), warm)?;
        Some(Feet { point: turned(rotation.re, rotation.im, feet.point) + translation, ..feet })
    }

    /// As [`Curve::nearest_within`].
    pub fn nearest_within(&self, point: Vector2<f64>, interval: Interval) -> Foot {
        self.to_map(self.curve.nearest_within(self.to_curve(point), interval))
    }

    /// As [`Curve::nearest_all`].
    pub fn nearest_all(&self, point: Vector2<f64>) -> NearestSet {
        let mut set = self.curve.nearest_all(self.to_curve(point));
        for foot in &mut set.feet {
            *foot = self.to_map(*foot);
        }
        set
    }

    /// As [`Curve::track`].
    pub fn track(&self, point: Vector2<f64>, arc_length: f64) -> Foot {
        self.to_map(self.curve.track(self.to_curve(point), arc_length))
    }

    /// As [`Curve::extent`], along an axis of `map`.
    pub fn extent(&self, axis: Vector2<f64>) -> (f64, f64) {
        let (low, high) = self.curve.extent(self.map_from_curve.rotation.inverse() * axis);
        let offset = self.map_from_curve.translation.vector.dot(&axis);
        (low + offset, high + offset)
    }

    /// As [`Curve::met_along`].
    pub fn met_along(&self, point: Vector2<f64>, direction: Vector2<f64>) -> Vec<Foot> {
        let direction = self.map_from_curve.rotation.inverse() * direction;
        let feet = self.curve.met_along(self.to_curve(point), direction);
        feet.into_iter().map(|foot| self.to_map(foot)).collect()
    }

    /// The point of attraction of a robot at `point` along `direction` (not zero, frame `map`), as [`Curve::met_along`]: on `intervals` the
    /// one nearest to the robot. Where there is none, the end of an interval or the outermost point that the line passes most closely,
    /// which does not move along with the robot: then false comes with it. Nothing without intervals.
    pub fn attracting_along(
        &self,
        point: Vector2<f64>,
        direction: Vector2<f64>,
        intervals: &[Interval],
    ) -> Option<(Foot, bool)> {
        let (point, direction) = (self.to_curve(point), self.map_from_curve.rotation.inverse() * direction);
        let met = self.curve.first_met(point, direction, intervals).map(|foot| (foot, true));
        let foot = met.or_else(|| Some((self.curve.passed_most_closely(point, direction, intervals)?, false)));
        foot.map(|(foot, is_met)| (self.to_map(foot), is_met))
    }

    /// A direction of the curve's frame.
    pub fn direction_in_map(&self, direction: Vector2<f64>) -> Vector2<f64> {
        self.map_from_curve.rotation * direction
    }

    /// A direction of the frame in which the curve moves in the curve's.
    pub(super) fn direction_to_curve(&self, direction: Vector2<f64>) -> Vector2<f64> {
        self.map_from_curve.rotation.inverse() * direction
    }

    /// A point of the curve's frame in that in which it moves, m.
    pub fn point_to_map(self, point: Vector2<f64>) -> Vector2<f64> {
        self.map_from_curve.transform_point(&point.into()).coords
    }

    /// A point of the frame in which the curve moves in the curve's, m.
    pub fn to_curve(self, point: Vector2<f64>) -> Vector2<f64> {
        self.map_from_curve.inverse_transform_point(&point.into()).coords
    }

    pub(super) fn to_map(self, foot: Foot) -> Foot {
        Foot { point: self.point_to_map(foot.point), tangent: self.map_from_curve.rotation * foot.tangent, ..foot }
    }
}
