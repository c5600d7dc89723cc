//! Inputs that are nearly right.

use trench_sim::Random;

/// Inputs do not grow beyond this, bytes.
const MOST: usize = 200_000;

/// Numbers that are seldom thought of, as text and as bytes.
const WORDS: [&[u8]; 18] = [
    b"0",
    b"-1",
    b"1e308",
    b".nan",
    b".inf",
    b"-.inf",
    b"9223372036854775807",
    b"18446744073709551616",
    b"[]",
    b"{}",
    b"null",
    b"&a [*a]",
    b"\"\\u0000\"",
    b"$(var ",
    b"\xff\xff\xff\xff",
    b"\x00\x00\x00\x80",
    b"\x00",
    b"\t- ",
];

/// Draws mutations.
pub(crate) struct Mutator {
    random: Random,
}

impl Mutator {
    pub(crate) fn new(seed: u64) -> Self {
        Self { random: Random::new(seed, 77) }
    }

    fn below(&mut self, end: usize) -> usize {
        (self.random.unit() * end as f64) as usize
    }

    /// One of `corpus` with one to eight changes.
    pub(crate) fn mutate(&mut self, corpus: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = corpus[self.below(corpus.len())].clone();
        for _ in 0..=self.below(8) {
            self.change(&mut bytes, corpus);
        }
        bytes.truncate(MOST);
        bytes
    }

    fn change(&mut self, bytes: &mut Vec<u8>, corpus: &[Vec<u8>]) {
        let at = self.below(bytes.len() + 1);
        let end = (at + self.below(64)).min(bytes.len());
        match self.below(8) {
            0 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
            1 if at < bytes.len() => bytes[at] = self.below(256) as u8,
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(at..end)),
            4 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            5 => {
                let word = WORDS[self.below(WORDS.len())];
                bytes.splice(at..end.min(at + word.len()), word.iter().copied());
            }
            6 => {
                let other = &corpus[self.below(corpus.len())];
                let from = self.below(other.len() + 1);
                let to = (from + self.below(256)).min(other.len());
                bytes.splice(at..end, other[from..to].iter().copied());
            }
            _ => {
                let word = WORDS[self.below(WORDS.len())];
                bytes.splice(at..at, word.iter().copied());
            }
        }
    }
}
