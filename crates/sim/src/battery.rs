//! The robots' batteries.

/// Fully charged, mV.
const FULL: u64 = 8200;

/// Empty, mV.
const EMPTY: u64 = 6400;

/// How long a charge lasts, s.
const LASTS: u64 = 3 * 3600;

/// The voltage in mV, so many ns after the start with a full battery.
#[must_use]
pub(crate) fn millivolts(elapsed: u64) -> u16 {
    let seconds = (elapsed / 1_000_000_000).min(LASTS);
    (FULL - (FULL - EMPTY) * seconds / LASTS) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_lasts_three_hours() {
        assert_eq!(
            [0, 5400, 10_800, 99_999].map(|seconds| millivolts(seconds * 1_000_000_000)),
            [8200, 7300, 6400, 6400]
        );
    }
}
