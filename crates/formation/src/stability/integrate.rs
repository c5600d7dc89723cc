//! Runge-Kutta of order 4, with a fixed order of operations.
use nalgebra::SVector;

/// The state after one `step` of state' = `rate`(time, state).
pub fn rk4<const N: usize>(
    time: f64,
    state: SVector<f64, N>,
    step: f64,
    rate: impl Fn(f64, &SVector<f64, N>) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let half = 0.5 * step;
    let a = rate(time, &state);
    let b = rate(time + half, &(state + a * half));
    let c = rate(time + half, &(state + b * half));
    let d = rate(time + step, &(state + c * step));
    state + (a + (b + c) * 2.0 + d) * (step / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    /// Halving the step divides the error by 16.
    #[test]
    fn order_four() {
        let error = |steps: u32| {
            let step = 1.0 / f64::from(steps);
            let mut state = Vector2::new(1.0, 0.0);
            for index in 0..steps {
                state = rk4(f64::from(index) * step, state, step, |_, s| Vector2::new(s.y, -s.x));
            }
            (state - Vector2::new(libm::cos(1.0), -libm::sin(1.0))).norm()
        };
        let ratio = error(20) / error(40);
        assert!((ratio - 16.0).abs() < 1.0, "{ratio}");
    }
}
