//! Transits of nearest points (Definition 7.2.1): places at which the nearest point jumps.
use super::{Curve, Foot, NearestSet, Placed};
use nalgebra::Vector2;

/// A way is halved until its parts are this share of it.
const FINEST: f64 = 1e-12;

/// A place P on a robot's way, and the transit points there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transit {
    /// P, m.
    pub place: Vector2<f64>,
    /// The part of the way until there, 0 to 1.
    pub share: f64,
    /// N_1, the nearest point before.
    pub from: Foot,
    /// N_2, the nearest point behind.
    pub to: Foot,
}

impl Curve {
    /// The first transit on the straight way of a robot between two places: a place from which N_1 and N_2 are equally near, more than
    /// `apart` (m, positive: discs of half that about them are disjoint) from each other, and at which the nearest point changes from one
    /// to the other. Nothing where it moves continuously, though it may not be unique: on places with several nearest points at the ends of
    /// the way the robot may choose (Assumption 7.2.1), and chooses what makes no transit.
    ///
    /// The nearest points of parts of the way that are alike within `apart` at both ends are taken to have moved there without a jump.
    pub fn transit(&self, from: Vector2<f64>, to: Vector2<f64>, apart: f64) -> Option<Transit> {
        let ends = (self.nearest_all(from), self.nearest_all(to));
        let (first, last) = closest(&ends.0, &ends.1).unwrap_or((self.nearest(from), self.nearest(to)));
        self.jump(Way { from, to, apart }, (0.0, first), (1.0, last))
    }

    /// The first jump between two shares of a way, of whose nearest points these are ones.
    fn jump(&self, way: Way, (before, first): (f64, Foot), (after, last): (f64, Foot)) -> Option<Transit> {
        if (first.point - last.point).norm() <= way.apart {
            return None;
        }
        let share = 0.5 * (before + after);
        let place = way.from + share * (way.to - way.from);
        if after - before < FINEST {
            return Some(Transit { place, share, from: first, to: last });
        }
        let set = self.nearest_all(place);
        let like = |foot: Foot| nearest_of(&set, foot).unwrap_or_else(|| self.nearest(place));
        let (as_before, as_after) = (like(first), like(last));
        let earlier = self.jump(way, (before, first), (share, as_before));
        let here = (as_before.point - as_after.point).norm() > way.apart;
        earlier
            .or_else(|| here.then_some(Transit { place, share, from: as_before, to: as_after }))
            .or_else(|| self.jump(way, (share, as_after), (after, last)))
    }
}

impl Placed<'_> {
    /// As [`Curve::transit`], for a way relative to the curve's frame as it is now.
    pub fn transit(&self, from: Vector2<f64>, to: Vector2<f64>, apart: f64) -> Option<Transit> {
        let found = self.curve().transit(self.to_curve(from), self.to_curve(to), apart)?;
        let Transit { place, share, from, to } = found;
        Some(Transit { place: self.point_to_map(place), share, from: self.to_map(from), to: self.to_map(to) })
    }
}

#[derive(Clone, Copy)]
struct Way {
    from: Vector2<f64>,
    to: Vector2<f64>,
    apart: f64,
}

/// The pair of nearest points, one of each place, that are nearest to each other.
fn closest(first: &NearestSet, last: &NearestSet) -> Option<(Foot, Foot)> {
    let pairs = first.feet.iter().filter_map(|foot| Some((*foot, nearest_of(last, *foot)?)));
    pairs.min_by(|a, b| (a.0.point - a.1.point).norm().total_cmp(&(b.0.point - b.1.point).norm()))
}

fn nearest_of(set: &NearestSet, like: Foot) -> Option<Foot> {
    let far = |foot: &Foot| (foot.point - like.point).norm_squared();
    set.feet.iter().copied().min_by(|a, b| far(a).total_cmp(&far(b)))
}
