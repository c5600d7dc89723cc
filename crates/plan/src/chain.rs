//! Places of chains along their segments.

use crate::ON_SEGMENT;
use crate::plan::Place;
use trench_formation::curve::Curve;

/// Places along the segment, one behind the other: the first at the vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainPlaces {
    /// How many robots.
    pub robots: u32,
    /// Between neighbours, m of arc length.
    pub spacing: f64,
}

/// A chain that is longer than its segment.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoRoom {
    /// A segment with ends.
    #[error("the chain does not fit: it is {chain:.3} m long, the segment behind its vertex {room:.3} m")]
    Behind {
        /// From the first place to the last, m.
        chain: f64,
        /// m.
        room: f64,
    },
    /// A closed segment: the last place is beside the first, too.
    #[error("the chain does not fit: round the closed segment it needs {chain:.3} m, and that is {room:.3} m long")]
    Round {
        /// From the first place round to the first, m.
        chain: f64,
        /// m.
        room: f64,
    },
}

impl NoRoom {
    /// What would be right.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Behind { .. } => "take fewer robots, a smaller spacing, a longer segment, or open_start or open_end",
            Self::Round { .. } => "take fewer robots, a smaller spacing or a longer segment",
        }
    }
}

impl ChainPlaces {
    /// The places behind `vertex` (arc length, m), on the side of the segment that is longer; on a closed segment they go on past the
    /// seam, where arc lengths begin again.
    ///
    /// # Errors
    /// Where the segment is too short.
    pub fn along(self, curve: &Curve, vertex: f64) -> Result<Vec<Place>, NoRoom> {
        let (from, to) = curve.domain();
        let (before, after) = (vertex - from, to - vertex);
        let (sign, room) = if before >= after { (-1.0, before) } else { (1.0, after) };
        self.fits(curve, room)?;
        let on_curve = |at: f64| if curve.is_closed() { round(at, curve.length()) } else { at.max(from).min(to) };
        let place = |index: u32| on_curve(vertex + sign * self.spacing * f64::from(index));
        Ok((0..self.robots).map(place).map(|end| Place { start: end, end }).collect())
    }

    /// Whether they fit on `room` (m) of a segment on one side of the first; on a closed one round it.
    ///
    /// # Errors
    /// Where the segment is too short.
    pub fn fits(self, curve: &Curve, room: f64) -> Result<(), NoRoom> {
        let gaps = self.robots.saturating_sub(1);
        let chain = self.spacing * f64::from(gaps);
        if !curve.is_closed() {
            return if chain > room + ON_SEGMENT { Err(NoRoom::Behind { chain, room }) } else { Ok(()) };
        }
        // One robot has no neighbour.
        let (chain, room) = (if gaps > 0 { chain + self.spacing } else { 0.0 }, curve.length());
        if chain > room + ON_SEGMENT { Err(NoRoom::Round { chain, room }) } else { Ok(()) }
    }
}

/// An arc length (m) of a closed curve of a length (m), from 0 to the length.
fn round(at: f64, length: f64) -> f64 {
    at - (at / length).floor() * length
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_formation::Vector2;
    use trench_formation::curve::CurveShape;

    fn ends(curve: &Curve, robots: u32, spacing: f64, vertex: f64) -> Result<Vec<f64>, NoRoom> {
        let places = ChainPlaces { robots, spacing }.along(curve, vertex)?;
        Ok(places.into_iter().map(|place| place.end).collect())
    }

    fn assert_near(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn places_go_to_the_longer_side() {
        let line = CurveShape::Line(Vector2::zeros(), Vector2::new(2.0, 0.0));
        let line = Curve::new(&line, false, false).unwrap();
        assert_near(&ends(&line, 3, 0.5, 1.5).unwrap(), &[1.5, 1.0, 0.5]);
        assert_near(&ends(&line, 3, 0.5, 0.5).unwrap(), &[0.5, 1.0, 1.5]);
        assert_eq!(ends(&line, 5, 0.5, 1.5), Err(NoRoom::Behind { chain: 2.0, room: 1.5 }));
    }

    /// A circle of 4 m: five robots stand once round it, a sixth would stand on the first.
    #[test]
    fn on_closed_segments_places_go_round_past_the_seam() {
        let circle =
            CurveShape::Ellipse { centre: Vector2::zeros(), semi_axes: [2.0 / std::f64::consts::PI; 2], rotation: 0.0 };
        let circle = Curve::new(&circle, false, false).unwrap();
        assert_near(&ends(&circle, 5, 0.8, 2.0).unwrap(), &[2.0, 1.2, 0.4, 3.6, 2.8]);
        assert_near(&ends(&circle, 5, 0.8, 1.0).unwrap(), &[1.0, 1.8, 2.6, 3.4, 0.2]);
        assert!(matches!(ends(&circle, 6, 0.8, 2.0), Err(NoRoom::Round { chain, .. }) if (chain - 4.8).abs() < 1e-12));
        assert_near(&ends(&circle, 1, 9.0, 2.0).unwrap(), &[2.0]);
    }
}
