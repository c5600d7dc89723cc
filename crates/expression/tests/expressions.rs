//! What may be written, what it means, and what is refused.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use proptest::prelude::*;
use trench_expression::{Expression, Interval, Roughness};

fn parsed(text: &str) -> Expression {
    Expression::parse(text).unwrap()
}

#[test]
fn values() {
    let check = |text: &str, x: f64, expected: f64| {
        let value = parsed(text).value(x);
        assert!((value - expected).abs() <= 1e-14 * expected.abs().max(1.0), "{text} at {x}: {value}");
    };
    check("1 + 2*x - 3/x", 2.0, 3.5);
    check("-x^2", 3.0, -9.0);
    check("2^3^2", 0.0, 512.0);
    check("2**-x", 2.0, 0.25);
    check("x - 1 - 1", 5.0, 3.0);
    check("x / 2 / 2", 8.0, 2.0);
    check("--x", 4.0, 4.0);
    check("(x + 1) * (x - 1)", 3.0, 8.0);
    check("1.5e-3 + .5 + 2.", 0.0, 2.5015);
    check("sin(pi/2) + cos(tau) + ln(e)", 0.0, 3.0);
    check("sqrt(x) + abs(-x) + sign(-x) + min(x, 1) + max(x, 1)", 4.0, 2.0 + 4.0 - 1.0 + 1.0 + 4.0);
    check("clamp(x, -1, 2)", 5.0, 2.0);
    check("clamp(x, -1, 2)", -5.0, -1.0);
    check("tan(atan(x)) + asin(sin(x)) + acos(cos(x))", 0.5, 1.5);
    check("cosh(x)^2 - sinh(x)^2 + tanh(0)", 1.3, 1.0);
    check("x^2.5 + x^x", 4.0, 288.0);
    check(" \t x \n ", 7.0, 7.0);
}

#[test]
fn scaled_graphs() {
    let larger = parsed("exp(x) - max(x^2, 1e2)").scaled(2.5).unwrap();
    assert_eq!(larger.source(), "2.5*(exp((x/2.5)) - max((x/2.5)^2, 1e2))");
    assert!((larger.value(1.0) - 2.5 * (0.4_f64.exp() - 100.0)).abs() < 1e-12);
    assert!(parsed("x").scaled(f64::NAN).is_err());
}

#[test]
fn refusals_name_the_column() {
    let check = |text: &str, expected: &str| {
        let error = Expression::parse(text).unwrap_err().to_string();
        assert!(error.contains(expected), "{text}: {error}");
    };
    check("", "at column 1: found the end, expected `(`, a name or a number");
    check("2 * ", "at column 5: found the end");
    check("sin(x", "at column 6: found the end, expected `(`, `)`, `,` or an operator");
    check("2 x", "at column 3: found `x`, expected an operator or the end");
    check("x $ 1", "at column 3: found `$`");
    check("1 + sine(x)", "`sine` at column 5 is unknown");
    check("y^2", "`y` at column 1 is unknown");
    check("sin + 1", "`sin` at column 1 takes 1 argument in parentheses, but has 0");
    check("min(x)", "`min` at column 1 takes 2 arguments in parentheses, but has 1");
    check("x + 1/0", "the constant at column 5 is inf, not a finite number");
    check("sqrt(-1)", "the constant at column 1 is NaN");
    check("1e999", "the constant at column 1 is inf");
    check("2 \u{b7} \u{e4}", "at column 3: found `\u{b7}`");
    check(&"(".repeat(100), "too long or too deeply nested");
    check(&"1+".repeat(600), "too long or too deeply nested");
    check(&format!("{}x{}", "(1+x*(".repeat(15), "))".repeat(15)), "too deeply nested");
}

/// As long as may be, and as deep: neither may exhaust the stack of a thread.
#[test]
fn long_chains_are_read() {
    assert!((parsed(&format!("{}x", "-".repeat(999))).value(2.0) + 2.0).abs() < 1e-15);
    assert!(Expression::parse(&format!("x{}", "^x".repeat(499))).is_err());
    assert!((parsed(&format!("x{}", "^1".repeat(20))).value(3.0) - 3.0).abs() < 1e-15);
    assert!((parsed(&format!("{}x{}", "(".repeat(40), ")".repeat(40))).value(3.0) - 3.0).abs() < 1e-15);
}

const SMOOTH: [&str; 18] = [
    "x^3 - 2*x + 1",
    "sin(2*x) * cos(x/3)",
    "exp(-x^2)",
    "ln(x^2 + 1)",
    "sqrt(x^2 + 0.25)",
    "tan(x/4)",
    "atan(3*x) / (1 + x^2)",
    "asin(x/4) + acos(x/5)",
    "sinh(x) - cosh(x/2) + tanh(2*x)",
    "(x^2 + 1)^1.7",
    "(x^2 + 2)^sin(x)",
    "1 / (x - 4)",
    "(x - 4)^-3",
    "(x + 4)^x",
    "abs(x - 5) * x",
    "min(x, 7) * max(x^2, -1)",
    "clamp(x, -9, 9)^5 * sign(x + 20)",
    "3.5",
];

