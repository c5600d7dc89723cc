//! Angles on the circle.
use core::f64::consts::{PI, TAU};

/// `angle` (rad) brought to (-pi, pi], the domain of theta and phi in 3.2.1. A non-finite angle gives NaN.
pub fn wrap(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    let remainder = libm::remainder(angle, TAU);
    if remainder <= -PI { remainder + TAU } else { remainder }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn borders_belong_to_the_upper_end() {
        assert_eq!(wrap(PI), PI);
        assert_eq!(wrap(-PI), PI);
        assert_eq!(wrap(3.0 * PI), PI);
        assert_eq!(wrap(0.0), 0.0);
        assert!(wrap(f64::NAN).is_nan());
        assert!(wrap(f64::INFINITY).is_nan());
    }

    proptest! {
        #[test]
        fn names_the_same_direction(angle in -1e4_f64..1e4) {
            let wrapped = wrap(angle);
            prop_assert!(wrapped > -PI && wrapped <= PI);
            prop_assert!((libm::sin(wrapped) - libm::sin(angle)).abs() < 1e-9);
            prop_assert!((libm::cos(wrapped) - libm::cos(angle)).abs() < 1e-9);
        }
    }
}
