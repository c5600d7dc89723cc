//! What is known beforehand of a piece that is not straight, so that questions evaluate its primitive only where they must.
use super::arc_table::ArcTable;
use super::path::Path;
use super::primitive::{Jet, Primitive};
use crate::lanes::{Number, Plane, call_for};
use nalgebra::Vector2;

/// A step of third order shorter than this by t leaves less than rounding does.
pub(super) const SHORTEST: f64 = 2e-5;
/// After one shorter than this Taylor's series is as exact as the primitive, and a step of second order more leaves nothing.
pub(super) const SHORT: f64 = 2e-4;

/// Part of the squared speed that slopes at the ends must have for the minimum to be clear of them.
const MARGIN: f64 = 1e-4;

/// A curved piece at its ends and in its middle, where it lies, and its arc length: all by t, which goes from -1 to 1 over the piece.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bend {
    /// At the start and at the end.
    pub(super) ends: [Jet; 2],
    pub(super) middle: Middle,
    /// The parameter for t = 0, and from there to t = 1.
    pub(super) centre: f64,
    pub(super) half: f64,
    per_half: f64,
    pub(super) path: Option<Path>,
    arc: ArcTable,
    /// See [`Self::rest`]: the radius, m, and the least slope, m^2.
    pub(super) calm: f64,
    pub(super) margin: f64,
}

impl Bend {
    /// Nothing for straight pieces and circles, whose answers are in closed form.
    pub(super) fn of(primitive: &Primitive, from: f64, to: f64, length: f64) -> Option<Box<Self>> {
        if matches!(primitive, Primitive::Line { .. }) || primitive.circle().is_some() {
            return None;
        }
        let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
        let jet_at = |parameter: f64| primitive.evaluate(parameter).stretched(half);
        let path = Path::of(primitive, from, to);
        let speed = |t: f64| {
            let jet = path.as_ref().map_or_else(|| jet_at(centre + half * t), |path| path.at(t).0);
            jet.first.norm()
        };
        let arc = ArcTable::of(speed, length);
        let middle = Middle::of(primitive, from, to).stretched();
        let ends = [jet_at(from), jet_at(to)];
        let margin = MARGIN * middle.jet.first.norm_squared();
        Some(Box::new(Self { ends, middle, centre, half, per_half: 1.0 / half, path, arc, calm: 0.0, margin }))
    }

    /// Lets it come nearer to the processor.
    #[inline]
    pub(super) fn call(&self) {
        self.ends.iter().for_each(call_for);
        call_for(&self.middle);
        call_for(&self.centre);
        if let Some(path) = &self.path {
            path.coefficients().iter().step_by(4).for_each(call_for);
        }
        self.arc.call();
    }

    /// Learns how far from the middle of the piece points may be, m, for the pieces before and after it to be no nearer to them than
    /// the joint is; see [`Piece::shields`](super::piece::Piece::shields).
    pub(super) fn learn(&mut self, shielded: f64) {
        self.calm = (1.0 - 1e-9) * self.middle.reach().min(shielded).max(0.0);
    }

    /// [`Self::root`] for points near the middle that lie well beside the piece: there it grows all over the piece, and no
    /// piece beside is as near.
    #[inline]
    pub(super) fn rest(&self, point: Vector2<f64>) -> Option<(f64, Jet)> {
        if (self.middle.jet.point - point).norm_squared() > self.calm * self.calm {
            return None;
        }
        let slopes = self.slopes(point);
        if !(slopes[0] < -self.margin && slopes[1] > self.margin) {
            return None;
        }
        self.root(point, slopes).ok()
    }

    /// Slopes of half the squared distance at both ends.
    #[inline]
    pub(super) fn slopes(&self, point: Vector2<f64>) -> [f64; 2] {
        self.ends.each_ref().map(|end| end.slope(point))
    }

