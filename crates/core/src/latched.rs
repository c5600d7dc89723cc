//! The last word of each publisher of a latched topic.

use std::cmp::Ordering;

/// A latched topic is said once and stays said: who speaks later, and may be a stranger, must not make it unsaid. So each
/// publisher's last word is kept, and the reader chooses by what else it hears.
#[derive(Debug, Clone)]
pub struct Latched<T> {
    /// The one that spoke last comes last.
    words: Vec<([u8; 16], T)>,
    /// Whose word was of the epoch in force, or of one before, when [`Self::follow`] was asked last.
    followed: Option<[u8; 16]>,
}

impl<T> Default for Latched<T> {
    fn default() -> Self {
        Self { words: Vec::new(), followed: None }
    }
}

impl<T> Latched<T> {
    /// Of so many publishers: those that died and whose words nobody takes back are few.
    const MOST: usize = 16;

    /// A publisher speaks. Where too many have, the first one, the last one and those before it are kept.
    pub fn hear(&mut self, publisher: [u8; 16], message: T) {
        self.words.retain(|(gid, _)| *gid != publisher);
        if self.words.len() >= Self::MOST {
            self.words.remove(1);
        }
        self.words.push((publisher, message));
    }

    /// Words with their publishers, in the order in which they were said.
    pub fn words(&self) -> impl Iterator<Item = &([u8; 16], T)> {
        self.words.iter()
    }

    /// The word with the largest key, of equal ones the last; without any key the last word.
    pub fn choose<K: Ord>(&self, key: impl Fn(&T) -> Option<K>) -> Option<&([u8; 16], T)> {
        self.words.iter().max_by_key(|(_, word)| key(word))
    }

    /// The word of `epoch`, which something newer is of; else that of the publisher that was followed last, if it is ahead of that: what is
    /// newer will come after it; else the word of the last epoch before. Without an epoch (0), or any of these, the last word.
    pub fn follow(&mut self, epoch: u64, of: impl Fn(&T) -> u64) -> Option<&([u8; 16], T)> {
        let followed = self.followed;
        let rank = |(gid, word): &([u8; 16], T)| match of(word).cmp(&epoch) {
            _ if epoch == 0 => None,
            Ordering::Equal => Some((3, epoch)),
            Ordering::Greater => (followed == Some(*gid)).then_some((2, epoch)),
            Ordering::Less => Some((1, of(word))),
        };
        let best = self.words.iter().max_by_key(|word| rank(word))?;
        if rank(best).is_some() {
            self.followed = Some(best.0);
        }
        Some(best)
    }

    /// Whether more than one publisher has spoken.
    #[must_use]
    pub fn are_several(&self) -> bool {
        self.words.len() > 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Who said the chosen one of these words (publisher, word), the larger even one being better.
    fn chosen(said: &[(u8, u32)]) -> Option<(u8, u32)> {
        let mut latched = Latched::default();
        for (publisher, word) in said {
            latched.hear([*publisher; 16], *word);
        }
        latched.choose(|word| word.is_multiple_of(2).then_some(*word)).map(|(gid, word)| (gid[0], *word))
    }

    #[test]
    fn a_word_stays_said() {
        assert_eq!(chosen(&[]), None);
        assert_eq!(chosen(&[(1, 8), (2, 9), (2, 6)]), Some((1, 8)));
        assert_eq!(chosen(&[(1, 8), (2, 8)]), Some((2, 8)), "the last of equal ones");
        assert_eq!(chosen(&[(2, 8), (1, 8), (1, 7)]), Some((2, 8)), "a publisher's own word replaces its last one");
        assert_eq!(chosen(&[(1, 7), (2, 5)]), Some((2, 5)), "none is better than the last one");
    }

    #[test]
    fn a_crowd_does_not_push_the_first_one_out() {
        let crowd: Vec<_> = std::iter::once((0, 200)).chain((1..100).map(|publisher| (publisher, 2))).collect();
        assert_eq!(chosen(&crowd), Some((0, 200)));
    }

    /// Whom a reader follows whose goals are of an epoch, while words (publisher, epoch) are said.
    #[test]
    fn whom_a_reader_follows() {
        let mut latched = Latched::default();
        let mut hear = |said: &[(u8, u64)], epoch: u64| {
            for (publisher, word) in said {
                latched.hear([*publisher; 16], *word);
            }
            latched.follow(epoch, |word| *word).map(|(gid, word)| (gid[0], *word))
        };
        assert_eq!(hear(&[], 0), None);
        assert_eq!(hear(&[(1, 5)], 0), Some((1, 5)), "before any goals");
        assert_eq!(hear(&[(2, 1 << 63)], 0), Some((2, 1 << 63)), "the last word");
        assert_eq!(
            hear(&[], 6),
            Some((1, 5)),
            "of the last epoch before, not of one who is ahead and was never followed"
        );
        assert_eq!(hear(&[(1, 6)], 6), Some((1, 6)));
        assert_eq!(hear(&[(2, 0)], 6), Some((1, 6)));
        assert_eq!(hear(&[(1, 7)], 6), Some((1, 7)), "whom one follows is ahead of the goals for a moment");
        assert_eq!(hear(&[(3, 6)], 6), Some((3, 6)), "the goals' own epoch");
        assert_eq!(hear(&[], 7), Some((1, 7)));
    }
}
