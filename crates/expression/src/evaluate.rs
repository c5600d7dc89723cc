//! The stack machine: one for numbers and for intervals, for values and for derivatives.
use crate::compile::{Action, Step};
use crate::{Expression, Function, Interval, Scalar, Taylor};

/// Most intermediate results of an expression.
pub(crate) const STACK: usize = 24;

impl Expression {
    /// f(x); not finite where f is not defined.
    pub fn value(&self, x: f64) -> f64 {
        self.series::<f64, 1>(x).0[0]
    }

    /// f(x) and its derivatives below the order N; at a kink, those of the right side.
    pub fn series<T: Scalar, const N: usize>(&self, x: T) -> Taylor<T, N> {
        run(&self.steps, Taylor::variable(x), true, |_, _| {})
    }

    /// As [`Self::series`]; at a kink, those of the left side.
    pub fn series_from_left<const N: usize>(&self, x: f64) -> Taylor<f64, N> {
        run(&self.steps, Taylor::variable(x), false, |_, _| {})
    }

    /// What value and derivatives below the order N are between two values of x, one-sided at these; unbounded where that
    /// cannot be said, so that bounded ones prove that they exist.
    pub fn enclosure<const N: usize>(&self, low: f64, high: f64) -> Taylor<Interval, N> {
        self.series(Interval::new(low, high))
    }
}

/// Runs steps at `x`, which must use no more than [`STACK`] results at a time. `look` sees the result of every step.
pub(crate) fn run<T: Scalar, const N: usize>(
    steps: &[Step],
    x: Taylor<T, N>,
    side: bool,
    mut look: impl FnMut(usize, &Taylor<T, N>),
) -> Taylor<T, N> {
    let mut stack = [x; STACK];
    let mut used = 0;
    for (index, step) in steps.iter().enumerate() {
        let takes = step.action.takes();
        let begin = used - takes;
        let result = act(step.action, &stack[begin..used], x, side);
        look(index, &result);
        stack[begin] = result;
        used = begin + 1;
    }
    stack[0]
}

impl Action {
    /// How many results it takes from the stack.
    fn takes(self) -> usize {
        match self {
            Self::Constant(_) | Self::Variable => 0,
            Self::Negate | Self::Power(_) | Self::RealPower(_) => 1,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::GeneralPower => 2,
            Self::Apply(function) => function.arguments(),
        }
    }
}

fn act<T: Scalar, const N: usize>(
    action: Action,
    operands: &[Taylor<T, N>],
    x: Taylor<T, N>,
    side: bool,
) -> Taylor<T, N> {
    match (action, operands) {
        (Action::Constant(value), _) => Taylor::constant(T::constant(value)),
        (Action::Negate, [a]) => a.negate(),
        (Action::Add, [a, b]) => a.add(*b),
        (Action::Subtract, [a, b]) => a.subtract(*b),
        (Action::Multiply, [a, b]) => a.multiply(*b),
        (Action::Divide, [a, b]) => a.divide(*b),
        (Action::Power(exponent), [a]) => a.power(exponent),
        (Action::RealPower(exponent), [a]) => a.real_power(exponent),
        (Action::GeneralPower, [a, b]) => a.apply(Function::Ln).multiply(*b).apply(Function::Exp),
        (Action::Apply(Function::Abs), [a]) => a.abs(side),
        (Action::Apply(Function::Sign), [a]) => a.signum(side),
        (Action::Apply(Function::Min), [a, b]) => a.min(*b, side),
        (Action::Apply(Function::Max), [a, b]) => a.max(*b, side),
        (Action::Apply(Function::Clamp), [a, low, high]) => a.min(*high, side).max(*low, side),
        (Action::Apply(function), [a]) => a.apply(function),
        // The variable; no other step has another number of operands.
        _ => x,
    }
}
