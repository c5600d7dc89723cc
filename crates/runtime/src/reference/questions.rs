//! When another host is asked for its time.

use trench_core::Steady;

/// s, between two questions: quickly until there is a good answer, then as often as diagnostics go out.
const FIRST: f64 = 0.1;
const LATER: f64 = 1.0;

/// s: how long an answer is waited for. Each question makes a later answer to the one before worthless, so none is asked meanwhile:
/// behind a link on which answers take longer than questions are apart, no answer would ever count.
const PATIENCE: f64 = 1.0;

/// One question at a time.
#[derive(Debug, Default)]
pub(crate) struct Questions {
    /// The question under way: its count and when it was asked.
    asked: Option<(u64, Steady)>,
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
        self.asked.is_none_or(|(_, asked)| now.seconds_since(asked) >= PATIENCE)
    }

    /// One was asked.
    pub(crate) fn ask(&mut self, count: u64, now: Steady) {
        self.asked = Some((count, now));
    }

    /// When the question was asked that this answers, if it is the one under way.
    pub(crate) fn answer(&mut self, count: u64) -> Option<Steady> {
        self.asked.take_if(|(asked, _)| *asked == count).map(|(_, asked)| asked)
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
        let (asked, counted) = ten_seconds(25, false);
        assert!((30..=34).contains(&asked) && counted as u64 + 1 >= asked, "{counted} of {asked}");
        // Nobody answers: once a second.
        assert_eq!(ten_seconds(10_000, false), (10, 0));
    }
}
