//! When something that comes at regular times will come next.

use trench_core::Steady;

/// How much of the period an interval may differ from it.
const TOLERANCE: f64 = 0.1;
/// So many intervals in a row must be alike.
const CERTAIN: u32 = 3;
/// The share of a new interval in the period.
const GAIN: f64 = 0.2;

/// The period of something, learned from when it came.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rhythm {
    last: Option<Steady>,
    /// s
    period: f64,
    alike: u32,
}

impl Rhythm {
    /// It came.
    pub(crate) fn beat(&mut self, now: Steady) {
        let Some(last) = self.last.replace(now) else { return };
        let interval = now.seconds_since(last);
        if (interval - self.period).abs() <= TOLERANCE * self.period {
            self.period += GAIN * (interval - self.period);
            self.alike = self.alike.saturating_add(1);
        } else {
            self.period = interval;
            self.alike = 0;
        }
    }

    /// When it will come next, if that can be told.
    pub(crate) fn next(&self) -> Option<Steady> {
        self.last.filter(|_| self.alike >= CERTAIN).map(|last| last.plus_seconds(self.period))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(times: impl IntoIterator<Item = f64>) -> Option<f64> {
        let start = Steady(1_000_000_000);
        let mut rhythm = Rhythm::default();
        times.into_iter().for_each(|time| rhythm.beat(start.plus_seconds(time)));
        rhythm.next().map(|next| next.seconds_since(start))
    }

    #[test]
    fn what_is_regular_is_foretold() {
        let next = after((0..10).map(|frame| f64::from(frame) / 30.0 + if frame % 2 == 0 { 0.0 } else { 0.001 }));
        assert!((next.unwrap() - 10.0 / 30.0).abs() < 0.0015, "{next:?}");
    }

    #[test]
    fn what_is_not_is_not() {
        assert_eq!(after([]), None);
        assert_eq!(after([0.0, 0.1, 0.2, 0.3]), None, "too few");
        assert_eq!(after([0.0, 0.1, 0.3, 0.4, 0.9, 1.0, 1.1, 1.2]), None);
        assert_eq!(after([0.0; 10]), Some(0.0));
    }
}
