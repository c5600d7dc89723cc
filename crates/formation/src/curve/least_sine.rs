//! How nearly a curve runs along a direction: a bound, by halving.
use super::Curve;
use super::primitive::Primitive;
use nalgebra::Vector2;

/// The bound is below what is attained by no more than this.
const NEAR: f64 = 1e-6;

impl Curve {
    /// A lower bound of the sine of the angle between the curve and `along` (not zero), at every point of it and of its extensions; attained
    /// within 1e-6. Over a part of width 2 h about u, p' differs from p'(u) by S h at most, S the bound of |p''|: so the tangent turns
    /// by delta at most, sin delta = S h / |p'(u)|, and a part is halved until that is too little to fall below the least sine seen.
    pub fn least_sine(&self, along: Vector2<f64>) -> f64 {
        let along = along.normalize();
        let sine = |primitive: &Primitive, u: f64| primitive.evaluate(u).first.normalize().perp(&along).abs();
        let mut parts: Vec<(usize, f64, f64)> = Vec::new();
        let mut seen = 1.0_f64;
        for piece in &self.pieces {
            let primitive = &self.primitives[piece.primitive];
            seen = seen.min(sine(primitive, piece.from)).min(sine(primitive, piece.to));
            parts.push((piece.primitive, piece.from, piece.to));
        }
        let mut bound = seen;
        while let Some((index, from, to)) = parts.pop() {
            let primitive = &self.primitives[index];
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            let (second, _) = primitive.derivative_bounds(middle, half);
            let (speed, here) = (primitive.evaluate(middle).first.norm(), sine(primitive, middle));
            seen = seen.min(here);
            let turn = second * half / speed;
            let cosine = libm::sqrt((1.0 - here * here).max(0.0));
            let least = if turn < here { here * libm::sqrt(1.0 - turn * turn) - cosine * turn } else { 0.0 };
            // What is left of a part that rounding keeps from being halved.
            if least >= seen - NEAR || middle <= from || middle >= to {
                bound = bound.min(least.max(0.0));
            } else {
                parts.extend([(index, from, middle), (index, middle, to)]);
            }
        }
        bound.min(seen)
    }
}
