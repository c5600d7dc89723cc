//! The rule of 6.2.1: who leads, and who follows whom.
use super::{Chain, ChainError, Robot};
use crate::curve::Placed;
use nalgebra::Vector2;

/// Distances that differ by no more than this (m) are equal.
const TIE: f64 = 1e-9;

/// Orders a team: the robot nearest to the team goal leads, and each next one is the nearest to the one before it. Ties
/// go to the robot nearest to the segment, then to the first name in the alphabet (the protocol of arbitration that
/// 6.2.1 leaves open). The result does not depend on the order of `robots`.
///
/// # Errors
/// Positions that are not finite; two robots of one name.
pub fn organise(robots: &[Robot<'_>], goal: Vector2<f64>, segment: &Placed<'_>) -> Result<Chain, ChainError> {
    super::check(robots)?;
    if !(goal.x.is_finite() && goal.y.is_finite()) {
        return Err(ChainError::GoalNotFinite);
    }
    let mut left: Vec<Robot<'_>> = robots.to_vec();
    left.sort_by_key(|robot| robot.name);
    let (mut names, mut last) = (Vec::with_capacity(left.len()), goal);
    while !left.is_empty() {
        let next = left.remove(nearest(&left, last, segment));
        names.push(next.name.to_owned());
        last = next.position;
    }
    Ok(Chain { names })
}

/// Index of the robot nearest to `point`; `robots` is not empty and sorted by name.
fn nearest(robots: &[Robot<'_>], point: Vector2<f64>, segment: &Placed<'_>) -> usize {
    let distance = |robot: &Robot<'_>| (robot.position - point).norm();
    let least = robots.iter().map(distance).fold(f64::INFINITY, f64::min);
    let mut tied = (0..robots.len()).filter(|index| distance(&robots[*index]) <= least + TIE).peekable();
    let first = tied.next().unwrap_or(0);
    if tied.peek().is_none() {
        return first; // no tie, so the segment need not be asked
    }
    let mut best = (segment.nearest(robots[first].position).distance, first);
    for index in tied {
        let to_segment = segment.nearest(robots[index].position).distance;
        if to_segment < best.0 - TIE {
            best = (to_segment, index);
        }
    }
    best.1
}
