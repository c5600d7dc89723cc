//! The sine integral and the entire cosine integral, in which the closed forms of 4.2 are written.
use core::f64::consts::FRAC_PI_2;
use nalgebra::Complex;

const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;
/// Below, the power series lose no more than a digit to cancellation; above, the continued fraction converges fast.
const SERIES_END: f64 = 4.0;

/// Si(x), the integral of sin(u)/u from 0 to x; odd.
pub fn sine_integral(x: f64) -> f64 {
    let size = x.abs();
    if size <= SERIES_END {
        // x - x^3/(3 3!) + x^5/(5 5!) - ...
        return series(x, 1.0, x);
    }
    (FRAC_PI_2 + exponential_integral(size).im).copysign(x)
}

/// Cin(x), the integral of (1 - cos u)/u from 0 to x; even.
pub fn entire_cosine_integral(x: f64) -> f64 {
    let size = x.abs();
    if size <= SERIES_END {
        // x^2/(2 2!) - x^4/(4 4!) + ...
        return series(0.5 * x * x, 2.0, x);
    }
    EULER_GAMMA + libm::log(size) + exponential_integral(size).re
}

/// The sum of t/n, with t from `term` (x^n/n!) on, each next being -x^2/((n+1)(n+2)) times the one before.
fn series(mut term: f64, mut order: f64, x: f64) -> f64 {
    let mut sum = 0.0;
    loop {
        let next = sum + term / order;
        if next == sum {
            return sum;
        }
        sum = next;
        term *= -x * x / ((order + 1.0) * (order + 2.0));
        order += 2.0;
    }
}

/// E1(i x) for x > 2 by Lentz's method on its continued fraction (Numerical Recipes, 6.8): Ci = -Re, Si = pi/2 + Im.
fn exponential_integral(x: f64) -> Complex<f64> {
    if x.is_infinite() {
        return Complex::new(0.0, 0.0);
    }
    let one = Complex::new(1.0, 0.0);
    let mut b = Complex::new(1.0, x);
    let mut c = Complex::new(1e300, 0.0);
    let mut d = one / b;
    let mut fraction = d;
    for index in 1..200_u32 {
        let a = -f64::from(index) * f64::from(index);
        b += 2.0;
        d = one / (d * a + b);
        c = b + Complex::new(a, 0.0) / c;
        let factor = c * d;
        fraction *= factor;
        if (factor.re - 1.0).abs() + factor.im.abs() < f64::EPSILON {
            break;
        }
    }
    let (sin, cos) = libm::sincos(x);
    Complex::new(cos, -sin) * fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Composite Gauss-Legendre of five points: exact to rounding for these entire integrands.
    fn quadrature(integrand: impl Fn(f64) -> f64, end: f64) -> f64 {
        const NODES: [(f64, f64); 5] = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ];
        let (pieces, mut sum) = (400, 0.0);
        let half = end / f64::from(2 * pieces);
        for piece in 0..pieces {
            let middle = half * f64::from(2 * piece + 1);
            sum += NODES.iter().map(|(node, weight)| weight * integrand(middle + half * node)).sum::<f64>() * half;
        }
        sum
    }

    #[test]
    fn agree_with_quadrature_on_both_sides_of_the_seam() {
        for x in [1e-3, 0.1, 1.0, 2.0, 3.9, 4.0, 4.000_001, 5.0, 6.5, 10.0, 30.0] {
            let si = quadrature(|u| libm::sin(u) / u, x);
            let cin = quadrature(|u| (1.0 - libm::cos(u)) / u, x);
            assert!((sine_integral(x) - si).abs() < 1e-14, "Si({x}) off by {:e}", sine_integral(x) - si);
            assert!((entire_cosine_integral(x) - cin).abs() < 1e-14, "Cin({x})");
            assert_eq!(sine_integral(-x), -sine_integral(x));
            assert_eq!(entire_cosine_integral(-x), entire_cosine_integral(x));
        }
        assert!((sine_integral(f64::INFINITY) - FRAC_PI_2).abs() < 1e-15);
    }
}
