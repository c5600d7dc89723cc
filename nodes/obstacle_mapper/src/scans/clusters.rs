//! Cells near each other are one boundary, with an id that it keeps while it is seen.

use super::memory::{CELL, Memory, Place};
use super::walls;
use crate::sources::Known;
use std::collections::BTreeMap;
use trench_formation::Vector2;
use trench_formation::hull::Shape;

/// Ids of boundaries begin here: those of published obstacles are below.
const FIRST: u32 = 1 << 31;

/// What is known of a boundary, or of a piece of one.
#[derive(Debug, Clone)]
pub(crate) struct Boundary {
    pub(crate) known: Known,
    /// The wall that it is a piece of: pieces of one wall adjoin.
    pub(crate) wall: Option<usize>,
}

/// Cells that are to have one id: which, by how many votes.
struct Claim {
    votes: usize,
    id: u32,
    group: Vec<Place>,
    wall: Option<usize>,
}

/// Gives out ids.
#[derive(Debug, Default)]
pub(crate) struct Clusters {
    given: u32,
}

impl Clusters {
    /// The boundaries of all cells that are less than `gap` (m) apart: what is known of each is the hull of its points,
    /// grown by half a cell. One longer than `longest` (m) is a wall, and cut into pieces no thicker than `thickness` (m).
    /// Ascending ids.
    ///
    /// A boundary has the id that most of its cells had before; where two were one before, the larger keeps the id.
    pub(crate) fn find(&mut self, memory: &mut Memory, gap: f64, longest: f64, thickness: f64) -> Vec<Boundary> {
        let places: Vec<Place> = memory.cells.keys().copied().collect();
        let point = |place: &Place| memory.cells.get(place).map(|cell| cell.point);
        let mut groups: Vec<(Vec<Place>, Option<usize>)> = Vec::new();
        let mut walls = 0;
        for group in walls::groups(&places, gap) {
            if walls::is_wall(&group, longest) {
                let pieces = walls::cut(group, gap, thickness, &point);
                groups.extend(pieces.into_iter().map(|piece| (piece, Some(walls))));
                walls += 1;
            } else {
                groups.push((group, None));
            }
        }
        let claims = groups.into_iter().map(|(group, wall)| {
            let (votes, id) = claim(memory, &group);
            Claim { votes, id, group, wall }
        });
        let mut claims: Vec<Claim> = claims.collect();
        // Most cells first; equal ones in the order of their ids, then of their places.
        claims.sort_by(|a, b| b.votes.cmp(&a.votes).then(a.id.cmp(&b.id)).then_with(|| a.group.cmp(&b.group)));
        let mut boundaries: BTreeMap<u32, Boundary> = BTreeMap::new();
        for Claim { votes, id: wanted, group, wall } in claims {
            let is_free = votes > 0 && !boundaries.contains_key(&wanted);
            let id = if is_free { wanted } else { self.give() };
            let mut points = Vec::with_capacity(group.len());
            for place in &group {
                if let Some(cell) = memory.cells.get_mut(place) {
                    cell.id = id;
                    points.push(cell.point);
                }
            }
            if let Ok(shape) = Shape::enclosing(&points, 0.5 * CELL) {
                let known = Known { id, shape, velocity: Vector2::zeros() };
                boundaries.insert(id, Boundary { known, wall });
            }
        }
        boundaries.into_values().collect()
    }

    fn give(&mut self) -> u32 {
        // After two milliards of boundaries ids come again.
        self.given = self.given.wrapping_add(1) % FIRST;
        FIRST + self.given
    }
}

/// The id that most cells of a group have, with how many; the least of equals. (0, 0) where none has one.
fn claim(memory: &Memory, group: &[Place]) -> (usize, u32) {
    let mut votes: BTreeMap<u32, usize> = BTreeMap::new();
    for cell in group.iter().filter_map(|place| memory.cells.get(place)).filter(|cell| cell.id != 0) {
        *votes.entry(cell.id).or_default() += 1;
    }
    let most = votes.iter().max_by(|a, b| a.1.cmp(b.1).then(b.0.cmp(a.0)));
    most.map_or((0, 0), |(id, count)| (*count, *id))
}

