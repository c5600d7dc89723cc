//! Messages that do not count: no frames, another publisher's, or of another time.

use trench_core::{NotMaster, RosTime, Times};

/// Why a message changes nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Dropped {
    /// It is no frame of this camera.
    #[error("{0}")]
    Broken(String),
    /// It may be one, and does not count.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// Why a frame does not count.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum Refusal {
    #[error(transparent)]
    NotMaster(#[from] NotMaster),
    #[error("it is {0:.3} s from the future")]
    Future(f64),
}

impl From<String> for Dropped {
    fn from(reason: String) -> Self {
        Self::Broken(reason)
    }
}

/// Whether a frame of this stamp can have been exposed by now.
///
/// # Errors
/// How far ahead it is.
pub(crate) fn timely(at: Times, stamp: RosTime) -> Result<(), Refusal> {
    at.from_the_future(stamp).map_or(Ok(()), |ahead| Err(Refusal::Future(ahead)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::Steady;

    #[test]
    fn the_future_is_known_once_there_is_a_time() {
        let timely = |now: f64, stamp: f64| {
            let at = Times { ros: RosTime(0).plus_seconds(now), steady: Steady(0) };
            timely(at, RosTime(0).plus_seconds(stamp))
        };
        assert_eq!(timely(100.0, 100.4), Ok(()));
        assert_eq!(timely(100.0, -3600.0), Ok(()), "how old it is others say");
        assert_eq!(timely(100.0, 100.9).unwrap_err().to_string(), "it is 0.900 s from the future");
        assert_eq!(timely(0.0, 100.9), Ok(()));
    }
}
