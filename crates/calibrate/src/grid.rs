//! From corners in any order to the rows and columns of a board.

use std::collections::{BTreeMap, VecDeque};

/// How far a corner may be from where its neighbours expect it, of the distance between them.
const TOLERANCE: f64 = 0.3;
const STEPS: [[i32; 2]; 4] = [[1, 0], [-1, 0], [0, 1], [0, -1]];

type Cell = [i32; 2];

/// The corners of a board with `across` times `down` of them, row by row, columns and rows right-handed in the picture.
/// None unless they are all there.
pub(crate) fn order(points: &[[f64; 2]], [across, down]: [usize; 2]) -> Option<Vec<[f64; 2]>> {
    (0..points.len()).find_map(|seed| {
        let grown = grow(points, seed)?;
        complete(points, &grown, [across, down]).or_else(|| {
            // The board is held upright.
            let turned = grown.iter().map(|([i, j], point)| ([*j, -*i], *point)).collect();
            complete(points, &turned, [across, down])
        })
    })
}

/// Cells around a seed, each found where its neighbours expect it.
fn grow(points: &[[f64; 2]], seed: usize) -> Option<BTreeMap<Cell, usize>> {
    let [right, below] = axes(points, seed)?;
    let mut cells = BTreeMap::from([([0, 0], seed)]);
    // With each cell the steps to the next column and row there.
    let mut open = VecDeque::from([([0, 0], seed, [right, below])]);
    while let Some((cell, point, local)) = open.pop_front() {
        for step in STEPS {
            let next = [cell[0] + step[0], cell[1] + step[1]];
            if cells.contains_key(&next) {
                continue;
            }
            let (axis, sign) = if step[0] != 0 { (0, f64::from(step[0])) } else { (1, f64::from(step[1])) };
            let stride = local[axis].map(|along| sign * along);
            let [x, y] = points[point];
            let Some(found) = nearest(points, [x + stride[0], y + stride[1]]) else { continue };
            let off = [points[found][0] - x - stride[0], points[found][1] - y - stride[1]];
            if libm::hypot(off[0], off[1]) > TOLERANCE * libm::hypot(stride[0], stride[1])
                || cells.values().any(|taken| *taken == found)
            {
                continue;
            }
            let mut seen = local;
            seen[axis] = [sign * (points[found][0] - x), sign * (points[found][1] - y)];
            cells.insert(next, found);
            open.push_back((next, found, seen));
        }
    }
    Some(cells)
}

/// Steps to the next column and the next row at a corner: to its nearest neighbour, and to the nearest one across.
fn axes(points: &[[f64; 2]], seed: usize) -> Option<[[f64; 2]; 2]> {
    let [x, y] = points[seed];
    let mut others: Vec<[f64; 2]> =
        points.iter().enumerate().filter(|(index, _)| *index != seed).map(|(_, p)| [p[0] - x, p[1] - y]).collect();
    others.sort_by(|a, b| libm::hypot(a[0], a[1]).total_cmp(&libm::hypot(b[0], b[1])));
    let first = *others.first()?;
    let length = libm::hypot(first[0], first[1]);
    let cross = |other: &[f64; 2]| first[0] * other[1] - first[1] * other[0];
    let across = |other: &&[f64; 2]| cross(other).abs() > 0.7 * length * libm::hypot(other[0], other[1]);
    let second = *others.iter().take(8).find(across)?;
    let second = if cross(&second) > 0.0 { second } else { second.map(|along| -along) };
    Some([first, second])
}

fn nearest(points: &[[f64; 2]], [x, y]: [f64; 2]) -> Option<usize> {
    let distance = |index: &usize| libm::hypot(points[*index][0] - x, points[*index][1] - y);
    (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn complete(points: &[[f64; 2]], cells: &BTreeMap<Cell, usize>, [across, down]: [usize; 2]) -> Option<Vec<[f64; 2]>> {
    let low = [0, 1].map(|axis| cells.keys().map(|cell| cell[axis]).min().unwrap_or(0));
    let high = [0, 1].map(|axis| cells.keys().map(|cell| cell[axis]).max().unwrap_or(0));
    let fits = [(0, across), (1, down)].iter().all(|(axis, size)| (high[*axis] - low[*axis] + 1) as usize == *size);
    if !fits || cells.len() != across * down {
        return None;
    }
    let at = |index: usize| [low[0] + (index % across) as i32, low[1] + (index / across) as i32];
    (0..across * down).map(|index| cells.get(&at(index)).map(|point| points[*point])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_a_tilted_board_with_other_corners_around() {
        for angle in [0.0, 0.4, 1.2, 2.0, 3.5] {
            let (sin, cos) = libm::sincos(angle);
            let place = |index: usize| {
                let (i, j) = ((index % 6) as f64, (index / 6) as f64);
                let depth = 1.0 + 0.03 * i + 0.02 * j;
                [300.0 + 30.0 * (i * cos - j * sin) / depth, 200.0 + 30.0 * (i * sin + j * cos) / depth]
            };
            let board: Vec<[f64; 2]> = (0..24).map(place).collect();
            let mut all: Vec<[f64; 2]> = (0..24).map(|index| board[(7 * index) % 24]).collect();
            all.extend([[10.0, 10.0], [500.0, 30.0], [480.0, 400.0]]);
            let found = order(&all, [6, 4]).unwrap();
            let reversed: Vec<[f64; 2]> = board.iter().rev().copied().collect();
            assert!(found == board || found == reversed, "{angle}: {found:?}");
            assert_eq!(order(&all[..20], [6, 4]), None);
        }
    }
}
