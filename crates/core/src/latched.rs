//! The last word of each publisher of a latched topic.

/// A latched topic is said once and stays said: who speaks later, and may be a stranger, must not make it unsaid. So each
/// publisher's last word is kept, and the reader chooses by what else it hears.
#[derive(Debug, Clone)]
pub struct Latched<T> {
    /// The one that spoke last comes last.
    words: Vec<([u8; 16], T)>,
}

impl<T> Default for Latched<T> {
    fn default() -> Self {
        Self { words: Vec::new() }
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
}
