//! What was learned, lesson by lesson, so that the last one can be taken back.

use trench_calibrate::{ColourError, Colours, Samples, learn_colours};

/// More than these say nothing new; the oldest are forgotten.
const MOST: usize = 64;

/// All lessons so far.
#[derive(Debug, Default)]
pub(super) struct Lessons(Vec<Samples>);

/// How many clicks or frames told of each colour.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Count {
    pub(super) yellow: usize,
    pub(super) blue: usize,
}

impl Lessons {
    pub(super) fn add(&mut self, samples: Samples) {
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(samples);
    }

    pub(super) fn take_back(&mut self) {
        self.0.pop();
    }

    pub(super) fn count(&self) -> Count {
        let of = |has: fn(&Samples) -> bool| self.0.iter().filter(|samples| has(samples)).count();
        Count { yellow: of(|samples| !samples.yellow.is_empty()), blue: of(|samples| !samples.blue.is_empty()) }
    }

    /// Limits from all of them; None while one of the colours is still unknown.
    pub(super) fn learn(&self) -> Option<Result<Colours, ColourError>> {
        let Count { yellow, blue } = self.count();
        if yellow == 0 || blue == 0 {
            return None;
        }
        let all = |of: fn(&Samples) -> &Vec<[u8; 3]>| self.0.iter().flat_map(of).copied().collect();
        Some(learn_colours(&Samples {
            yellow: all(|samples| &samples.yellow),
            blue: all(|samples| &samples.blue),
            rest: all(|samples| &samples.rest),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_colours_are_wanted_and_the_last_lesson_can_be_taken_back() {
        let mut lessons = Lessons::default();
        let lesson = |yellow: &[[u8; 3]], blue: &[[u8; 3]]| Samples {
            yellow: yellow.repeat(20),
            blue: blue.repeat(20),
            rest: vec![[150, 150, 145]; 100],
        };
        lessons.add(lesson(&[[235, 205, 45]], &[]));
        assert_eq!(lessons.learn(), None);
        lessons.add(lesson(&[], &[[35, 80, 200]]));
        let first = lessons.learn().unwrap().unwrap();
        // A click beside the disc: nothing can be told by it.
        lessons.add(lesson(&[[150, 150, 145]], &[]));
        assert_eq!(lessons.learn(), Some(Err(ColourError::Alike("yellow"))));
        lessons.take_back();
        assert_eq!((lessons.learn(), lessons.count()), (Some(Ok(first)), Count { yellow: 1, blue: 1 }));
        for _ in 0..100 {
            lessons.add(lesson(&[[235, 205, 45]], &[[35, 80, 200]]));
        }
        assert_eq!(lessons.count().yellow, MOST);
    }
}
