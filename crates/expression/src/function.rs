//! Functions by name, and their derivatives.
use crate::Scalar;

/// A smooth function of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "their names are those of mathematics")]
pub enum Function {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    /// |a|: a kink at 0.
    Abs,
    /// -1 below 0, 1 above: a jump at 0.
    Sign,
    /// The least of two.
    Min,
    /// The greatest of two.
    Max,
    /// clamp(a, low, high).
    Clamp,
}

impl Function {
    /// Every name; two mean the natural logarithm.
    pub const NAMES: &[(&str, Self)] = &[
        ("sqrt", Self::Sqrt),
        ("exp", Self::Exp),
        ("ln", Self::Ln),
        ("log", Self::Ln),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tan", Self::Tan),
        ("asin", Self::Asin),
        ("acos", Self::Acos),
        ("atan", Self::Atan),
        ("sinh", Self::Sinh),
        ("cosh", Self::Cosh),
        ("tanh", Self::Tanh),
        ("abs", Self::Abs),
        ("sign", Self::Sign),
        ("min", Self::Min),
        ("max", Self::Max),
        ("clamp", Self::Clamp),
    ];

    /// The function called `name`.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|(_, function)| *function)
    }

    /// How many arguments it takes.
    pub fn arguments(self) -> usize {
        match self {
            Self::Min | Self::Max => 2,
            Self::Clamp => 3,
            _ => 1,
        }
    }

    /// f(a), f'(a), f''(a)/2, f'''(a)/6 of a smooth function; of the others, which have several cases, that of f(a) = a.
    pub(crate) fn series<T: Scalar>(self, a: T) -> [T; 4] {
        let number = T::constant;
        match self {
            Self::Sqrt => {
                let root = a.sqrt();
                let first = number(0.5) / root;
                [root, first, -(first / (number(4.0) * a)), first / (number(8.0) * a.square())]
            }
            Self::Exp => {
                let value = a.exponential();
                [value, value, number(0.5) * value, value / number(6.0)]
            }
            Self::Ln => {
                let inverse = number(1.0) / a;
                [a.logarithm(), inverse, -(number(0.5) * inverse.square()), inverse * inverse.square() / number(3.0)]
            }
            Self::Sin => {
                let (sine, cosine) = a.sine_cosine();
                [sine, cosine, -(number(0.5) * sine), -(cosine / number(6.0))]
            }
            Self::Cos => {
                let (sine, cosine) = a.sine_cosine();
                [cosine, -sine, -(number(0.5) * cosine), sine / number(6.0)]
            }
            Self::Tan => {
                let value = a.tangent();
                let (square, first) = (value.square(), number(1.0) + value.square());
                [value, first, value * first, first * (number(1.0) + number(3.0) * square) / number(3.0)]
            }
            Self::Tanh => {
                let value = a.hyperbolic_tangent();
                let (square, first) = (value.square(), number(1.0) - value.square());
                [value, first, -(value * first), first * (number(3.0) * square - number(1.0)) / number(3.0)]
            }
            Self::Asin => inverse_sine(a),
            Self::Acos => {
                let [_, first, second, third] = inverse_sine(a);
                [a.arc_cosine(), -first, -second, -third]
            }
            Self::Atan => {
                let whole = number(1.0) + a.square();
                let third = (number(3.0) * a.square() - number(1.0)) / (number(3.0) * whole * whole.square());
                [a.arc_tangent(), number(1.0) / whole, -(a / whole.square()), third]
            }
            Self::Sinh => {
                let (sine, cosine) = (a.hyperbolic_sine(), a.hyperbolic_cosine());
                [sine, cosine, number(0.5) * sine, cosine / number(6.0)]
            }
            Self::Cosh => {
                let (sine, cosine) = (a.hyperbolic_sine(), a.hyperbolic_cosine());
                [cosine, sine, number(0.5) * cosine, sine / number(6.0)]
            }
            Self::Abs | Self::Sign | Self::Min | Self::Max | Self::Clamp => [a, number(1.0), number(0.0), number(0.0)],
        }
    }
}

fn inverse_sine<T: Scalar>(a: T) -> [T; 4] {
    let rest = T::constant(1.0) - a.square();
    let root = rest.sqrt();
    let second = a / (T::constant(2.0) * rest * root);
    let third = (T::constant(1.0) + T::constant(2.0) * a.square()) / (T::constant(6.0) * rest.square() * root);
    [a.arc_sine(), T::constant(1.0) / root, second, third]
}
