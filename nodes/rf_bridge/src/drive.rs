//! From a twist to wheel speeds.

use trench_radio::wheel_speed;

/// Left and right wheel speed in m/s for a forward speed `v` (m/s) and a turning speed `omega` (rad/s). Where a wheel
/// would exceed `max`, both are scaled by the same factor: slower on the same curve.
pub(crate) fn wheels(v: f64, omega: f64, half_axle: f64, max: f64) -> [f64; 2] {
    let (left, right) = wheel_speed(v, omega, half_axle);
    let fastest = left.abs().max(right.abs());
    let scale = if fastest > max { max / fastest } else { 1.0 };
    [left * scale, right * scale]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn within_the_limit_and_on_the_curve(v in -2.0..2.0f64, omega in -20.0..20.0f64) {
            let [left, right] = wheels(v, omega, 0.06, 0.3);
            prop_assert!(left.abs().max(right.abs()) <= 0.3 + 1e-12);
            let (scaled_v, scaled_omega) = ((left + right) / 2.0, (right - left) / 0.12);
            prop_assert!((scaled_v * omega - v * scaled_omega).abs() < 1e-9);
            prop_assert!(scaled_v * v >= 0.0 && scaled_omega * omega >= 0.0);
        }
    }

    #[test]
    fn slow_commands_are_left_alone() {
        assert_eq!(wheels(0.1, 0.5, 0.06, 0.3), [0.07, 0.13]);
    }
}
