//! How often a process ends: who crashes again and again is not started for ever.

use super::Options;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// The ends of one process's lives, as far as they matter.
#[derive(Debug, Clone, Default)]
pub(super) struct Ends {
    /// How many lives in a row were short.
    short_lives: u32,
    /// When the last lives ended.
    times: VecDeque<Instant>,
}

impl Ends {
    /// Takes the end of a life; says why the process should not be started again, if it has crashed too often: soon after its start
    /// time and again, or too often within a while.
    pub(super) fn add(&mut self, now: Instant, life: Duration, options: &Options) -> Option<String> {
        self.short_lives = if life < options.short_life { self.short_lives + 1 } else { 0 };
        self.times.push_back(now);
        while self.times.front().is_some_and(|first| now.duration_since(*first) > options.ends_within) {
            self.times.pop_front();
        }
        if self.short_lives >= options.most_short_lives {
            let (count, seconds) = (self.short_lives, options.short_life.as_secs_f64());
            return Some(format!("ended {count} times within {seconds} s of its start"));
        }
        let (count, seconds) = (self.times.len(), options.ends_within.as_secs_f64());
        (count >= options.most_ends).then(|| format!("ended {count} times within {seconds} s"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// After how many ends a process is given up that ends every so many seconds, of a hundred ends at most.
    fn given_up_after(period: f64) -> Option<(usize, String)> {
        let (mut ends, start) = (Ends::default(), Instant::now());
        let options = Options::new(Path::new(""));
        let life = Duration::from_secs_f64(period);
        (1..=100_u32).find_map(|count| Some((count as usize, ends.add(start + count * life, life, &options)?)))
    }

    #[test]
    fn whoever_crashes_again_and_again_is_given_up() {
        let told = |count, text: &str| Some((count, text.to_owned()));
        assert_eq!(given_up_after(0.2), told(5, "ended 5 times within 1 s of its start"));
        assert_eq!(given_up_after(1.5), told(10, "ended 10 times within 60 s"));
        assert_eq!(given_up_after(6.5), told(10, "ended 10 times within 60 s"));
    }

    #[test]
    fn whoever_is_killed_now_and_then_is_not() {
        assert_eq!(given_up_after(7.0), None);
        assert_eq!(given_up_after(20.0), None);
    }

    #[test]
    fn a_long_life_forgives_short_ones_but_not_their_number() {
        let (mut ends, mut now) = (Ends::default(), Instant::now());
        let options = Options::new(Path::new(""));
        let lives = [0.1, 0.1, 0.1, 0.1, 2.0, 0.1, 0.1, 0.1, 0.1].map(Duration::from_secs_f64);
        for life in lives {
            now += life;
            assert_eq!(ends.add(now, life, &options), None);
        }
        let life = Duration::from_secs(2);
        assert_eq!(ends.add(now + life, life, &options).as_deref(), Some("ended 10 times within 60 s"));
    }
}