    /// Arc length from the start of the piece to a parameter of it, m; nothing where that is not known beforehand.
    #[inline]
    pub(super) fn length_to(&self, parameter: f64) -> Option<f64> {
        self.arc.length_to((parameter - self.centre) * self.per_half)
    }

    /// Where the slope of the squared distance is zero, if it grows all over the piece and has these signs at its ends: the parameter, and the
    /// primitive there, by t. From the guess by Halley's method; what the primitive is at the end of a short step follows by
    /// Taylor's series, so that most often it is evaluated but once. If that comes to nothing, the bracket of the parameter and a guess.
    #[inline]
    pub(super) fn root(&self, point: Vector2<f64>, slopes: [f64; 2]) -> Result<(f64, Jet), ((f64, f64), f64)> {
        let (low, guess) = guess([&self.ends[0], &self.middle.jet, &self.ends[1]], slopes, point);
        let high = low + 1.0;
        let parameter = |t: f64| self.centre + self.half * t;
        let Some(path) = &self.path else { return Err(((parameter(low), parameter(high)), parameter(guess))) };
        let mut from = guess;
        for _ in 0..3 {
            let (jet, third) = path.at(from);
            let step = jet.step_of_third_order(third, point);
            let t = from + step;
            if !(low <= t && t <= high) {
                break;
            }
            if step.abs() < SHORT {
                let moved = jet.moved(step, third);
                if step.abs() < SHORTEST {
                    return Ok((parameter(t), moved));
                }
                let more = moved.step_of_second_order(point);
                return Ok((parameter(t + more), moved.moved(more, third)));
            }
            from = t;
        }
        Err(((parameter(low), parameter(high)), parameter(guess)))
    }
}

/// Where the slope is about zero, from `slopes` at both ends: its inverse as the cubic that fits value and slope at both ends of the
/// half that holds the zero. Where that half begins, and the zero.
#[inline(always)]
pub(super) fn guess<V: Plane>(
    [start, middle, end]: [&Jet<V>; 3],
    slopes: [V::Number; 2],
    point: V,
) -> (V::Number, V::Number) {
    let number = V::Number::splat;
    let at_middle = middle.slope(point);
    let forward = at_middle.is_below(number(0.0));
    let from = number(0.0).or(forward, number(-1.0));
    let (below, above) = (at_middle.or(forward, slopes[0]), slopes[1].or(forward, at_middle));
    let grows = middle.growth(point);
    let (low, high) = (grows.or(forward, start.growth(point)), end.growth(point).or(forward, grows));
    let rise = above - below;
    let share = -below / rise;
    let rest = number(1.0) - share;
    let bend = rise * share * rest * (rest / low - share / high);
    (from, from + share * share * (number(3.0) - number(2.0) * share) + bend)
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

    /// The same by a parameter that goes from -1 to 1.
    fn stretched(self) -> Self {
        let half = self.half;
        Self {
            jet: self.jet.stretched(half),
            half: 1.0,
            second: half * half * self.second,
            third: half * half * half * self.third,
            most_speed: half * self.most_speed,
        }
    }

    /// How far from the middle points may be, m, for [`Self::slope_sign`] to be positive.
    fn reach(&self) -> f64 {
        let fixed = self.half * self.most_speed * (3.0 * self.second + self.half * self.third);
        (self.jet.first.norm_squared() - fixed) / (self.jet.second.norm() + self.half * self.third)
    }

    /// Whether g', see [`minimum`](super::minimum), is positive (true) or negative (false) all over the part; `None` if the
    /// bounds do not tell.
    #[inline]
    pub(super) fn slope_sign(&self, point: Vector2<f64>) -> Option<bool> {
        let away = self.jet.point - point;
        let most_distance = away.norm() + self.half * self.most_speed;
        let slope = self.jet.growth(point);
        let change = self.half * (3.0 * self.most_speed * self.second + most_distance * self.third);
        (slope.abs() > change).then_some(slope > 0.0)
    }
}
