//! Nearest points of a curve, (7.1) and (7.2): certified, with multiplicity.
use super::candidates::BLOCKS;
use super::minimum::{Least, Minimum, interior_minima, only_minimum, solve};
use super::piece::Straight;
use super::primitive::Jet;
use super::{Curve, Foot};
use crate::lanes::{LANES, Lanes, Work, in_widest};
use nalgebra::Vector2;

/// Distances that differ by no more than this (times 1 m + the distance) are equal.
const TIE: f64 = 1e-9;
/// Chords are as far as they look but for this part of the square, and of the curve's length, m.
pub(super) const CHORD: f64 = 1e-12;
/// Minima nearer to each other along the curve than this (m) are one.
const SAME: f64 = 1e-7;

/// All points of a curve at the least distance from a point, (7.2).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NearestSet {
    /// The isolated ones, by arc length.
    pub feet: Vec<Foot>,
    /// Arc length intervals that are nearest as a whole: the point is the centre of an arc.
    pub ranges: Vec<(f64, f64)>,
}

/// Where a foot is: on a piece at a parameter, or on an extension.
#[derive(Debug, Clone, Copy)]
enum Place {
    On(usize, f64),
    Before(f64),
    After(f64),
}

/// The nearest point of the pieces looked at, so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Best {
    pub(super) distance: f64,
    pub(super) piece: usize,
    parameter: f64,
    /// The primitive there, where it is known already.
    jet: Option<Jet>,
}

/// The search for the best of some pieces: first that of the nearest chord, then those whose chords are no farther than they may lie off.
struct Among<'a> {
    curve: &'a Curve,
    point: Vector2<f64>,
    blocks: &'a [[u32; LANES]],
}

impl Work for Among<'_> {
    type Output = Best;

    #[inline(always)]
    fn in_lanes<L: Lanes>(self) -> Best {
        let Self { curve, point, blocks } = self;
        let nothing = L::splat(f64::INFINITY);
        let (mut squares, mut least, mut block_of) = ([nothing; BLOCKS], nothing, [0; LANES]);
        for (offset, (square, block)) in squares.iter_mut().zip(blocks).enumerate() {
            *square = curve.candidates.distances_squared::<L>(block, point);
            let nearer = square.is_below(least).bits();
            least = square.least(least);
            block_of = core::array::from_fn(|lane| if nearer & 1 << lane != 0 { offset } else { block_of[lane] });
        }
        let least = least.to_array();
        let (mut first, mut at) = (LANES * block_of[0], least[0]);
        for lane in 1..LANES {
            let place = LANES * block_of[lane] + lane;
            (first, at) = if least[lane] < at { (place, least[lane]) } else { (first, at) };
        }
        let piece = |place: usize| blocks[place / LANES][place % LANES] as usize;
        let mut best = curve.none_yet();
        curve.look_at(point, piece(first), &mut best);
        let far = L::splat(curve.most_square(curve.sagitta, &best));
        // A bit for each other that is no farther.
        let mut others = 0;
        for (offset, square) in squares.iter().enumerate() {
            others |= square.is_at_most(far).bits() << (LANES * offset);
        }
        others &= !(1 << first);
        while others != 0 {
            curve.improve(point, piece(others.trailing_zeros() as usize), &mut best);
            others &= others - 1;
        }
        best
    }
}

impl Curve {
    /// A nearest point of the curve: the one of least arc length if there are several on a par to the last bit.
    pub fn nearest(&self, point: Vector2<f64>) -> Foot {
        self.beyond_ends(point, self.best(point))
    }

    /// The best of all pieces.
    pub(super) fn best(&self, point: Vector2<f64>) -> Best {
        match self.candidates.near(point) {
            Some(near) => self.best_among(point, near),
            None => self.best_by_boxes(point),
        }
    }

    /// [`Self::best`] by the tree of boxes.
    fn best_by_boxes(&self, point: Vector2<f64>) -> Best {
        let mut best = self.none_yet();
        self.tree.visit_near(point, best.distance, |index| self.improve(point, index, &mut best));
        best
    }

