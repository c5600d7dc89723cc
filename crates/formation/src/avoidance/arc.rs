//! The auxiliary arc of Fig. 7.12.
use super::Guard;
use crate::Vector2;
use crate::curve::Foot;
use crate::hull::{Outline, RepulsiveArea};

/// The arc over the face before which `robot` is caught, for a face (nearly) parallel to the segment at `foot`: its centre P0 is the
/// point of the segment's tangent that is equally far from both ends of the face. Nothing before corners, inside, or where
/// the segment runs across the face.
pub fn auxiliary_arc(outline: &Outline<'_>, robot: Vector2<f64>, foot: &Foot) -> Option<Guard> {
    let RepulsiveArea::Face(index) = outline.repulsive_area(robot) else { return None };
    let (mut first, mut second) = outline.face(index);
    let face = second - first;
    let crossing = foot.tangent.dot(&face);
    if crossing.abs() <= 1e-6 * face.norm() {
        return None;
    }
    let middle = 0.5 * (first + second);
    let centre = foot.point + foot.tangent * ((middle - foot.point).dot(&face) / crossing);
    let behind = face.perp(&(centre - middle)) * face.perp(&(robot - middle)) < 0.0;
    if (first - centre).perp(&(second - centre)) < 0.0 {
        core::mem::swap(&mut first, &mut second);
    }
    behind.then_some(Guard { centre, ends: [first, second], apex: None, radius: outline.radius })
}
