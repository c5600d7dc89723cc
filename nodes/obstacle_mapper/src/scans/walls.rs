//! Long boundaries are walls: their hull would close the corridors along them (9.2, Fig. 9.1), so they are cut into pieces.

use super::clusters::connected;
use super::memory::{CELL, Place};
use std::collections::BTreeMap;
use trench_formation::Vector2;
use trench_formation::hull::Shape;

/// Edge of the largest piece, cells: 2.56 m. Pieces that are not flat are cut in four, and again.
const LARGEST: i32 = 64;
/// Edge of the smallest, cells.
const SMALLEST: i32 = 4;

/// Whether a boundary is longer than `longest` (m): a wall.
pub(super) fn is_wall(group: &[Place], longest: f64) -> bool {
    let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
    for &(row, column) in group {
        low = [low[0].min(row), low[1].min(column)];
        high = [high[0].max(row), high[1].max(column)];
    }
    let extent = |axis: usize| CELL * (f64::from(high[axis]) - f64::from(low[axis]));
    libm::hypot(extent(0), extent(1)) > longest
}

/// Cuts a wall (ascending places) into connected pieces whose hulls are no thicker than `thickness` (m). The cuts are along
/// lines of the map, so that pieces stay the same while more of the wall comes into sight.
pub(super) fn cut(
    wall: Vec<Place>,
    gap: f64,
    thickness: f64,
    point: &impl Fn(&Place) -> Option<Vector2<f64>>,
) -> Vec<Vec<Place>> {
    let is_flat = |piece: &[Place]| {
        let points: Vec<Vector2<f64>> = piece.iter().filter_map(point).collect();
        Shape::enclosing(&points, 0.0).is_ok_and(|shape| shape.width() <= thickness)
    };
    if is_flat(&wall) {
        return vec![wall];
    }
    let (mut pieces, mut open) = (Vec::new(), vec![(wall, LARGEST)]);
    while let Some((part, edge)) = open.pop() {
        let mut blocks: BTreeMap<Place, Vec<Place>> = BTreeMap::new();
        for place in part {
            blocks.entry((place.0.div_euclid(edge), place.1.div_euclid(edge))).or_default().push(place);
        }
        for piece in blocks.into_values().flat_map(|block| groups(&block, gap)) {
            if is_flat(&piece) || edge <= SMALLEST {
                pieces.push(piece);
            } else {
                open.push((piece, edge / 2));
            }
        }
    }
    pieces.sort();
    pieces
}

/// The connected groups of ascending places, each ascending.
pub(super) fn groups(places: &[Place], gap: f64) -> Vec<Vec<Place>> {
    let mut groups: BTreeMap<usize, Vec<Place>> = BTreeMap::new();
    for (place, root) in places.iter().zip(connected(places, gap)) {
        groups.entry(root).or_default().push(*place);
    }
    groups.into_values().collect()
}

#[cfg(test)]
mod tests {
    use crate::scans::clusters::{Boundary, Clusters};
    use crate::scans::memory::Memory;
    use trench_core::Steady;
    use trench_formation::Vector2;
    use trench_formation::hull::{Obstacle, combine_unless};

    const CLEARANCE: f64 = 0.2;

    /// What lasers saw of lines through corners, a point every 2 cm, as apparent obstacles.
    fn seen(lines: &[&[[f64; 2]]]) -> (Vec<Boundary>, Vec<trench_formation::hull::ApparentObstacle>) {
        let mut memory = Memory::default();
        for pair in lines.iter().flat_map(|line| line.windows(2)) {
            let (a, b) = (Vector2::from(pair[0]), Vector2::from(pair[1]));
            let steps = ((b - a).norm() / 0.02) as u32;
            let points: Vec<_> = (0..=steps).map(|step| a + (b - a) * f64::from(step) / f64::from(steps)).collect();
            memory.see(Steady(0), &points);
        }
        let found = Clusters::default().find(&mut memory, 0.15, 1.2, CLEARANCE);
        let obstacles: Vec<Obstacle> =
            found.iter().map(|one| Obstacle { id: one.known.id, shape: one.known.shape.clone() }).collect();
        let wall = |id: u32| found.iter().find(|one| one.known.id == id).and_then(|one| one.wall);
        let combined = combine_unless(&obstacles, CLEARANCE, |a, b| wall(a).is_some() && wall(a) == wall(b)).unwrap();
        (found, combined)
    }

    fn gap(apparent: &[trench_formation::hull::ApparentObstacle], x: f64, y: f64) -> f64 {
        let gaps = apparent.iter().map(|one| one.shape.outline().approach(Vector2::new(x, y)).gap);
        gaps.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_bent_corridor_stays_open() {
        // Half a metre wide, round a corner.
        let (found, apparent) = seen(&[&[[0.0, 2.5], [0.0, 0.0], [2.5, 0.0]], &[[0.5, 2.5], [0.5, 0.5], [2.5, 0.5]]]);
        assert_eq!(found.iter().filter_map(|one| one.wall).max(), Some(1), "two walls");
        for step in 0..=20 {
            let along = 0.25 + 0.1 * f64::from(step);
            // A robot of 0.16 m in the middle has room.
            for (x, y) in [(0.25, along), (along, 0.25)] {
                assert!(gap(&apparent, x, y) > 0.09, "({x}, {y}): {}", gap(&apparent, x, y));
            }
        }
        for (x, y) in [(0.0, 1.3), (1.7, 0.0), (0.5, 0.9), (0.0, 0.0), (0.5, 0.5)] {
            assert!(gap(&apparent, x, y) <= 0.0, "the walls themselves are there: ({x}, {y})");
        }
    }

    #[test]
    fn a_trap_is_closed_by_its_hull() {
        let (found, apparent) = seen(&[&[[0.5, 0.0], [0.0, 0.0], [0.0, 0.5], [0.5, 0.5]]]);
        assert_eq!((found.len(), found[0].wall, apparent.len()), (1, None, 1));
        assert!(gap(&apparent, 0.3, 0.25) < -0.1);
    }

    #[test]
    fn what_stands_at_a_wall_is_combined_with_its_piece() {
        let (_, apparent) = seen(&[&[[0.0, 0.0], [3.0, 0.0]], &[[1.0, 0.17], [1.1, 0.17]]]);
        assert_eq!(apparent.iter().filter(|one| one.members.len() > 1).count(), 1, "{apparent:?}");
        assert!(gap(&apparent, 1.05, 0.1) <= 0.0);
    }
}