    /// The best of some pieces.
    #[inline]
    fn best_among(&self, point: Vector2<f64>, blocks: &[[u32; LANES]]) -> Best {
        in_widest(Among { curve: self, point, blocks })
    }

    /// The best of all pieces, quickest if the piece `first` is near it.
    pub(super) fn best_from(&self, point: Vector2<f64>, first: usize) -> Best {
        if let Some(near) = self.candidates.near(point) {
            return self.best_among(point, near);
        }
        let mut best = self.none_yet();
        let reach = self.improve(point, first, &mut best);
        self.tree.visit_near(point, reach, |index| match index == first {
            true => best.distance,
            false => self.improve(point, index, &mut best),
        });
        best
    }

    /// The best of a piece and those beside it, where that is quickly seen to be inside it.
    #[inline]
    pub(super) fn rest(&self, point: Vector2<f64>, index: usize) -> Option<Best> {
        let (parameter, jet) = self.pieces[index].bend.as_ref()?.rest(point)?;
        Some(Best { distance: (jet.point - point).norm(), piece: index, parameter, jet: Some(jet) })
    }

    pub(super) fn none_yet(&self) -> Best {
        Best { distance: f64::INFINITY, piece: 0, parameter: self.pieces[0].from, jet: None }
    }

    /// Takes what a piece has that is nearer than `best`; the distance from then on.
    #[inline]
    pub(super) fn improve(&self, point: Vector2<f64>, index: usize, best: &mut Best) -> f64 {
        let piece = &self.pieces[index];
        if piece.chord_distance_squared(point) <= self.most_square(piece.sagitta, best) {
            self.look_at(point, index, best);
        }
        best.distance
    }

    /// How far the chord of a piece of this sagitta (m) may be, as a square (m^2), for something of it to be as near as `best`.
    #[inline(always)]
    fn most_square(&self, sagitta: f64, best: &Best) -> f64 {
        let far = best.distance + sagitta;
        far * far * (1.0 + CHORD) + CHORD * self.length
    }

    /// [`Self::improve`] for a piece that is likely to be nearer.
    #[inline]
    pub(super) fn look_at(&self, point: Vector2<f64>, index: usize, best: &mut Best) {
        let piece = &self.pieces[index];
        let Some(straight) = self.straights.get(index) else { return self.look_at_bend(point, index, best) };
        let parameter = straight.nearest(point).max(piece.from).min(piece.to);
        let distance = (straight.at(parameter) - point).norm();
        if (distance, index, parameter) < (best.distance, best.piece, best.parameter) {
            *best = Best { distance, piece: index, parameter, jet: None };
        }
    }

    /// The same for a piece of a curve that is not straight all over.
    #[inline(never)]
    fn look_at_bend(&self, point: Vector2<f64>, index: usize, best: &mut Best) {
        let piece = &self.pieces[index];
        let primitive = &self.primitives[piece.primitive];
        let mut offer = |distance: f64, parameter: f64, jet: Option<Jet>| {
            if (distance, index, parameter) < (best.distance, best.piece, best.parameter) {
                *best = Best { distance, piece: index, parameter, jet };
            }
            best.distance
        };
        // On most pieces the distance has one minimum, and the ends tell where.
        match only_minimum(primitive, piece, point) {
            Some(Least::Start) => {
                offer((piece.start - point).norm(), piece.from, None);
            }
            Some(Least::End) => {
                offer((piece.end - point).norm(), piece.to, None);
            }
            Some(Least::Inside(parameter, jet)) => {
                offer((jet.point - point).norm(), parameter, Some(jet));
            }
            None => {
                offer((piece.start - point).norm(), piece.from, None);
                let reach = offer((piece.end - point).norm(), piece.to, None);
                interior_minima(primitive, piece, point, reach, |minimum| match minimum {
                    Minimum::At { parameter, distance, jet, .. } => offer(distance, parameter, Some(jet)),
                    Minimum::Everywhere { distance } => offer(distance, piece.from, None),
                });
            }
        }
    }

