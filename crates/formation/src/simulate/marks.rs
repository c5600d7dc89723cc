//! A mark for each robot.

/// A bit for each.
#[derive(Debug, Clone, Default)]
pub(super) struct Marks(Vec<u64>);

impl Marks {
    /// None of `count` is marked.
    pub(super) fn clear(&mut self, count: usize) {
        self.0.clear();
        self.0.resize(count.div_ceil(64), 0);
    }

    #[inline]
    pub(super) fn set(&mut self, index: usize) {
        self.0[index / 64] |= 1 << (index % 64);
    }

    /// What is beyond all is not marked.
    #[inline]
    pub(super) fn get(&self, index: usize) -> bool {
        self.0.get(index / 64).is_some_and(|word| word & (1 << (index % 64)) != 0)
    }

    /// Marks those that `marks` has and `others` has not; all three are of as many robots.
    pub(super) fn mark_without(&mut self, marks: &Self, others: &Self) {
        for (word, (marks, others)) in self.0.iter_mut().zip(marks.0.iter().zip(&others.0)) {
            *word = marks & !others;
        }
    }

    /// Calls for each of `count` that is not marked, in order.
    pub(super) fn for_each_without(&self, count: usize, mut call: impl FnMut(usize)) {
        for (number, word) in self.0.iter().enumerate() {
            let first = 64 * number;
            let all = u64::MAX >> (64 - (count - first).min(64));
            let mut left = !word & all;
            while left != 0 {
                call(first + left.trailing_zeros() as usize);
                left &= left - 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_found_in_order() {
        let of = |indices: &[usize]| {
            let mut marks = Marks::default();
            marks.clear(130);
            indices.iter().for_each(|index| marks.set(*index));
            marks
        };
        let mut some = of(&[]);
        some.mark_without(&of(&[0, 1, 63, 64, 128, 129]), &of(&[1, 64]));
        let marked: Vec<usize> = (0..200).filter(|index| some.get(*index)).collect();
        assert_eq!(marked, [0, 63, 128, 129]);
        let mut others = Vec::new();
        some.for_each_without(130, |index| others.push(index));
        assert_eq!(others.len(), 126);
        assert!(others.is_sorted() && !others.iter().any(|index| some.get(*index)));
    }
}
