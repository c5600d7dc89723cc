//! What a person may choose about seeking.
use thiserror::Error;

/// How a robot seeks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeekSettings {
    /// Length of segment that one robot needs, m: shorter fragments do not qualify.
    pub room: f64,
    /// A robot leaves its nearest point for another (a transit) only if that is nearer by more than this, m.
    pub transit_margin: f64,
    /// A leader is settled once it is this near to the segment (m) and no faster than [`Self::settled_speed`].
    pub settled_distance: f64,
    /// m/s, relative to the segment.
    pub settled_speed: f64,
    /// What keeps the nearest point within reach of the leader.
    pub leader_rule: LeaderRule,
}

/// Fragments alone trap a robot before an obstacle while its leader goes on (ERRATA): one of these frees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeaderRule {
    /// Step (6) of 7.5.2: once the leader has settled, fragments out of its attractive zone do not count.
    StepSix,
    /// Step (6), and the whole segment counts while the leader is in zone 4 or farther.
    WholeSegmentWhileFar,
}

/// Settings that mean nothing.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{name} is {value}; it must be finite and {required}")]
pub struct SeekError {
    /// Which.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// "positive" or "zero or more".
    pub required: &'static str,
}

impl SeekSettings {
    /// Whether the settings mean something.
    ///
    /// # Errors
    /// A number that is not finite, or negative; a settling distance or speed of zero, which no robot reaches.
    pub fn check(&self) -> Result<(), SeekError> {
        let may_be_zero = [("room", self.room), ("transit_margin", self.transit_margin)];
        let positive = [("settled_distance", self.settled_distance), ("settled_speed", self.settled_speed)];
        for (name, value) in may_be_zero {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SeekError { name, value, required: "zero or more" });
            }
        }
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(SeekError { name, value, required: "positive" });
            }
        }
        Ok(())
    }
}