    /// The foot, on an extension if that is nearer.
    #[inline]
    pub(super) fn beyond_ends(&self, point: Vector2<f64>, best: Best) -> Foot {
        if !(self.open_start || self.open_end) {
            if let Some(jet) = &best.jet {
                return self.foot_at(best.piece, best.parameter, jet, best.distance);
            } else if let Some(straight) = self.straights.get(best.piece) {
                return self.foot_on_straight(&best, straight);
            }
        }
        let nearer = self.extensions(point).filter(|(distance, _)| *distance < best.distance);
        let extension = nearer.min_by(|a, b| a.0.total_cmp(&b.0));
        match (extension, best.jet) {
            (Some((_, place)), _) => self.foot(place, point),
            (None, Some(jet)) => self.foot_at(best.piece, best.parameter, &jet, best.distance),
            (None, None) => self.foot(Place::On(best.piece, best.parameter), point),
        }
    }

    /// All nearest points, with none missed: equal to within 1e-9 (1 m + distance).
    pub fn nearest_all(&self, point: Vector2<f64>) -> NearestSet {
        let distance = self.nearest(point).distance;
        let reach = distance + TIE * (1.0 + distance);
        let mut set = NearestSet::default();
        let mut places: Vec<(Place, f64)> =
            self.extensions(point).filter(|(distance, _)| *distance <= reach).map(|(_, place)| (place, 0.0)).collect();
        self.tree.visit_near(point, reach, |index| {
            let piece = &self.pieces[index];
            for (joint, end, parameter) in [(index, piece.start, piece.from), (index + 1, piece.end, piece.to)] {
                if (end - point).norm() <= reach && self.is_minimum_at_joint(joint, end - point) {
                    places.push((Place::On(index, parameter), 0.0));
                }
            }
            interior_minima(&self.primitives[piece.primitive], piece, point, reach, |minimum| {
                match minimum {
                    Minimum::At { parameter, distance, width, .. } if distance <= reach => {
                        places.push((Place::On(index, parameter), width * piece.length / (piece.to - piece.from)));
                    }
                    Minimum::At { .. } => {}
                    Minimum::Everywhere { .. } => set.ranges.push((piece.offset, piece.offset + piece.length)),
                }
                reach
            });
            reach
        });
        let mut feet: Vec<(Foot, f64)> =
            places.into_iter().map(|(place, width)| (self.foot(place, point), width)).collect();
        feet.sort_by(|a, b| a.0.arc_length.total_cmp(&b.0.arc_length));
        join_ranges(&mut set.ranges);
        set.feet = self.distinct(feet, &set.ranges);
        set
    }

    /// Follows the local minimum of the distance that a foot at `arc_length` belongs to, for a point that moved a
    /// little (a robot that keeps its own nearest point, Assumption 7.2.1). It need not be the global minimum.
    pub fn track(&self, point: Vector2<f64>, arc_length: f64) -> Foot {
        let count = self.pieces.len();
        let (mut index, mut parameter) = self.locate(arc_length.clamp(0.0, self.length));
        for _ in 0..=count {
            let piece = &self.pieces[index];
            let primitive = &self.primitives[piece.primitive];
            let slope = |u: f64| primitive.evaluate(u).slope(point);
            let forward = slope(parameter) < 0.0;
            let end = if forward { piece.to } else { piece.from };
            if (slope(end) < 0.0) != forward {
                let bracket = if forward { (parameter, end) } else { (end, parameter) };
                return self.foot(Place::On(index, solve(primitive, bracket, parameter, point, 0.0)), point);
            }
            parameter = end;
            let leaves = if forward { index + 1 == count } else { index == 0 };
            if leaves && !self.closed {
                let beyond =
                    |place: &Place| matches!((place, forward), (Place::Before(_), false) | (Place::After(_), true));
                let extension = self.extensions(point).map(|(_, place)| place).find(beyond);
                return self.foot(extension.unwrap_or(Place::On(index, parameter)), point);
            }
            let next = if forward { (index + 1) % count } else { (index + count - 1) % count };
            let entry = if forward { self.pieces[next].from } else { self.pieces[next].to };
            let jet = self.primitives[self.pieces[next].primitive].evaluate(entry);
            if (jet.slope(point) < 0.0) != forward {
                break; // a corner: the distance grows on both sides of it
            }
            (index, parameter) = (next, entry);
        }
        self.foot(Place::On(index, parameter), point)
    }

