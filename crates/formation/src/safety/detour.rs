//! The way round what stands between a robot and its goal.
//!
//! What blocks the straight way is taken together with all that is too near to it to pass between (the combined hull
//! of 7.4, seen from the robot's centre), and the robot heads for the tangent to this cluster on the side of the shorter
//! way. Ties and near ties go to the right, for all robots alike: two that meet head-on see each other point-symmetrically,
//! so both keep right, and so do four that meet at one point. What crosses the way is passed behind its back. Without a side to keep to, only positions decide, so there is nothing to forget.
use super::SafetyParameters;
use super::scene::{Constraint, Scene};
use crate::hull::Outline;
use crate::kinematics::wrap;
use core::f64::consts::{FRAC_PI_2, TAU};
use nalgebra::Vector2;

/// How far ahead a blockage matters, m.
const LOOK_AHEAD: f64 = 0.6;
/// Space between a way round and what is passed, beyond the filter's margin, m.
const BUFFER: f64 = 0.02;
/// Least part of it: a way at no distance at all from what is passed would have to be driven at no speed at all.
const SLACK: f64 = 0.005;
/// By how much the way on the left must be shorter to be taken, m.
const RIGHT_BIAS: f64 = 0.05;
/// By how much the way on the other side must be shorter for a robot that keeps to one to change over, m.
const KEPT_BIAS: f64 = 0.3;
/// Cosine at which a way along a barrier leads away from it.
const LEAVING: f64 = 0.05;
/// A goal that can be approached to within this counts as one that can be reached, m.
const ARRIVAL: f64 = 0.03;
/// What rounding may take from a distance, m.
const ROUNDING: f64 = 1e-9;
/// Most blockages considered: the bits of the cluster's set.
const MOST_ITEMS: usize = 128;
/// Most clusters joined one after the other on the way to a tangent point.
const MOST_ROUNDS: usize = 4;

/// Direction to take, and what blocks the straight way.
pub(super) struct Detour {
    pub(super) direction: Vector2<f64>,
    pub(super) blocker: Constraint,
    pub(super) side: Side,
}

/// One end of a cluster as seen from the robot: the angle from the direction to the goal, and the tangent point.
#[derive(Clone, Copy)]
struct Extent {
    angle: f64,
    point: Vector2<f64>,
    /// The corner that it is a tangent to, and the distance kept from it.
    corner: Vector2<f64>,
    berth: f64,
}

/// The side of the robot's way on which the way round lies; a cluster's extent has its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// To the right.
    Right = 0,
    /// To the left.
    Left = 1,
}

/// The robot's view of its surroundings.
pub(super) struct View<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) parameters: &'a SafetyParameters,
    pub(super) centre: Vector2<f64>,
    pub(super) goal: Vector2<f64>,
    /// The side that the robot took last.
    pub(super) kept: Option<Side>,
    /// How fast it goes round, m/s.
    pub(super) pace: f64,
}

