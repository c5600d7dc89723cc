//! Something that is lost at once and believed again only after a while.

use trench_core::Steady;

/// Losses within this time make the next return wait longer, s.
const MEMORY: f64 = 60.0;

/// The longest wait is this many dwell times.
const MOST: f64 = 16.0;

/// How long what is watched may be bad, and how long it must be good again, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Patience {
    pub(crate) bad: f64,
    pub(crate) dwell: f64,
}

/// A link or a robot. The dwell time doubles with every loss of the last minute: Proposition 8.4.2 is proved for finitely
/// many changes of structure, so they must not come ever again as fast as one likes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Watch {
    lost: bool,
    /// Since when the contrary has been seen.
    contrary_since: Option<Steady>,
    losses: i32,
    last_loss: Option<Steady>,
}

impl Watch {
    pub(crate) fn is_lost(&self) -> bool {
        self.lost
    }

    /// Takes how it is now; gives whether it was lost or came back.
    pub(crate) fn update(&mut self, now: Steady, good: bool, patience: Patience) -> bool {
        if good != self.lost {
            self.contrary_since = None;
            return false;
        }
        let since = *self.contrary_since.get_or_insert(now);
        let needed = if self.lost { self.dwell(patience) } else { patience.bad };
        if now.seconds_since(since) < needed {
            return false;
        }
        (self.lost, self.contrary_since) = (!self.lost, None);
        if self.lost {
            let lately = self.last_loss.is_some_and(|last| now.seconds_since(last) <= MEMORY);
            self.losses = if lately { self.losses.saturating_add(1) } else { 1 };
            self.last_loss = Some(now);
        }
        true
    }

    fn dwell(&self, patience: Patience) -> f64 {
        patience.dwell * libm::exp2(f64::from(self.losses - 1)).min(MOST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATIENCE: Patience = Patience { bad: 0.5, dwell: 2.0 };

    /// When it changes, in tenths of a second, if it is good where `good` says so.
    fn changes(good: impl Fn(u64) -> bool, until: u64) -> Vec<u64> {
        let mut watch = Watch::default();
        let at = |tenths: u64| Steady(tenths * 100_000_000);
        (0..until).filter(|tenths| watch.update(at(*tenths), good(*tenths), PATIENCE)).collect()
    }

    #[test]
    fn short_gaps_are_no_losses() {
        assert!(changes(|tenths| tenths % 5 != 0, 1000).is_empty());
        assert_eq!(changes(|tenths| !(10..30).contains(&tenths), 100), [15, 50]);
    }

    #[test]
    fn what_is_lost_again_and_again_must_be_good_for_longer() {
        // One second bad, 2.5 s good.
        assert_eq!(changes(|tenths| tenths % 35 >= 10, 140), [5, 30, 40], "the second time it needs 4 s");
        let changes = changes(|tenths| tenths % 35 >= 10, 35 * 1000);
        assert!(changes.len() < 10, "structure changes ever more rarely: {changes:?}");
    }
}
