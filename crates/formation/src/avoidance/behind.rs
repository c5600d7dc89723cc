//! Where a robot that goes along a segment comes out behind the obstacles that lie on it.
use crate::curve::Placed;
use crate::hull::ApparentObstacle;

/// Points of the segment are looked at each so far, of the obstacles' reach.
const STRIDE: f64 = 0.25;
/// So far ahead of itself a robot looks for obstacles, of their reach: before one it rests within that.
const AHEAD: f64 = 2.0;
/// Longer ways than so many points are not looked at.
const MOST: u32 = 100_000;

/// The arc length (m) at which a robot that goes from arc length `from` (m) as far as `left` (m, with its sign) passes what keeps it from the
/// segment within `reach` (m) of apparent obstacles; nothing where the next stretch is free. Where obstacles cover all of the way, its end.
pub fn behind_obstacles(
    segment: &Placed<'_>,
    apparent: &[ApparentObstacle],
    reach: f64,
    (from, left): (f64, f64),
) -> Option<f64> {
    let near = |arc_length: &f64| is_near(segment, apparent, reach, *arc_length);
    let ahead = (AHEAD / STRIDE) as usize;
    let first = looked_at(reach, (from, left)).take(ahead + 1).position(|arc_length| near(&arc_length))?;
    let behind = looked_at(reach, (from, left)).skip(first).find(|arc_length| !near(arc_length));
    Some(behind.unwrap_or(from + left))
}

/// Whether apparent obstacles keep a robot from the segment, within `reach` (m), anywhere from arc length `from` (m) as far as `left` (m, with
/// its sign).
pub fn is_obstructed(
    segment: &Placed<'_>,
    apparent: &[ApparentObstacle],
    reach: f64,
    (from, left): (f64, f64),
) -> bool {
    looked_at(reach, (from, left)).any(|arc_length| is_near(segment, apparent, reach, arc_length))
}

/// Arc lengths (m) at which a way is looked at, both ends too.
fn looked_at(reach: f64, (from, left): (f64, f64)) -> impl Iterator<Item = f64> {
    let stride = STRIDE * reach;
    let count = libm::ceil(left.abs() / stride).min(f64::from(MOST)) as u32;
    (0..=count).map(move |index| from + (f64::from(index) * stride).min(left.abs()).copysign(left))
}

fn is_near(segment: &Placed<'_>, apparent: &[ApparentObstacle], reach: f64, arc_length: f64) -> bool {
    let point = segment.at(arc_length).point;
    apparent.iter().any(|obstacle| obstacle.shape.outline().approach(point).gap < reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector2;
    use crate::curve::{Curve, CurveShape};
    use crate::hull::{Obstacle, Shape, combine};
    use nalgebra::Isometry2;

    #[test]
    fn the_way_goes_on_behind_what_lies_on_it() {
        let line = CurveShape::Line(Vector2::new(0.0, 0.0), Vector2::new(20.0, 0.0));
        let curve = Curve::new(&line, false, false).unwrap();
        let segment = Placed::new(&curve, Isometry2::identity());
        let disc = |id: u32, x: f64| Obstacle { id, shape: Shape::new(&[Vector2::new(x, 0.5)], 1.0).unwrap() };
        let apparent = combine(&[disc(1, 8.0), disc(2, 11.0)], 0.0).unwrap();
        let behind = |from: f64, left: f64| behind_obstacles(&segment, &apparent, 1.0, (from, left));
        // Discs whose reach, 2 m about their middles, goes as far as 1.94 m along the segment.
        assert_eq!(behind(3.0, 15.0), None, "too far off to matter");
        assert!(behind(5.0, 13.0).is_some_and(|at| (12.93..13.2).contains(&at)), "both, as nobody rests between");
        assert!(behind(14.5, -14.0).is_some_and(|at| (5.8..6.07).contains(&at)), "the other way");
        assert_eq!(behind(12.95, 5.0), None);
        assert_eq!(behind(5.0, 4.0), Some(9.0), "the way ends before the obstacle does");
        assert_eq!(behind_obstacles(&segment, &[], 1.0, (5.0, 13.0)), None);
        let obstructed = |from: f64, left: f64| is_obstructed(&segment, &apparent, 1.0, (from, left));
        assert!(obstructed(3.0, 15.0) && obstructed(19.0, -15.0), "however far off");
        assert!(!obstructed(3.0, 3.0) && !obstructed(13.0, 6.0));
    }
}
