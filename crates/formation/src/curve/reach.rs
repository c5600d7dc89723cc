//! How near to a curve places have several nearest points: there transits begin (Definition 7.2.1, Proposition 7.2.3).
use super::{Curve, Foot};
use nalgebra::Vector2;

/// Points of the curve at which discs are grown, on either side.
const SEEDS: u32 = 512;
/// Discs are shrunk so many times at most: each time to the point that is nearest to their centre.
const SHRINKS: u32 = 60;
/// A disc that nothing lies deeper in than this share of its radius is empty.
const EMPTY: f64 = 1e-9;
/// Tangents that differ by more than this, rad, make a corner.
const CORNER: f64 = 1e-6;
/// Discs are sought beside the best so many times, each time at half the distance.
const REFINEMENTS: u32 = 40;

/// The place with several nearest points that is nearest to a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// How far it is from the curve, m: 0 at corners.
    pub distance: f64,
    /// m, in the curve's frame.
    pub place: Vector2<f64>,
    /// Two of its nearest points. Where they are one, the place is the centre of curvature there, beyond which they part.
    pub feet: [Foot; 2],
}

impl Curve {
    /// The nearest place with several nearest points that was found; nothing of a curve without one, as straight ones are. Every place is
    /// what it is told to be, for nearest points are certified; that no other is nearer is sought at 512 points of the curve, on both
    /// sides, and about the best of them.
    pub fn reach(&self) -> Option<Reach> {
        let corner = (0..self.pieces.len()).find_map(|joint| {
            let (before, after) = self.tangents_at_joint(joint)?;
            (libm::atan2(before.perp(&after), before.dot(&after)).abs() > CORNER).then(|| {
                let foot = self.at(self.pieces[joint].offset);
                Reach { distance: 0.0, place: foot.point, feet: [foot; 2] }
            })
        });
        if corner.is_some() {
            return corner;
        }
        let span = self.length / f64::from(SEEDS);
        let seeds = (0..=SEEDS).flat_map(|index| [-1.0, 1.0].map(|side| (span * f64::from(index), side)));
        let discs = seeds.filter_map(|(at, side)| Some((self.disc(at, side)?, at, side)));
        let mut best = discs.min_by(|a, b| a.0.distance.total_cmp(&b.0.distance));
        if let Some((reach, at, side)) = &mut best {
            let mut stride = span;
            for _ in 0..REFINEMENTS {
                let around = [*at - stride, *at + stride].map(|at| at.clamp(0.0, self.length));
                let found = around.into_iter().filter_map(|at| Some((self.disc(at, *side)?, at)));
                match found.min_by(|a, b| a.0.distance.total_cmp(&b.0.distance)) {
                    Some((nearer, there)) if nearer.distance < reach.distance => (*reach, *at) = (nearer, there),
                    _ => stride *= 0.5,
                }
            }
        }
        let best = best.map(|(reach, ..)| reach).into_iter().chain(self.between_ends());
        best.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// The largest disc that touches the curve at an arc length, on one side, and has nothing of it inside: its centre has that foot and
    /// another. Nothing where the disc would have no bound.
    fn disc(&self, at: f64, side: f64) -> Option<Reach> {
        let own = self.at(at);
        let normal = side * Vector2::new(-own.tangent.y, own.tangent.x);
        // A disc so large that what is in it on this side shows, but for discs that are as good as half planes.
        let largest = 100.0 * self.length;
        let (mut radius, mut other) = (largest, own);
        for _ in 0..SHRINKS {
            let place = own.point + radius * normal;
            let foot = self.nearest(place);
            if foot.distance >= radius * (1.0 - EMPTY) {
                break;
            }
            let chord = foot.point - own.point;
            let height = chord.dot(&normal);
            if height <= 0.0 {
                break;
            }
            (radius, other) = (0.5 * chord.norm_squared() / height, foot);
        }
        // Within rounding of the foot itself what is left is its curvature.
        let bend = side * own.curvature;
        if bend > 0.0 && 1.0 / bend < radius {
            (radius, other) = (1.0 / bend, own);
        }
        let feet = [own, other].map(|foot| Foot { distance: radius, ..foot });
        (radius < largest).then(|| Reach { distance: radius, place: own.point + radius * normal, feet })
    }

    /// The place between the ends, if nothing of the curve is nearer to it.
    fn between_ends(&self) -> Option<Reach> {
        if self.closed || self.open_start || self.open_end {
            return None;
        }
        let [first, last] = [0.0, self.length].map(|at| self.at(at));
        let (place, distance) = (0.5 * (first.point + last.point), 0.5 * (first.point - last.point).norm());
        let is_nearest = self.nearest(place).distance >= distance * (1.0 - EMPTY);
        let feet = [first, last].map(|foot| Foot { distance, ..foot });
        is_nearest.then_some(Reach { distance, place, feet })
    }
}