/// For each place (ascending) the index that stands for its group: places less than `gap` m apart are in one group.
pub(super) fn connected(places: &[Place], gap: f64) -> Vec<usize> {
    let reach = (gap / CELL).ceil() as i32;
    let mut parents: Vec<usize> = (0..places.len()).collect();
    // Neighbours are in the next rows; in each row the first of them only ever moves on.
    let mut cursors = vec![0_usize; reach as usize + 1];
    for (index, &(row, column)) in places.iter().enumerate() {
        for (cursor, down) in cursors.iter_mut().zip(0..) {
            let below = row.saturating_add(down);
            while places.get(*cursor).is_some_and(|place| *place < (below, column.saturating_sub(reach))) {
                *cursor += 1;
            }
            for (other, place) in places.iter().enumerate().skip(*cursor) {
                if *place > (below, column.saturating_add(reach)) {
                    break;
                }
                let across = f64::from(place.1) - f64::from(column);
                let square = across * across + f64::from(down) * f64::from(down);
                if other != index && square * CELL * CELL < gap * gap {
                    let (a, b) = (root(&mut parents, index), root(&mut parents, other));
                    parents[a.max(b)] = a.min(b);
                }
            }
        }
    }
    (0..places.len()).map(|index| root(&mut parents, index)).collect()
}

fn root(parents: &mut [usize], mut node: usize) -> usize {
    while parents[node] != node {
        parents[node] = parents[parents[node]];
        node = parents[node];
    }
    node
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trench_core::Steady;

    fn line(memory: &mut Memory, at: f64, from: f64, to: f64) {
        let count = ((to - from) / 0.02) as i32;
        let points: Vec<_> = (0..=count).map(|step| Vector2::new(from + 0.02 * f64::from(step), 1.0)).collect();
        memory.see(Steady(0).plus_seconds(at), &points);
    }

    fn ids(clusters: &mut Clusters, memory: &mut Memory) -> Vec<u32> {
        clusters.find(memory, 0.15, 9.0, 0.2).iter().map(|found| found.known.id - FIRST).collect()
    }

    #[test]
    fn boundaries_keep_their_ids() {
        let (mut clusters, mut memory) = (Clusters::default(), Memory::default());
        line(&mut memory, 0.0, 0.0, 0.5);
        line(&mut memory, 0.0, 1.0, 1.2);
        assert_eq!(ids(&mut clusters, &mut memory), [1, 2]);
        // More is seen of both.
        line(&mut memory, 0.5, 0.4, 0.7);
        line(&mut memory, 0.5, 1.2, 1.3);
        assert_eq!(ids(&mut clusters, &mut memory), [1, 2]);
        // They turn out to be one: the larger one's id.
        line(&mut memory, 1.0, 0.7, 1.0);
        assert_eq!(ids(&mut clusters, &mut memory), [1]);
        // And come apart again, as the middle is forgotten: the larger part keeps it.
        line(&mut memory, 2.0, 0.0, 0.5);
        line(&mut memory, 2.0, 1.0, 1.2);
        memory.expire(Steady(0).plus_seconds(2.5), 1.0);
        assert_eq!(ids(&mut clusters, &mut memory), [1, 3]);
    }

    #[test]
    fn hulls_contain_their_points() {
        let (mut clusters, mut memory) = (Clusters::default(), Memory::default());
        line(&mut memory, 0.0, 0.0, 0.5);
        let known = &clusters.find(&mut memory, 0.15, 9.0, 0.2)[0].known;
        for x in [0.02, 0.25, 0.48] {
            assert!(known.shape.outline().approach(Vector2::new(x, 1.0)).gap <= 0.0);
        }
        assert!(known.shape.outline().approach(Vector2::new(0.25, 1.1)).gap > 0.05);
    }

    proptest! {
        #[test]
        fn groups_are_those_of_all_pairs(
            places in proptest::collection::btree_set((-20..20_i32, -20..20_i32), 0..60),
            gap in 0.05..0.4f64,
        ) {
            let places: Vec<Place> = places.into_iter().collect();
            let roots = connected(&places, gap);
            // Labels spread along all pairs until nothing changes.
            let mut labels: Vec<usize> = (0..places.len()).collect();
            loop {
                let before = labels.clone();
                for a in 0..places.len() {
                    for b in 0..places.len() {
                        let (rows, columns) = (places[a].0 - places[b].0, places[a].1 - places[b].1);
                        if libm::hypot(f64::from(rows), f64::from(columns)) * CELL < gap - 1e-12 {
                            labels[a] = labels[a].min(labels[b]);
                        }
                    }
                }
                if labels == before {
                    break;
                }
            }
            prop_assert_eq!(roots, labels);
        }
    }
}
