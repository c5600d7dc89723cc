//! Why a curve cannot be built, and what would make it possible.
use thiserror::Error;

/// A curve's description that names no usable segment (Definition 2.1.2). The text says what is wrong and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CurveError {
    /// A coordinate, angle or length is NaN or infinite.
    #[error("{what} is not a finite number: give a finite value in metres or radians")]
    NotFinite {
        /// Which value.
        what: &'static str,
    },
    /// Too few or a wrong number of points.
    #[error("{shape} has {got} points but needs {expected}: add or remove points")]
    PointCount {
        /// Kind of curve.
        shape: &'static str,
        /// Points given.
        got: usize,
        /// Points needed, in words.
        expected: &'static str,
    },
    /// Two points in a row coincide, so a piece has no direction.
    #[error("points {0} and {1} coincide, so the piece between them has length zero")]
    RepeatedPoint(usize, usize),
    /// A radius, length, semi-axis or wavelength that must be positive is not.
    #[error("{what} is {value}, but must be greater than zero")]
    NotPositive {
        /// Which value.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A coordinate or length that no robot comes to, or whose square is no number.
    #[error("{what} is {value:e}, but must be from 1e-12 to 1e12: write metres")]
    Size {
        /// Which value.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The curve bends so often that it takes too many pieces.
    #[error(
        "the curve bends so often that it takes more than {most} pieces (its first {arc_length:.3} m take so many): shorten it, or take fewer \
         and longer waves",
        most = super::piece::MOST_PIECES
    )]
    ManyPieces {
        /// What those are long together, metres.
        arc_length: f64,
    },
    /// An arc of sweep zero or of more than one turn.
    #[error("an arc's sweep is {0} rad, but must be in [-2 pi, 2 pi] and not zero")]
    Sweep(f64),
    /// The tangent vanishes or turns at once, so the curve is not twice differentiable there.
    #[error(
        "the curve has a cusp (a point without a tangent) after {arc_length} m: move the points near it apart, or take a function that \
         bends less there"
    )]
    Cusp {
        /// Distance along the curve, metres.
        arc_length: f64,
    },
    /// y = f(x) over a range of no length.
    #[error("the graph goes from x = {from} to x = {to}, but must go to a greater x")]
    Range {
        /// First x.
        from: f64,
        /// Last x.
        to: f64,
    },
    /// f is not twice differentiable (Definition 2.1.2 asks for it) on all of its range.
    #[error("y = {expression} {problem} at x = {x} ({cause} at column {column}): {remedy}")]
    NotSmooth {
        /// f.
        expression: String,
        /// What is wrong.
        problem: &'static str,
        /// Where, m.
        x: f64,
        /// What in f causes it.
        cause: &'static str,
        /// Where that stands in f, from 1.
        column: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// The expression of a graph cannot be written larger or smaller.
    #[error("the expression {0}")]
    Expression(#[from] trench_expression::ExpressionError),
    /// The curve meets itself, so arc length along it does not order robots.
    #[error(
        "the curve meets itself after {first} m and after {second} m: move the points between, or split it into two \
         segments"
    )]
    SelfIntersection {
        /// Distance along the curve of the first passage, metres.
        first: f64,
        /// Distance along the curve of the second passage, metres.
        second: f64,
    },
    /// The extension of an open end meets the curve.
    #[error(
        "beyond its open {end} the queue goes straight on for ever, and after {beyond} m meets the curve (at {arc_length} m of its length): \
         turn that end away, or set open_{end} to false"
    )]
    OpenEndMeets {
        /// "start" or "end".
        end: &'static str,
        /// Distance beyond the end, metres.
        beyond: f64,
        /// Distance along the curve, metres.
        arc_length: f64,
    },
    /// The extensions of the two open ends meet each other.
    #[error(
        "beyond its open ends the queue goes straight on for ever, and the two ways cross {before} m before the start and {behind} m behind \
         the end: turn one of them away, or set open_start or open_end to false"
    )]
    OpenEndsMeet {
        /// Distance beyond the start, metres.
        before: f64,
        /// Distance beyond the end, metres.
        behind: f64,
    },
    /// A closed curve has no ends, so it cannot extend beyond them.
    #[error("a closed curve has no end to extend from: set open_start and open_end to false")]
    ClosedCurveExtended,
}