    /// Feet on the tangents beyond open ends, with their distances.
    fn extensions(&self, point: Vector2<f64>) -> impl Iterator<Item = (f64, Place)> {
        let start = self.open_start.then(|| self.at_end(false)).and_then(|(first, tangent)| {
            let before = (first - point).dot(&tangent);
            (before > 0.0).then(|| ((first - before * tangent - point).norm(), Place::Before(before)))
        });
        let end = self.open_end.then(|| self.at_end(true)).and_then(|(last, tangent)| {
            let after = (point - last).dot(&tangent);
            (after > 0.0).then(|| ((last + after * tangent - point).norm(), Place::After(after)))
        });
        start.into_iter().chain(end)
    }

    /// Arc lengths of the feet on the extensions.
    pub(super) fn extension_feet(&self, point: Vector2<f64>) -> impl Iterator<Item = f64> {
        let length = self.length;
        self.extensions(point).filter_map(move |(_, place)| match place {
            Place::Before(beyond) => Some(-beyond),
            Place::After(beyond) => Some(length + beyond),
            Place::On(..) => None,
        })
    }

    /// The foot at a parameter of a piece.
    pub(super) fn foot_on(&self, index: usize, parameter: f64, point: Vector2<f64>) -> Foot {
        self.foot(Place::On(index, parameter), point)
    }

    /// Whether the distance falls towards the start of piece `joint` from neither side; `away` points to the joint.
    fn is_minimum_at_joint(&self, joint: usize, away: Vector2<f64>) -> bool {
        let slack = 1e-9 * away.norm();
        let (count, at) = (self.pieces.len(), if self.closed { joint % self.pieces.len() } else { joint });
        let before = (at > 0 || self.closed).then(|| self.tangents_around(at).0);
        let after = (at < count).then(|| self.tangents_around(at).1);
        let start = if self.open_start { Some(self.at_end(false).1) } else { None };
        let end = if self.open_end { Some(self.at_end(true).1) } else { None };
        before.or(start).is_none_or(|tangent| away.dot(&tangent) <= slack)
            && after.or(end).is_none_or(|tangent| away.dot(&tangent) >= -slack)
    }

    fn foot(&self, place: Place, point: Vector2<f64>) -> Foot {
        let (arc_length, on_curve, tangent) = match place {
            Place::On(index, parameter) => {
                let jet = self.primitives[self.pieces[index].primitive].evaluate(parameter);
                return self.foot_at(index, parameter, &jet, (jet.point - point).norm());
            }
            Place::Before(beyond) => {
                let (start, tangent) = self.at_end(false);
                (-beyond, start - beyond * tangent, tangent)
            }
            Place::After(beyond) => {
                let (end, tangent) = self.at_end(true);
                (self.length + beyond, end + beyond * tangent, tangent)
            }
        };
        Foot { arc_length, point: on_curve, tangent, curvature: 0.0, distance: (on_curve - point).norm() }
    }

    /// The foot at a parameter of a piece, where its primitive is as `jet` says.
    #[inline]
    fn foot_at(&self, index: usize, parameter: f64, jet: &Jet, distance: f64) -> Foot {
        let speed = jet.first.norm();
        Foot {
            arc_length: self.arc_length_at(index, parameter),
            point: jet.point,
            tangent: jet.first / speed,
            curvature: jet.first.perp(&jet.second) / (speed * speed * speed),
            distance,
        }
    }

