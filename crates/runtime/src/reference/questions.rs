//! When another host is asked for its time.

use std::collections::VecDeque;
use trench_core::Steady;

/// s, between two questions: quickly until there is a good answer, then as often as diagnostics go out.
const FIRST: f64 = 0.1;
const LATER: f64 = 1.0;

/// Questions that may wait for their answers at once. Behind a slow link answers take longer than questions are apart, and each counts.
const WAITING: usize = 64;

/// Questions under way.
#[derive(Debug, Default)]
pub(crate) struct Questions {
    /// Their counts and when they were asked.
    asked: VecDeque<(u64, Steady)>,
    next: Steady,
}

impl Questions {
    /// When to look again.
    pub(crate) fn next(&self) -> Steady {
        self.next
    }

    /// Whether it is time for one; `good` is what was heard so far.
    pub(crate) fn are_due(&mut self, now: Steady, good: bool) -> bool {
        if self.next > now {
            return false;
        }
        self.next = now.plus_seconds(if good { LATER } else { FIRST });
        true
    }

    /// One was asked.
    pub(crate) fn ask(&mut self, count: u64, now: Steady) {
        if self.asked.len() == WAITING {
            self.asked.pop_front();
        }
        self.asked.push_back((count, now));
    }

    /// When the question was asked that this answers, if it still waits.
    pub(crate) fn answer(&mut self, count: u64) -> Option<Steady> {
        let place = self.asked.iter().position(|(asked, _)| *asked == count)?;
        self.asked.remove(place).map(|(_, asked)| asked)
    }
}

#[cfg(test)]
mod tests {
    use super::Questions;
    use trench_core::Steady;

    /// Hundredths of a second in which an answer takes `delay` of them: how many questions were asked, and how many answers counted.
    fn ten_seconds(delay: u64, good: bool) -> (u64, usize) {
        let (mut questions, mut asked, mut counted) = (Questions::default(), Vec::new(), 0);
        for hundredths in 0..1000 {
            let now = Steady(hundredths * 10_000_000);
            for (count, _) in asked.iter().filter(|(_, at)| at + delay == hundredths) {
                counted += usize::from(questions.answer(*count).is_some());
            }
            if questions.are_due(now, good) {
                let count = asked.len() as u64;
                questions.ask(count, now);
                asked.push((count, hundredths));
            }
        }
        (asked.len() as u64, counted)
    }

    #[test]
    fn answers_count_however_long_they_take() {
        assert_eq!(ten_seconds(1, false), (100, 100));
        assert_eq!(ten_seconds(1, true), (10, 10));
        // A quarter of a second, and five: only the last ones are still under way at the end.
        assert_eq!(ten_seconds(25, false), (100, 98));
        assert_eq!(ten_seconds(500, false), (100, 50));
        // Nobody answers.
        assert_eq!(ten_seconds(10_000, false), (100, 0));
    }
}
