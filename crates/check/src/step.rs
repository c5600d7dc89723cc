//! The longest steps by which the methods follow what decays (A.10, 8.2): beyond, what should vanish grows from step to step.

use trench_formation::simulate::Integration;

/// Looks along each ray of the complex plane, |lambda| h from 0 to the first that is not stable.
const LOOKS: u32 = 600;
/// No h lambda of the left half plane is stable beyond this under RK4.
const FARTHEST: f64 = 3.0;

/// What a robot's law is beside its rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stiff {
    /// x' = -rate x, 1/s.
    First(f64),
    /// x'' = -stiffness x - damping x', 1/s^2 and 1/s.
    Second(f64, f64),
}

impl Stiff {
    /// The largest |lambda|, 1/s.
    pub(crate) fn largest(self) -> f64 {
        self.poles().map(|(real, imaginary)| libm::hypot(real, imaginary)).into_iter().fold(0.0, f64::max)
    }

    /// Real and imaginary parts, the latter not below 0.
    fn poles(self) -> [(f64, f64); 2] {
        match self {
            Self::First(rate) => [(-rate, 0.0); 2],
            Self::Second(stiffness, damping) => {
                let half = 0.5 * damping;
                let inner = half * half - stiffness;
                let root = libm::sqrt(inner.abs());
                if inner >= 0.0 { [(-half - root, 0.0), (root - half, 0.0)] } else { [(-half, root); 2] }
            }
        }
    }

    /// The longest step (s) that a method may take; infinite where nothing moves.
    pub(crate) fn longest_step(self, method: Integration) -> f64 {
        match (method, self) {
            (Integration::RungeKutta, _) => self.poles().map(of_runge_kutta).into_iter().fold(f64::INFINITY, f64::min),
            (_, Self::First(rate)) => 2.0 / rate,
            // Both multipliers within the unit circle (Jury): h k + h^2 K/2 < 2; alone k h < 2 and sqrt(K) h < 2.
            (Integration::SemiImplicitEuler, Self::Second(stiffness, damping)) => {
                4.0 / (damping + libm::sqrt(damping * damping + 4.0 * stiffness))
            }
            // An acceleration that is held has a motion that is exact, but the law answers once a step: h < 2/k, and h < 2 k/K.
            (Integration::Exact, Self::Second(stiffness, damping)) => {
                (2.0 / damping).min(2.0 * damping / stiffness.max(f64::MIN_POSITIVE))
            }
        }
    }
}

/// Of one pole: |1 + z + z^2/2 + z^3/6 + z^4/24| <= 1, z = h lambda.
fn of_runge_kutta((real, imaginary): (f64, f64)) -> f64 {
    let size = libm::hypot(real, imaginary);
    if size == 0.0 {
        return f64::INFINITY;
    }
    let (x, y) = (real / size, imaginary / size);
    let grows = |length: f64| {
        // Horner's scheme in complex numbers.
        let times = |(a, b): (f64, f64)| (length * (a * x - b * y), length * (a * y + b * x));
        let power = [4.0, 3.0, 2.0, 1.0].into_iter().fold((1.0, 0.0), |sum, divisor| {
            let (a, b) = times(sum);
            (1.0 + a / divisor, b / divisor)
        });
        libm::hypot(power.0, power.1) > 1.0 + 1e-9
    };
    let lengths = (1..=LOOKS).map(|look| FARTHEST * f64::from(look) / f64::from(LOOKS));
    let first = lengths.into_iter().find(|length| grows(*length)).unwrap_or(FARTHEST);
    (first - FARTHEST / f64::from(LOOKS)) / size
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether x = 1, x' = 0 has grown after 4000 steps.
    fn grows(method: Integration, (stiffness, damping): (f64, f64), step: f64) -> bool {
        let law = |x: f64, v: f64| -stiffness * x - damping * v;
        let (mut x, mut v) = (1.0, 0.0);
        for _ in 0..4000 {
            (x, v) = match method {
                Integration::SemiImplicitEuler => {
                    let next = v + step * law(x, v);
                    (x + step * next, next)
                }
                Integration::Exact => {
                    let force = law(x, v);
                    (x + step * v + 0.5 * step * step * force, v + step * force)
                }
                Integration::RungeKutta => {
                    let (a, p) = (law(x, v), v);
                    let (b, q) = (law(x + 0.5 * step * p, v + 0.5 * step * a), v + 0.5 * step * a);
                    let (c, r) = (law(x + 0.5 * step * q, v + 0.5 * step * b), v + 0.5 * step * b);
                    let (d, s) = (law(x + step * r, v + step * c), v + step * c);
                    (x + step / 6.0 * (p + 2.0 * q + 2.0 * r + s), v + step / 6.0 * (a + 2.0 * b + 2.0 * c + d))
                }
            };
        }
        // Overflow is growth, too.
        let size = libm::hypot(x, v);
        size.is_nan() || size > 1.0
    }

    #[test]
    fn longest_steps_are_where_robots_diverge() {
        for method in [Integration::RungeKutta, Integration::SemiImplicitEuler, Integration::Exact] {
            for law in [(10.0, 2.0), (10.0, 5.0), (2.0, 3.0), (96.0, 20.0), (1.0, 0.5)] {
                let longest = Stiff::Second(law.0, law.1).longest_step(method);
                assert!(!grows(method, law, 0.98 * longest), "{method:?} {law:?}: {longest}");
                assert!(grows(method, law, 1.02 * longest), "{method:?} {law:?}: {longest}");
            }
        }
        // 2.785 on the real axis.
        let real = Stiff::Second(96.0, 20.0);
        assert!((real.largest() - 12.0).abs() < 1e-12);
        assert!((12.0 * real.longest_step(Integration::RungeKutta) - 2.785).abs() < 0.01);
        assert!((20.0 * Stiff::First(20.0).longest_step(Integration::RungeKutta) - 2.785).abs() < 0.01);
    }
}