    /// The same on a straight piece.
    #[inline]
    fn foot_on_straight(&self, best: &Best, straight: &Straight) -> Foot {
        Foot {
            arc_length: self.arc_length_at(best.piece, best.parameter),
            point: straight.at(best.parameter),
            tangent: straight.tangent,
            curvature: straight.curvature,
            distance: best.distance,
        }
    }

    /// One foot for each group that is one minimum (the nearest of it), none inside the ranges.
    fn distinct(&self, feet: Vec<(Foot, f64)>, ranges: &[(f64, f64)]) -> Vec<Foot> {
        let mut groups: Vec<(Foot, f64)> = Vec::new();
        let mut edge = f64::NEG_INFINITY;
        for (foot, width) in feet {
            let in_range =
                ranges.iter().any(|&(from, to)| from - SAME <= foot.arc_length && foot.arc_length <= to + SAME);
            let joins = foot.arc_length - width <= edge + SAME;
            edge = foot.arc_length + width;
            match groups.last_mut() {
                _ if in_range => {}
                Some(group) if joins && group.0.distance <= foot.distance => {}
                Some(group) if joins => group.0 = foot,
                _ => groups.push((foot, width)),
            }
        }
        if self.closed && groups.len() > 1 {
            let (first, last) = (groups[0].0.arc_length, groups[groups.len() - 1].0.arc_length);
            if first + self.length - last <= SAME + groups[0].1 + groups[groups.len() - 1].1 {
                groups.pop();
            }
        }
        groups.into_iter().map(|(foot, _)| foot).collect()
    }
}

/// Sorts intervals and joins those that touch.
fn join_ranges(ranges: &mut Vec<(f64, f64)>) {
    ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranges.dedup_by(|next, kept| {
        let touches = next.0 <= kept.1 + SAME;
        if touches {
            kept.1 = kept.1.max(next.1);
        }
        touches
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::CurveShape;
    use proptest::prelude::*;
    use wide::f64x4;

    proptest! {
        /// What the squares of the grid are told misses nothing: near the curve and far, by chords and by bends, at joints and between them,
        /// on processors with AVX and without.
        #[test]
        fn candidates_hold_the_nearest_piece(
            turns in prop::collection::vec(-0.9..0.9_f64, 4..60), lengths in prop::collection::vec(0.02..2.0_f64, 60),
            queries in prop::collection::vec((-0.3..1.3_f64, -0.3..1.3_f64), 200), curved in any::<bool>(),
        ) {
            let (mut heading, mut corners) = (0.0, vec![Vector2::zeros()]);
            for (turn, length) in turns.iter().zip(&lengths) {
                heading = 0.7 * heading + turn;
                let (sine, cosine) = libm::sincos(heading);
                corners.push(corners[corners.len() - 1] + *length * Vector2::new(cosine, sine));
            }
            let joints = corners.clone();
            let shape = if curved { CurveShape::Spline(corners) } else { CurveShape::Polyline(corners) };
            let Ok(curve) = Curve::new(&shape, false, false) else { return Ok(()) };
            let bounds = |by: fn(&Vector2<f64>, &Vector2<f64>) -> Vector2<f64>| joints.iter().copied().reduce(|a, b| by(&a, &b)).unwrap();
            let (low, high) = (bounds(Vector2::inf), bounds(Vector2::sup));
            let (mut told, reach) = (0, (high - low).max());
            let spots = queries.iter().map(|(x, y)| low + reach * Vector2::new(*x, *y));
            for point in spots.chain(joints.iter().copied()) {
                let Some(candidates) = curve.candidates.near(point) else { continue };
                let of_all = curve.best_by_boxes(point);
                let portable = Among { curve: &curve, point, blocks: candidates }.in_lanes::<f64x4>();
                for of_few in [curve.best_among(point, candidates), portable] {
                    prop_assert_eq!((of_few.distance, of_few.piece, of_few.parameter), (of_all.distance, of_all.piece, of_all.parameter));
                    prop_assert_eq!(curve.beyond_ends(point, of_few), curve.beyond_ends(point, of_all));
                }
                told += 1;
            }
            prop_assert!(told > 0 || curve.pieces.len() < 5);
        }
    }
}
