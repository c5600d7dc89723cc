//! The auxiliary lines of Fig. 7.13, with a steeper apex.
use super::Guard;
use crate::Vector2;
use crate::hull::Outline;

/// How far the lines are turned outward from the printed right angles, rad, and by how much more until they clear the obstacle.
/// At right angles a robot can rest on the ray from P0 through P1 or P2: there the repulsion of the line points at P0.
const TILT: f64 = 0.2;
const MORE: f64 = 0.1;
const MOST: f64 = 1.2;

/// Lines from the outermost corners of an obstacle, seen from `centre` (P0, the point that draws the robot), to an apex on the
/// robot's side. Nothing if the obstacle surrounds P0 or fills half the view.
pub fn auxiliary_lines(outline: &Outline<'_>, robot: Vector2<f64>, centre: Vector2<f64>) -> Option<Guard> {
    let axis = (robot - centre).try_normalize(0.0)?;
    let bearing = |corner: &Vector2<f64>| {
        let arm = corner - centre;
        (libm::atan2(axis.perp(&arm), axis.dot(&arm)), arm.norm())
    };
    let outermost = |side: f64| {
        let rank = |corner: &Vector2<f64>| {
            let (angle, distance) = bearing(corner);
            (side * angle, distance)
        };
        let better = |a: &(f64, f64), b: &(f64, f64)| a.0 > b.0 + 1e-9 || (a.0 > b.0 - 1e-9 && a.1 > b.1);
        outline
            .points
            .iter()
            .copied()
            .reduce(|best, corner| if better(&rank(&corner), &rank(&best)) { corner } else { best })
    };
    let ends = [outermost(-1.0)?, outermost(1.0)?];
    let mut tilt = TILT;
    while tilt < MOST {
        if let Some(apex) = apex(outline, centre, ends, tilt) {
            return Some(Guard { centre, ends, apex: Some(apex), radius: outline.radius });
        }
        tilt += MORE;
    }
    None
}

/// Where the two lines meet, if they have the obstacle behind them.
fn apex(outline: &Outline<'_>, centre: Vector2<f64>, ends: [Vector2<f64>; 2], tilt: f64) -> Option<Vector2<f64>> {
    let (sine, cosine) = libm::sincos(tilt);
    let line = |end: Vector2<f64>, side: f64| {
        let arm = (end - centre).normalize();
        cosine * side * Vector2::new(-arm.y, arm.x) + sine * arm
    };
    let (from_first, from_second) = (line(ends[0], 1.0), line(ends[1], -1.0));
    let crossing = from_first.perp(&from_second);
    let chord = ends[1] - ends[0];
    let (along_first, along_second) = (chord.perp(&from_second) / crossing, chord.perp(&from_first) / crossing);
    let behind = |corner: &Vector2<f64>| {
        let slack = 1e-9 * chord.norm();
        from_first.perp(&(corner - ends[0])) >= -slack && from_second.perp(&(corner - ends[1])) <= slack
    };
    let meets = crossing < 0.0 && along_first > 0.0 && along_second > 0.0;
    (meets && outline.points.iter().all(behind)).then(|| ends[0] + along_first * from_first)
}
