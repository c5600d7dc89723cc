//! The analytic pieces that curves are made of: value, derivatives, and bounds on the derivatives.
use crate::lanes::{Number, Plane};
use nalgebra::Vector2;
use trench_expression::Expression;

/// Position and its first two derivatives by a parameter: the primitive's own, or another of a constant ratio to it. Of one point or of
/// several side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet<V = Vector2<f64>> {
    pub(super) point: V,
    pub(super) first: V,
    pub(super) second: V,
}

impl Jet {
    /// The same by a parameter that is `factor` times as small.
    pub(super) fn stretched(self, factor: f64) -> Self {
        Self { first: factor * self.first, second: factor * factor * self.second, ..self }
    }
}

impl<V: Plane> Jet<V> {
    /// A small step on, by Taylor's series.
    #[inline(always)]
    pub(super) fn moved(&self, step: V::Number, third: V) -> Self {
        let half = V::Number::splat(0.5) * step;
        Self {
            point: self.point + step * (self.first + half * (self.second + step / V::Number::splat(3.0) * third)),
            first: self.first + step * (self.second + half * third),
            second: self.second + step * third,
        }
    }

    /// Slope of half the squared distance from `point`, by the parameter.
    #[inline(always)]
    pub(super) fn slope(&self, point: V) -> V::Number {
        (self.point - point).dot(&self.first)
    }

    /// How that slope grows.
    #[inline(always)]
    pub(super) fn growth(&self, point: V) -> V::Number {
        self.first.norm_squared() + (self.point - point).dot(&self.second)
    }

    /// Halley's step to where the slope is zero.
    #[inline(always)]
    pub(super) fn step_of_third_order(&self, third: V, point: V) -> V::Number {
        let (value, slope) = (self.slope(point), self.growth(point));
        let growth = V::Number::splat(3.0) * self.first.dot(&self.second) + (self.point - point).dot(&third);
        let two = V::Number::splat(2.0);
        -two * value * slope / (two * slope * slope - value * growth)
    }

    /// Newton's step to there.
    #[inline(always)]
    pub(super) fn step_of_second_order(&self, point: V) -> V::Number {
        -self.slope(point) / self.growth(point)
    }
}

/// One analytic curve over a parameter interval.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Primitive {
    /// start + u direction: the parameter is arc length.
    Line { start: Vector2<f64>, direction: Vector2<f64> },
    /// centre + A cos u + B sin u with A and B perpendicular: circles and ellipses.
    Ellipse { centre: Vector2<f64>, cosine: Vector2<f64>, sine: Vector2<f64> },
    /// c0 + c1 u + c2 u^2 + c3 u^3.
    Cubic { coefficients: [Vector2<f64>; 4] },
    /// origin + u along + across sin(k u + phase), `across` holding the amplitude.
    Sinusoid { origin: Vector2<f64>, along: Vector2<f64>, across: Vector2<f64>, wave_number: f64, phase: f64 },
    /// (u, f(u)), for u between two bounds within which f is twice differentiable.
    Graph { function: Expression, domain: (f64, f64) },
}

impl Primitive {
    /// Cubic with the given Bezier control points, 0 <= u <= 1.
    pub(super) fn bezier(control: [Vector2<f64>; 4]) -> Self {
        let [p0, p1, p2, p3] = control;
        Self::Cubic { coefficients: [p0, 3.0 * (p1 - p0), 3.0 * (p0 - 2.0 * p1 + p2), p3 - 3.0 * p2 + 3.0 * p1 - p0] }
    }

    /// Whether it is the graph of a function over an axis, along which it never comes back: so it cannot meet itself.
    pub(super) fn is_graph(&self) -> bool {
        matches!(self, Self::Line { .. } | Self::Sinusoid { .. } | Self::Graph { .. })
    }

    /// Position and derivatives at parameter `u`.
    pub(super) fn evaluate(&self, u: f64) -> Jet {
        match *self {
            Self::Line { start, direction } => {
                Jet { point: start + u * direction, first: direction, second: Vector2::zeros() }
            }
            Self::Ellipse { centre, cosine, sine } => {
                let (s, c) = libm::sincos(u);
                let arm = c * cosine + s * sine;
                Jet { point: centre + arm, first: c * sine - s * cosine, second: -arm }
            }
            Self::Cubic { coefficients: [c0, c1, c2, c3] } => Jet {
                point: c0 + u * (c1 + u * (c2 + u * c3)),
                first: c1 + u * (2.0 * c2 + 3.0 * u * c3),
                second: 2.0 * c2 + 6.0 * u * c3,
            },
            Self::Sinusoid { origin, along, across, wave_number, phase } => {
                let (s, c) = libm::sincos(wave_number * u + phase);
                Jet {
                    point: origin + u * along + s * across,
                    first: along + wave_number * c * across,
                    second: -wave_number * wave_number * s * across,
                }
            }
            Self::Graph { ref function, .. } => {
                let series = function.series::<f64, 3>(u);
                Jet {
                    point: Vector2::new(u, series.0[0]),
                    first: Vector2::new(1.0, series.0[1]),
                    second: Vector2::new(0.0, 2.0 * series.0[2]),
                }
            }
        }
    }

    /// Upper bounds of the norms of the second and third derivative for |v - u| <= `half_width`.
    pub(super) fn derivative_bounds(&self, u: f64, half_width: f64) -> (f64, f64) {
        match self {
            Self::Line { .. } => (0.0, 0.0),
            Self::Ellipse { cosine, sine, .. } => {
                let longest = cosine.norm().max(sine.norm());
                (longest, longest)
            }
            Self::Cubic { coefficients: [_, _, c2, c3] } => {
                let third = 6.0 * c3.norm();
                ((2.0 * c2 + 6.0 * u * c3).norm() + half_width * third, third)
            }
            Self::Sinusoid { across, wave_number, .. } => {
                let second = across.norm() * wave_number * wave_number;
                (second, second * wave_number)
            }
            Self::Graph { function, domain: (from, to) } => {
                let ends = ((u - half_width).max(*from), (u + half_width).min(*to));
                let series = function.enclosure::<4>(ends.0, ends.1);
                (2.0 * series.0[2].magnitude(), 6.0 * series.0[3].magnitude())
            }
        }
    }

    /// Radius and centre if this is part of a circle.
    pub(super) fn circle(&self) -> Option<(Vector2<f64>, f64)> {
        match self {
            Self::Ellipse { centre, cosine, sine } if cosine.norm_squared() == sine.norm_squared() => {
                Some((*centre, cosine.norm()))
            }
            _ => None,
        }
    }
}
