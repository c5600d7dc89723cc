//! Arc length of a primitive by Gauss-Legendre quadrature.
use super::primitive::Primitive;
use crate::quadrature::integral;

/// Length of `primitive` from parameter `from` to `to`, metres; negative if `to < from`.
#[inline]
pub(super) fn arc_length(primitive: &Primitive, from: f64, to: f64) -> f64 {
    if let Primitive::Line { .. } = primitive { to - from } else { of_bend(primitive, from, to) }
}

fn of_bend(primitive: &Primitive, from: f64, to: f64) -> f64 {
    if let Some((_, radius)) = primitive.circle() {
        return radius * (to - from);
    }
    integral(from, to, |u| primitive.evaluate(u).first.norm())
}
