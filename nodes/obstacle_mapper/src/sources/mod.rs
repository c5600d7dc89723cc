//! Who told of which obstacles.

mod known;
mod speaker;

pub(crate) use known::Known;

use speaker::Speaker;
use trench_core::Times;
use trench_msgs::msg::ObstacleArray;

/// The publishers of obstacles: a newer message of one replaces its older one.
#[derive(Default)]
pub(crate) struct Sources {
    speakers: Vec<Speaker>,
    /// How many publishers there have been: ids of the second one and later ones are moved, so that they need not agree.
    heard: u32,
    /// Publishers that are connected, once that is known.
    writers: Option<usize>,
}

impl Sources {
    /// Takes a message of the source `gid`; gives what was wrong with it.
    pub(crate) fn take(&mut self, at: Times, gid: [u8; 16], message: &ObstacleArray) -> Vec<String> {
        let index = self.speakers.iter().position(|speaker| speaker.gid == gid).unwrap_or_else(|| {
            self.speakers.push(Speaker::new(gid, self.heard, at));
            self.heard += 1;
            self.speakers.len() - 1
        });
        self.speakers[index].take(at, message)
    }

    /// The number of connected publishers changed.
    pub(crate) fn connected(&mut self, writers: usize) {
        self.writers = Some(writers);
    }

    /// Forgets the obstacles of publishers that have gone; whether any were forgotten.
    ///
    /// All that is known is how many are connected. Whoever is silent for much longer than it ever was has gone; of
    /// publishers that never had a rhythm nobody knows which has gone, and none is forgotten while one is left.
    pub(crate) fn forget(&mut self, at: Times) -> bool {
        let Some(writers) = self.writers else { return false };
        let before = self.speakers.len();
        while self.speakers.len() > writers {
            let gone = self.speakers.iter().enumerate().filter(|(_, speaker)| speaker.is_silent(at, writers == 0));
            let Some((index, _)) = gone.max_by(|a, b| a.1.silence(at).total_cmp(&b.1.silence(at))) else { break };
            self.speakers.remove(index);
        }
        self.speakers.len() < before
    }

    /// What is wrong if fewer than `needed` publishers have said something usable within `age` (s).
    pub(crate) fn silence(&self, at: Times, needed: usize, age: f64) -> Option<String> {
        let heard = self.speakers.iter().filter(|speaker| speaker.is_heard(at, age)).count();
        (heard < needed).then(|| {
            format!(
                "{heard} of {needed} publishers of /obstacles heard within {age} s: robots rest (sources, age.sources)"
            )
        })
    }

    /// Publishers whose obstacles are kept although as many have gone.
    pub(crate) fn orphans(&self) -> usize {
        self.writers.map_or(0, |writers| self.speakers.len().saturating_sub(writers))
    }

    /// What is wrong with the last message of each source.
    pub(crate) fn complaints(&self) -> impl Iterator<Item = &str> {
        self.speakers.iter().flat_map(|speaker| speaker.complaints.iter().map(String::as_str))
    }

    /// All obstacles where they are at `at`.
    pub(crate) fn at(&self, at: Times) -> impl Iterator<Item = Known> {
        self.speakers.iter().flat_map(move |speaker| speaker.at(at))
    }

    /// How many obstacles there are.
    pub(crate) fn len(&self) -> usize {
        self.speakers.iter().map(Speaker::len).sum()
    }
}

#[cfg(test)]
mod tests;