/// Derivatives against differences of the derivative below.
fn differs(expression: &Expression, x: f64) -> Option<String> {
    let step = 1e-5;
    let series = |x: f64| expression.series::<f64, 4>(x);
    let (here, before, behind) = (series(x), series(x - step), series(x + step));
    (1..4).find_map(|order| {
        let difference = (behind.derivative(order - 1) - before.derivative(order - 1)) / (2.0 * step);
        let exact = here.derivative(order);
        let scale = 1.0 + exact.abs() + here.derivative(3).abs();
        ((difference - exact).abs() > 2e-5 * scale).then(|| format!("order {order} at {x}: {exact} {difference}"))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn derivatives_are_those_of_differences(index in 0..SMOOTH.len(), x in -3.0..3.0_f64) {
        let expression = parsed(SMOOTH[index]);
        prop_assert_eq!(differs(&expression, x), None, "{}", SMOOTH[index]);
    }

    /// Enclosures hold for all x between, and shrink with the interval.
    #[test]
    fn enclosures_enclose(index in 0..SMOOTH.len(), x in -3.0..3.0_f64, width in 0.0..1.0_f64, at in 0.0..=1.0_f64) {
        let expression = parsed(SMOOTH[index]);
        let (low, high) = (x, (x + width).min(3.0));
        let enclosure = expression.enclosure::<4>(low, high);
        let inner = (low + at * (high - low)).min(high);
        let values = expression.series::<f64, 4>(inner);
        for order in 0..4 {
            prop_assert!(enclosure.0[order].contains(values.0[order]), "{} {order} {enclosure:?} {values:?}", SMOOTH[index]);
        }
        let point = expression.enclosure::<4>(inner, inner);
        for order in 0..4 {
            let Interval { low, high } = point.0[order];
            prop_assert!(high - low <= 1e-10 * (1.0 + values.0[order].abs()), "{} {order} {point:?}", SMOOTH[index]);
        }
        prop_assert_eq!(expression.rough_points(-3.0, 3.0, 5), vec![]);
    }

    /// Nothing that a person writes makes the reader panic.
    #[test]
    fn any_text_is_read_or_refused(text in "[x0-9.+*/^() ,a-z-]{0,40}") {
        if let Ok(expression) = Expression::parse(&text) {
            let _ = expression.value(0.5);
            let _ = expression.rough_points(-1.0, 1.0, 3);
        }
    }
}

#[test]
fn rough_places_are_found_and_named() {
    let check = |text: &str, expected: &[(f64, Roughness, &str)]| {
        let found: Vec<_> =
            parsed(text).rough_points(-2.0, 3.0, 10).iter().map(|r| (r.x(), r.roughness, r.cause)).collect();
        assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found.0 - expected.0).abs() < 1e-9 && found.1 == expected.1 && found.2 == expected.2,
                "{text}: {found:?}"
            );
        }
    };
    use Roughness::{Curvature, Slope, Value};
    check("abs(x)", &[(0.0, Curvature, "abs")]);
    check("abs(x - 0.5)", &[(0.5, Curvature, "abs")]);
    check("abs(x^2 - 1)", &[(-1.0, Curvature, "abs"), (1.0, Curvature, "abs")]);
    check("1/x", &[(0.0, Value, "the division")]);
    check("1/(x - 0.3)", &[(0.3, Value, "the division")]);
    check("sign(x - 1)", &[(1.0, Slope, "sign")]);
    check("max(x, 1)", &[(1.0, Curvature, "max")]);
    check("clamp(x, -1, 2)", &[(-1.0, Curvature, "clamp"), (2.0, Curvature, "clamp")]);
    check("tan(x)", &[(-core::f64::consts::FRAC_PI_2, Value, "tan"), (core::f64::consts::FRAC_PI_2, Value, "tan")]);
    check("abs(x)^0.5", &[(0.0, Slope, "the power")]);
    // One-sided at the ends of the range.
    assert_eq!(parsed("abs(x)").rough_points(0.0, 1.0, 5), vec![]);
    assert_eq!(parsed("x^1.5").rough_points(0.0, 1.0, 5)[0].roughness, Curvature);
    // A whole stretch without a value is one place.
    let root = parsed("sqrt(x)").rough_points(-2.0, 3.0, 5);
    assert_eq!((root.len(), root[0].roughness, root[0].cause, root[0].low), (1, Value, "sqrt", -2.0), "{root:?}");
}

#[test]
fn sides_of_a_kink() {
    let slopes = |text: &str, x: f64| {
        let expression = parsed(text);
        (expression.series_from_left::<2>(x).0[1], expression.series::<f64, 2>(x).0[1])
    };
    assert_eq!(slopes("2*abs(x)", 0.0), (-2.0, 2.0));
    assert_eq!(slopes("abs(-3*x)", 0.0), (-3.0, 3.0));
    assert_eq!(slopes("max(x, 2*x)", 0.0), (1.0, 2.0));
    assert_eq!(slopes("min(x^2, 0)", 0.0), (0.0, 0.0));
    assert_eq!(slopes("clamp(x, -1, 1)", 1.0), (1.0, 0.0));
}