impl View<'_> {
    /// The way round, if the straight way to the goal is blocked and there is one.
    pub(super) fn detour(&self) -> Option<Detour> {
        let first = self.first_blocker(self.goal, 0)?;
        let (members, extents) = self.cluster(0, first);
        let [right, left] = [Side::Right, Side::Left].map(|side| self.tangent(side, members, extents));
        let bias = match self.kept {
            None => RIGHT_BIAS,
            Some(Side::Right) => KEPT_BIAS,
            Some(Side::Left) => -KEPT_BIAS,
        };
        let drift = self.drift(first);
        let left_is_shorter = |right: Extent, left: Extent| {
            self.way_length(&left, Side::Left) + drift + bias < self.way_length(&right, Side::Right)
        };
        let (target, side) = match (right, left) {
            (Some(right), Some(left)) if left_is_shorter(right, left) => (left.point, Side::Left),
            (Some(right), _) => (right.point, Side::Right),
            (None, Some(left)) => (left.point, Side::Left),
            (None, None) => return None,
        };
        let direction = self.along_barriers((target - self.centre).try_normalize(0.0)?);
        Some(Detour { direction, blocker: self.constraint(first), side })
    }

    /// How far to the left (m) of the straight way an item is carried by its motion while the robot comes to it: the way
    /// before its front becomes longer and the one behind its back shorter, together by that much at least. So what crosses
    /// is passed behind its back, and nobody is led along by a robot whose front it tries to pass.
    fn drift(&self, item: usize) -> f64 {
        let velocity = match self.constraint(item) {
            Constraint::Neighbour(index) => self.scene.neighbours[index].velocity,
            Constraint::Obstacle(index) => self.scene.obstacles[index].velocity,
            Constraint::Edge(_) | Constraint::NotFinite => Vector2::zeros(),
        };
        let away = self.outline(item).approach(self.centre).gap.clamp(0.0, LOOK_AHEAD);
        let ahead = (self.goal - self.centre).try_normalize(0.0).unwrap_or_default();
        ahead.perp(&velocity) * away / self.pace
    }

    /// Turns `direction` along what the robot all but touches, which would stop it otherwise.
    fn along_barriers(&self, mut direction: Vector2<f64>) -> Vector2<f64> {
        for barrier in self.scene.barriers(self.centre, self.parameters, 0.0).filter(|barrier| barrier.budget < SLACK) {
            let excess = direction.dot(&barrier.towards) + LEAVING;
            let slid = direction - excess.max(0.0) * barrier.towards;
            direction = slid.try_normalize(0.1).unwrap_or(direction);
        }
        direction
    }

    /// The tangent on one side of a cluster and of all that blocks the way to it; `None` if that side is closed.
    fn tangent(&self, side: Side, mut members: u128, mut extents: [Extent; 2]) -> Option<Extent> {
        for _ in 0..MOST_ROUNDS {
            if extents[1].angle - extents[0].angle >= TAU || !self.is_open(side, members) {
                return None;
            }
            let extent = extents[side as usize];
            match self.first_blocker(extent.point, members) {
                Some(next) => (members, extents) = self.cluster(members, next),
                None => return Some(extent),
            }
        }
        None
    }

    fn count(&self) -> usize {
        (self.scene.neighbours.len() + self.scene.obstacles.len()).min(MOST_ITEMS)
    }

    fn constraint(&self, item: usize) -> Constraint {
        match item.checked_sub(self.scene.neighbours.len()) {
            Some(obstacle) => Constraint::Obstacle(obstacle),
            None => Constraint::Neighbour(item),
        }
    }

    fn outline(&self, item: usize) -> Outline<'_> {
        match item.checked_sub(self.scene.neighbours.len()) {
            Some(obstacle) => self.scene.obstacles[obstacle].outline,
            None => self.scene.neighbours[item].outline(),
        }
    }

    /// Least distance of the robot's centre from an item's polygon.
    fn touching(&self, outline: &Outline<'_>) -> f64 {
        outline.radius + self.parameters.radius + self.parameters.margin
    }

    /// Moves the goal out of items that cover it but let the robot come within [`ARRIVAL`] of it.
    pub(super) fn with_goal_uncovered(mut self) -> Self {
        for item in 0..self.count() {
            let outline = self.outline(item);
            let approach = outline.approach(self.goal);
            let covered = self.touching(&outline) - (approach.gap + outline.radius);
            if covered > 0.0 && covered <= ARRIVAL {
                self.goal -= covered * approach.towards;
            }
        }
        self
    }

    /// Distance that the centre keeps from an item's polygon on a way round: less if the goal is nearer than that.
    /// `None` if the item covers the goal for good; then there is no way round, and the robot stops near it.
    fn berth(&self, item: usize) -> Option<f64> {
        let outline = self.outline(item);
        let touching = self.touching(&outline);
        let goal_distance = self.goal_distance(&outline);
        let stays = self.scene.neighbours.get(item).is_none_or(|neighbour| neighbour.settled || !neighbour.cooperative);
        if goal_distance >= touching - ROUNDING {
            return Some(goal_distance.clamp(touching + SLACK, touching + BUFFER));
        }
        (!stays).then_some(touching + BUFFER)
    }

    fn goal_distance(&self, outline: &Outline<'_>) -> f64 {
        outline.approach(self.goal).gap + outline.radius
    }

    /// The nearest item, not in `passed`, on the straight way to `target`.
    fn first_blocker(&self, target: Vector2<f64>, passed: u128) -> Option<usize> {
        let way = target - self.centre;
        let length = way.norm();
        let direction = way.try_normalize(0.0)?;
        let end = self.centre + length.min(LOOK_AHEAD) * direction;
        let points = [self.centre, end];
        let path = Outline { points: &points, radius: 0.0 };
        let blocking = |item: &usize| {
            let berth = self.berth(*item)?;
            let outline = self.outline(*item);
            let approach = outline.approach(self.centre);
            let distance = approach.gap + outline.radius;
            // Less than the berth, because the tangent must itself be free, and less than the goal's distance.
            let free = (berth - SLACK).min(self.goal_distance(&outline) - ROUNDING);
            let blocks = outline.gap(&path) + outline.radius < free;
            (blocks && approach.towards.dot(&direction) > 0.0).then_some(distance)
        };
        let items = (0..self.count()).filter(|item| passed & (1 << item) == 0);
        items
            .filter_map(|item| blocking(&item).map(|distance| (item, distance)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(item, _)| item)
    }

    /// Adds `seed`, and all that leaves no passage to a member, to the cluster; its extents to the right and left.
    fn cluster(&self, members: u128, seed: usize) -> (u128, [Extent; 2]) {
        let mut angles = [0.0; MOST_ITEMS];
        let mut queue = [seed; MOST_ITEMS];
        let (mut known, mut length) = (1_u128 << seed, 1);
        let towards_goal = self.goal - self.centre;
        let bearing = |item: usize| {
            let approach = self.outline(item).approach(self.centre);
            libm::atan2(towards_goal.perp(&approach.towards), towards_goal.dot(&approach.towards))
        };
        angles[seed] = bearing(seed);
        for item in (0..self.count()).filter(|item| members & (1 << item) != 0 && *item != seed) {
            (queue[length], angles[item]) = (item, bearing(item));
            (known, length) = (known | 1 << item, length + 1);
        }
        let start = Extent { angle: 0.0, point: self.centre, corner: self.centre, berth: 0.0 };
        let mut extents = [Extent { angle: f64::INFINITY, ..start }, Extent { angle: f64::NEG_INFINITY, ..start }];
        let mut next = 0;
        while next < length {
            let item = queue[next];
            next += 1;
            let Some(berth) = self.berth(item) else { continue };
            self.widen(&mut extents, item, berth, angles[item]);
            for other in 0..self.count() {
                if known & (1 << other) == 0 && self.leaves_no_passage(item, berth, other) {
                    known |= 1 << other;
                    queue[length] = other;
                    length += 1;
                    angles[other] = angles[item] + wrap(bearing(other) - angles[item]);
                }
            }
        }
        (known, extents)
    }

    fn leaves_no_passage(&self, item: usize, berth: f64, other: usize) -> bool {
        let (a, b) = (self.outline(item), self.outline(other));
        self.berth(other).is_some_and(|other_berth| a.gap(&b) + a.radius + b.radius < berth + other_berth)
    }

    /// Widens the extents by the tangents to each corner of an item; from inside its berth, the way leads out.
    fn widen(&self, extents: &mut [Extent; 2], item: usize, berth: f64, bearing: f64) {
        let to_goal = self.goal - self.centre;
        for corner in self.outline(item).points {
            let arm = corner - self.centre;
            let distance = arm.norm();
            let angle = bearing + wrap(libm::atan2(to_goal.perp(&arm), to_goal.dot(&arm)) - bearing);
            let (half, length) = if distance > berth {
                (libm::asin(berth / distance), (distance * distance - berth * berth).sqrt())
            } else {
                let inside = ((berth - distance) / BUFFER).min(1.0);
                (FRAC_PI_2 + 0.05 + 0.5 * inside, 0.0)
            };
            for (extent, sign) in extents.iter_mut().zip([-1.0, 1.0]) {
                let edge = angle + sign * half;
                if sign * edge > sign * extent.angle {
                    let (sine, cosine) = libm::sincos(edge);
                    let ahead = to_goal.normalize() * length.max(BUFFER);
                    let point = Vector2::new(cosine * ahead.x - sine * ahead.y, sine * ahead.x + cosine * ahead.y);
                    *extent = Extent { angle: edge, point: self.centre + point, corner: *corner, berth };
                }
            }
        }
    }

    /// Length of the way round the corner that makes an extent: two tangents and an arc.
    fn way_length(&self, extent: &Extent, side: Side) -> f64 {
        let (to_centre, to_goal) = (self.centre - extent.corner, self.goal - extent.corner);
        let tangent = |arm: Vector2<f64>| {
            let (distance, berth) = (arm.norm(), extent.berth);
            let length = (distance * distance - berth * berth).max(0.0).sqrt();
            (length, libm::atan2(length, berth))
        };
        let ((before, skipped), (after, skipped_after)) = (tangent(to_centre), tangent(to_goal));
        let arc = (side.sweep(to_centre, to_goal) - skipped - skipped_after).max(0.0);
        before + extent.berth * arc + after
    }

    /// Whether no member leaves so little space to the field's edge that the edge closes this side.
    fn is_open(&self, side: Side, members: u128) -> bool {
        let keep = self.parameters.radius + self.parameters.margin;
        let items = (0..self.count()).filter(|item| members & (1 << item) != 0);
        items.flat_map(|item| self.outline(item).points.iter().map(move |corner| (item, *corner))).all(
            |(item, corner)| {
                let passage = self.outline(item).radius + 2.0 * keep;
                let (to_centre, to_goal) = (self.centre - corner, self.goal - corner);
                let way = side.sweep(to_centre, to_goal);
                self.scene.field_edges().all(|(_, start, outward)| {
                    (start - corner).dot(&outward) >= passage || side.sweep(to_centre, outward) > way
                })
            },
        )
    }
}

impl Side {
    /// Angle in [0, 2 pi) through which one goes about a corner from `from` to `to`: what is passed on the right lies to
    /// the left, so one goes counter-clockwise about it.
    fn sweep(self, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
        let turn = libm::atan2(from.perp(&to), from.dot(&to));
        let sweep = if self == Self::Right { turn } else { -turn };
        if sweep < 0.0 { sweep + TAU } else { sweep }
    }
}
