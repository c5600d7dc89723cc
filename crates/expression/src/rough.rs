//! Where an expression is not smooth, certified: what is not named is smooth.
use crate::compile::{Action, Step};
use crate::evaluate::run;
use crate::{Expression, Function, Interval, Taylor};

/// A place where the function is not twice differentiable, or where that cannot be proved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rough {
    /// The place lies between these values of x.
    pub low: f64,
    /// And this.
    pub high: f64,
    /// What is lost there.
    pub roughness: Roughness,
    /// Where in the text the cause stands: its column from 1.
    pub column: usize,
    /// The cause: "the division", "`sqrt`" ...
    pub cause: &'static str,
}

/// How bad a rough place is, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Roughness {
    /// The value is not finite, or not defined.
    Value,
    /// The value jumps, or its slope is infinite.
    Slope,
    /// The slope jumps: a kink; or the second derivative is infinite.
    Curvature,
}

/// A cell is not divided below this share of the range.
const FINEST: f64 = 1.0 / (1_u64 << 46) as f64;
/// By this share of its width a cell reaches into its neighbours, so that no kink hides between two.
const OVERLAP: f64 = 1e-3;
/// After so many cells the rest counts as rough.
const MOST_CELLS: usize = 200_000;
/// As far from a place where a value is lost, of x or at all, it is shown as that place.
const NEXT: f64 = 1e-6;

impl Rough {
    /// x in the middle of the place, with the digits that are known; where a whole stretch begins, its end nearer to 0.
    pub fn x(&self) -> f64 {
        let width = self.high - self.low;
        let nearer = if self.low.abs() <= self.high.abs() { self.low } else { self.high };
        let stretch = width > 1e-9 * nearer.abs().max(1.0);
        let middle = if stretch { nearer } else { 0.5 * (self.low + self.high) };
        if middle.abs() <= width && !stretch {
            return 0.0;
        }
        if middle == 0.0 {
            return 0.0;
        }
        let scale = 1e10 / libm::exp2(libm::ceil(libm::log2(middle.abs())));
        libm::round(middle * scale) / scale
    }
}

impl Expression {
    /// All places between `from` and `to` where the function is not twice differentiable, at most about `most` of them, in
    /// order. Everywhere else between the two ends (one-sided at these) it is: proved by intervals. A place may be named
    /// without need where intervals cannot tell, as at 0 for sin(x)/x.
    pub fn rough_points(&self, from: f64, to: f64, most: usize) -> Vec<Rough> {
        let finest = FINEST * (to - from);
        let mut found: Vec<Rough> = Vec::new();
        let mut stack = vec![(from, to)];
        let mut cells = 0;
        while let Some((low, high)) = stack.pop() {
            cells += 1;
            let reach = OVERLAP * (high - low);
            let cell = ((low - reach).max(from), (high + reach).min(to));
            let Some(rough) = self.roughness(cell) else { continue };
            let middle = 0.5 * (low + high);
            if high - low > finest && cells < MOST_CELLS && low < middle && middle < high {
                stack.extend([(middle, high), (low, middle)]);
                continue;
            }
            let is_full = found.len() >= most;
            match found.last_mut() {
                Some(last) if last.high >= rough.low => {
                    let worse = if rough.roughness < last.roughness { rough } else { *last };
                    *last = Rough { low: last.low, high: rough.high, ..worse };
                }
                _ if is_full => break,
                _ => found.push(rough),
            }
        }
        found
    }

    /// A value of x to show for a rough place (see [`Rough::x`]): where the value is lost, one at which it is, or that is next to such.
    pub fn shown(&self, rough: &Rough) -> f64 {
        let lost = |x: f64| {
            let beside = NEXT * x.abs().max(1.0);
            [x, x - beside, x + beside].into_iter().any(|x| !self.value(x).is_finite())
        };
        let (x, ends) = (rough.x(), [rough.low, rough.high]);
        if rough.roughness == Roughness::Value && !lost(x) {
            ends.into_iter().find(|x| lost(*x)).unwrap_or(x)
        } else {
            x
        }
    }

    /// What cannot be bounded on a cell.
    fn roughness(&self, (low, high): (f64, f64)) -> Option<Rough> {
        let whole: Taylor<Interval, 3> = self.enclosure(low, high);
        let order = whole.0.iter().position(|coefficient| !coefficient.is_bounded())?;
        let mut cause = None;
        run::<Interval, 3>(&self.steps, Taylor::variable(Interval::new(low, high)), true, |index, result| {
            if cause.is_none() && !result.0[order].is_bounded() {
                cause = Some(self.steps[index]);
            }
        });
        let roughness = [Roughness::Value, Roughness::Slope, Roughness::Curvature][order];
        let (cause, column) = cause.map_or(("the function", 1), |step: Step| (step.action.name(), step.column));
        Some(Rough { low, high, roughness, column, cause })
    }
}

impl Action {
    fn name(self) -> &'static str {
        match self {
            Self::Constant(_) => "the constant",
            Self::Variable => "x",
            Self::Negate => "the sign",
            Self::Add => "the sum",
            Self::Subtract => "the difference",
            Self::Multiply => "the product",
            Self::Divide => "the division",
            Self::Power(_) | Self::RealPower(_) | Self::GeneralPower => "the power",
            Self::Apply(function) => function.name(),
        }
    }
}

impl Function {
    fn name(self) -> &'static str {
        let named = Self::NAMES.iter().find(|(_, function)| *function == self);
        named.map_or("the function", |(name, _)| name)
    }
}
