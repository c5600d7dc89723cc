//! The way out of a combined hull that has closed around a robot (7.7, Fig. 7.14).
use crate::Vector2;
use crate::hull::Outline;
use core::cmp::Reverse;
use std::collections::BinaryHeap;

/// Costs of steps to neighbours of a grid, in tenths of a cell.
const STEPS: [(i64, i64, u32); 8] =
    [(1, 0, 10), (0, 1, 10), (-1, 0, 10), (0, -1, 10), (1, 1, 14), (-1, 1, 14), (-1, -1, 14), (1, -1, 14)];
/// Most cells along a side: beyond, cells grow.
const MOST_CELLS: f64 = 400.0;

/// Corners of a short way from `robot` to where the repulsion of `hull` ends, `cut` (m) from it; the last corner is there. The printed
/// "nearest point outside" may lie behind a wall of a member: this way keeps `body_radius` (m) from `walls`, the members' true
/// boundaries, but for its first steps where the robot is nearer. Nothing if there is no way out.
pub fn escape(
    hull: &Outline<'_>,
    walls: &[Outline<'_>],
    robot: Vector2<f64>,
    body_radius: f64,
    cut: f64,
) -> Option<Vec<Vector2<f64>>> {
    let grid = Grid::around(hull.points, robot, 0.5 * body_radius, hull.radius + cut);
    let gap = |point: Vector2<f64>| walls.iter().map(|wall| wall.approach(point).gap).fold(f64::INFINITY, f64::min);
    // Who is nearer than that to a wall may leave it.
    let nearer = gap(robot).min(body_radius);
    let is_free = |point: Vector2<f64>| {
        let gap = gap(point);
        gap >= body_radius || (gap >= nearer && (point - robot).norm() <= 2.0 * body_radius)
    };
    let cells = grid.search(&is_free, |point| hull.approach(point).gap >= cut)?;
    Some(straightened(robot, &cells, &grid, &is_free))
}

/// Corners of a short way from `robot` to `target` over points that are free, which may go `aside` (m) beyond both. Cells of a grid of
/// `size` (m) are looked at. Nothing if there is no way.
pub fn way_round(
    robot: Vector2<f64>,
    target: Vector2<f64>,
    (size, aside): (f64, f64),
    is_free: impl Fn(Vector2<f64>) -> bool,
) -> Option<Vec<Vector2<f64>>> {
    let grid = Grid::around(&[robot, target], robot, size, aside);
    let cells = grid.search(&is_free, |point| (point - target).norm() <= grid.size)?;
    let mut way = straightened(robot, &cells, &grid, &is_free);
    way.push(target);
    Some(way)
}

/// The corners of a way over cells that are needed if what is in sight is gone to straight.
fn straightened(
    robot: Vector2<f64>,
    cells: &[Vector2<f64>],
    grid: &Grid,
    is_free: &impl Fn(Vector2<f64>) -> bool,
) -> Vec<Vector2<f64>> {
    let mut way = Vec::new();
    let mut from = robot;
    let mut next = 0;
    while next < cells.len() {
        let visible = |cell: &Vector2<f64>| is_clear(from, *cell, 0.5 * grid.size, is_free);
        let farthest = cells.iter().rposition(visible).filter(|farthest| *farthest >= next).unwrap_or(next);
        from = cells[farthest];
        way.push(from);
        next = farthest + 1;
    }
    way
}

/// Whether the straight way is free, looked at every `stride` (m).
fn is_clear(from: Vector2<f64>, to: Vector2<f64>, stride: f64, is_free: &impl Fn(Vector2<f64>) -> bool) -> bool {
    let count = libm::ceil((to - from).norm() / stride).max(1.0);
    (1..=count as u32).all(|step| is_free(from + (to - from) * (f64::from(step) / count)))
}

/// Square cells; the robot is at the middle of one.
struct Grid {
    origin: Vector2<f64>,
    size: f64,
    columns: i64,
    rows: i64,
    start: (i64, i64),
}

impl Grid {
    /// Around `points` and the robot, which is inside, with `margin` (m) about the points; cells of `size` (m), larger if they would be too many.
    fn around(points: &[Vector2<f64>], robot: Vector2<f64>, size: f64, margin: f64) -> Self {
        let margin = Vector2::repeat(margin);
        let low = points.iter().fold(robot, |low, point| low.inf(&(point - margin)));
        let high = points.iter().fold(robot, |high, point| high.sup(&(point + margin)));
        let size = size.max((high - low).max() / MOST_CELLS);
        let cells = |length: f64| libm::ceil(length / size) as i64 + 1;
        let start = (cells(robot.x - low.x), cells(robot.y - low.y));
        let origin = robot - size * Vector2::new(start.0 as f64, start.1 as f64);
        let (columns, rows) = (start.0 + cells(high.x - robot.x) + 1, start.1 + cells(high.y - robot.y) + 1);
        Self { origin, size, columns, rows, start }
    }

    fn point(&self, (column, row): (i64, i64)) -> Vector2<f64> {
        self.origin + self.size * Vector2::new(column as f64, row as f64)
    }

    fn index(&self, (column, row): (i64, i64)) -> usize {
        (row * self.columns + column) as usize
    }

    /// Dijkstra's shortest way over free cells, without the start. Equal costs are settled by cell, so the way is always the same.
    fn search(
        &self,
        is_free: &impl Fn(Vector2<f64>) -> bool,
        is_out: impl Fn(Vector2<f64>) -> bool,
    ) -> Option<Vec<Vector2<f64>>> {
        let mut reached: Vec<Option<(u32, (i64, i64))>> = vec![None; (self.columns * self.rows) as usize];
        let mut queue = BinaryHeap::from([Reverse((0_u32, self.start))]);
        reached[self.index(self.start)] = Some((0, self.start));
        while let Some(Reverse((cost, cell))) = queue.pop() {
            if reached[self.index(cell)].is_some_and(|(least, _)| least < cost) {
                continue;
            }
            if is_out(self.point(cell)) {
                return Some(self.way_back(&reached, cell));
            }
            for (right, up, step) in STEPS {
                let next = (cell.0 + right, cell.1 + up);
                let inside = (0..self.columns).contains(&next.0) && (0..self.rows).contains(&next.1);
                if !inside || reached[self.index(next)].is_some_and(|(least, _)| least <= cost + step) {
                    continue;
                }
                if is_free(self.point(next)) {
                    reached[self.index(next)] = Some((cost + step, cell));
                    queue.push(Reverse((cost + step, next)));
                }
            }
        }
        None
    }

    fn way_back(&self, reached: &[Option<(u32, (i64, i64))>], mut cell: (i64, i64)) -> Vec<Vector2<f64>> {
        let mut way = Vec::new();
        while cell != self.start {
            way.push(self.point(cell));
            cell = reached[self.index(cell)].map_or(self.start, |(_, previous)| previous);
        }
        way.reverse();
        way
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A corner of two walls with a robot in it, 0.1 m from both, where ways keep 0.2 m.
    #[test]
    fn who_is_nearer_to_a_wall_than_ways_keep_may_leave_it() {
        let [corner, right, up] = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]].map(Vector2::from);
        let (floor, side, all) = ([corner, right], [corner, up], [corner, right, up]);
        let walls = [&floor, &side].map(|points| Outline { points, radius: 0.05 });
        let (hull, robot) = (Outline { points: &all, radius: 0.05 }, Vector2::new(0.15, 0.15));
        let way = escape(&hull, &walls, robot, 0.2, 0.3).unwrap();
        assert!(hull.approach(way[way.len() - 1]).gap >= 0.3, "{way:?}");
        let gap = |point: Vector2<f64>| walls.iter().map(|wall| wall.approach(point).gap).fold(f64::INFINITY, f64::min);
        assert!(is_clear(robot, way[0], 0.01, &|point| gap(point) >= 0.1 - 1e-9), "{way:?}");
        let mut corners = way.iter().zip(&way[1..]);
        assert!(corners.all(|(from, to)| is_clear(*from, *to, 0.01, &|point| gap(point) >= 0.2 - 1e-9)), "{way:?}");
        assert_eq!(escape(&hull, &walls, Vector2::new(0.04, 0.04), 0.2, 0.3).map(|_| ()), Some(()), "touching, too");
    }

    /// The way out begins behind the robot: a pocket whose mouth is on the side away from the target.
    #[test]
    fn a_way_may_begin_away_from_the_target() {
        let (robot, target) = (Vector2::zeros(), Vector2::new(3.0, 1.0));
        let is_free = |point: Vector2<f64>| {
            let in_front = (0.5..1.0).contains(&point.x) && point.y.abs() < 1.5;
            let beside = (-0.8..1.0).contains(&point.x) && (0.5..1.5).contains(&point.y.abs());
            !(in_front || beside)
        };
        let way = way_round(robot, target, (0.1, 2.0), is_free).unwrap();
        assert!(way[0].x < -0.8 && way.last() == Some(&target), "{way:?}");
        let corners = core::iter::once(&robot).chain(&way);
        assert!(corners.zip(&way).all(|(from, to)| is_clear(*from, *to, 0.01, &is_free)), "{way:?}");
        assert_eq!(way_round(robot, target, (0.1, 0.5), is_free), None, "no room to go round");
    }
}
