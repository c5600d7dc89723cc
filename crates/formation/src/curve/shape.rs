//! What a person writes down to define a curve.
use nalgebra::Vector2;
use trench_expression::Expression;

/// Description of a curve, in the formation's frame; metres and radians.
#[derive(Debug, Clone, PartialEq)]
pub enum CurveShape {
    /// Straight from the first point to the second.
    Line(Vector2<f64>, Vector2<f64>),
    /// Straight pieces between two or more corners.
    Polyline(Vec<Vector2<f64>>),
    /// Part of a circle, or all of it if |sweep| = 2 pi: closed then.
    Arc {
        /// Centre of the circle.
        centre: Vector2<f64>,
        /// Radius, m.
        radius: f64,
        /// Direction from the centre to the first point, rad.
        start_angle: f64,
        /// Angle covered, rad; positive is counter-clockwise.
        sweep: f64,
    },
    /// A whole ellipse, counter-clockwise from the end of its first semi-axis.
    Ellipse {
        /// Centre of the ellipse.
        centre: Vector2<f64>,
        /// First and second semi-axis, m.
        semi_axes: [f64; 2],
        /// Direction of the first semi-axis, rad.
        rotation: f64,
    },
    /// Natural cubic spline through two or more knots, its parameter growing with chord length.
    Spline(Vec<Vector2<f64>>),
    /// Cubic Bezier pieces: 3 n + 1 control points.
    Bezier(Vec<Vector2<f64>>),
    /// origin + x (cos d, sin d) + amplitude sin(2 pi x / wavelength + phase) (-sin d, cos d), 0 <= x <= length.
    Sinusoid {
        /// Where x = 0 lies on the axis.
        origin: Vector2<f64>,
        /// Direction d of the axis, rad.
        direction: f64,
        /// Length along the axis (not along the curve), m.
        length: f64,
        /// Amplitude, m; zero gives a straight line.
        amplitude: f64,
        /// Wavelength, m.
        wavelength: f64,
        /// Phase at the origin, rad.
        phase: f64,
    },
    /// y = f(x) for from <= x <= to, f twice differentiable there.
    Graph {
        /// f.
        function: Expression,
        /// The least x, m.
        from: f64,
        /// The greatest x, m.
        to: f64,
    },
}
