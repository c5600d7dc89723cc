//! Who is in a queue, and in which places (A.22).
use crate::Vector2;
use crate::chain::joining;

/// Robots by rank, each with its place: ranks have no gaps, places may.
#[derive(Debug, Clone)]
pub(super) struct Order(Vec<(usize, u32)>);

impl Order {
    /// Robots one behind the other.
    pub(super) fn new(members: impl Iterator<Item = usize>) -> Self {
        Self(members.zip(0..).collect())
    }

    /// Index and place of each robot, by rank.
    pub(super) fn members(&self) -> impl Iterator<Item = (usize, u32)> + '_ {
        self.0.iter().copied()
    }

    /// Rank of a robot, from 0 on.
    pub(super) fn rank(&self, robot: usize) -> Option<usize> {
        self.0.iter().position(|(index, _)| *index == robot)
    }

    /// Takes a robot out; those behind it close up, or keep their places. Whether it was there.
    pub(super) fn remove(&mut self, robot: usize, closes_up: bool) -> bool {
        let Some(rank) = self.rank(robot) else { return false };
        let (_, mut free) = self.0.remove(rank);
        for (_, place) in self.0[rank..].iter_mut().filter(|_| closes_up) {
            core::mem::swap(place, &mut free);
        }
        true
    }

    /// Puts a robot at `own` in where A.22 has it join, and tells its rank; `members` are the positions of the others by rank, `goal` the
    /// first place (all m). It takes the place behind the one ahead; of those behind it only as many give way as must.
    pub(super) fn join(
        &mut self,
        robot: usize,
        own: Vector2<f64>,
        goal: Vector2<f64>,
        members: &[Vector2<f64>],
    ) -> usize {
        let rank = joining(own, goal, members).min(self.0.len());
        let mut free = rank.checked_sub(1).map_or(0, |ahead| self.0[ahead].1 + 1);
        self.0.insert(rank, (robot, free));
        for (_, place) in &mut self.0[rank + 1..] {
            if *place > free {
                break;
            }
            free += 1;
            *place = free;
        }
        rank
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(members: &[(usize, u32)]) -> Order {
        Order(members.to_vec())
    }

    #[test]
    fn a_robot_that_quits_leaves_its_place_empty_or_not() {
        let mut kept = Order::new(0..4);
        assert!(kept.remove(1, false) && kept.0 == [(0, 0), (2, 2), (3, 3)]);
        assert!(!kept.remove(1, false));
        let mut closed = Order::new(0..4);
        assert!(closed.remove(1, true) && closed.0 == [(0, 0), (2, 1), (3, 2)]);
        // A gap farther behind stays one.
        let mut gap = order(&[(0, 0), (1, 1), (2, 4)]);
        assert!(gap.remove(0, true) && gap.0 == [(1, 0), (2, 1)]);
    }

    #[test]
    fn a_newcomer_takes_an_empty_place_or_moves_no_more_than_it_must() {
        let on_axis = |x: f64| Vector2::new(x, 0.0);
        let members = [-0.1, -1.0, -3.0].map(on_axis);
        let mut gap = order(&[(0, 0), (1, 1), (2, 3)]);
        assert_eq!(gap.join(9, on_axis(-1.8), on_axis(0.0), &members), 2);
        assert_eq!(gap.0, [(0, 0), (1, 1), (9, 2), (2, 3)]);
        let mut full = order(&[(0, 0), (1, 1), (2, 3)]);
        assert_eq!(full.join(9, on_axis(-0.5), on_axis(0.0), &members), 1);
        assert_eq!(full.0, [(0, 0), (9, 1), (1, 2), (2, 3)]);
        let mut none = order(&[]);
        assert_eq!((none.join(4, on_axis(2.0), on_axis(0.0), &[]), none.0), (0, vec![(4, 0)]));
    }
}
