//! Why an obstacle cannot be used, and what would make it usable.
use thiserror::Error;

/// An obstacle or a clearance that means nothing.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum HullError {
    /// No corner at all.
    #[error("an obstacle has no points: give the centre of a disc or the corners of a polygon")]
    NoPoints,
    /// A coordinate is NaN or infinite.
    #[error("corner {0} is not finite: give coordinates in metres")]
    NotFinite(usize),
    /// A radius or clearance that is negative, NaN or infinite.
    #[error("{what} is {value} m, but must be finite and zero or more")]
    Negative {
        /// Which length.
        what: &'static str,
        /// Its value, m.
        value: f64,
    },
    /// A polygon without an inside.
    #[error("the polygon has no area: give corners that are not on one line, or two points for a thin wall")]
    NoArea,
    /// Two edges of a polygon meet.
    #[error("the polygon crosses itself: its edges that begin at corners {0} and {1} meet; put the corners in order")]
    SelfCrossing(usize, usize),
    /// Two obstacles of one id.
    #[error("two obstacles have the id {0}: give each its own")]
    DuplicateId(u32),
}
