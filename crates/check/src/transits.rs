//! Where a segment has transits: places with several nearest points.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::curve::{Curve, Placed, Reach};
use trench_formation::kinematics::PointState;

const EQUATION: &str = "transits need places with several nearest points (Definition 7.2.1, Proposition 7.2.3)";
/// Nearest points nearer to each other than this share of their distance from the place are one, whose curvature makes the place.
const ONE: f64 = 0.05;

/// Whether nearest points of robots can have transits, and how far from the segment they begin; `robots` are at their starts.
pub(crate) fn transits(subject: &str, segment: &Placed<'_>, robots: &[PointState]) -> Verdict {
    let Some(reach) = segment.curve().reach() else {
        let finding = "the segment is straight: every place has one nearest point, there are no transits";
        return Verdict::new("transits", subject, true, finding, EQUATION);
    };
    let place = segment.point_to_map(reach.place);
    let beyond: Vec<String> = robots
        .iter()
        .enumerate()
        .filter(|(_, robot)| segment.nearest(robot.position).distance >= reach.distance)
        .map(|(index, _)| format!("r{}", index + 1))
        .collect();
    let who = match (robots.len(), beyond.len()) {
        (0, _) => String::new(),
        (_, 0) => ": all robots begin nearer than that".to_owned(),
        (all, count) if all == count => ": all robots begin there or farther out".to_owned(),
        _ => format!(": {} begin there or farther out", beyond.join(", ")),
    };
    Verdict::noted("transits", subject, format!("{}{who}", described(&reach, [place.x, place.y])), EQUATION)
}

/// The same of a queue's segment, wherever robots begin; nothing of straight ones.
pub(crate) fn of_segment(subject: &str, curve: &Curve) -> Option<Verdict> {
    let reach = curve.reach()?;
    let finding = format!("where nearest points draw robots, {}", described(&reach, [reach.place.x, reach.place.y]));
    Some(Verdict::noted("transits", subject, finding, EQUATION))
}

fn described(Reach { distance, feet: [one, other], .. }: &Reach, [x, y]: [f64; 2]) -> String {
    // A micrometre is nothing, and 0 reads better.
    let [x, y] = [x, y].map(|value| number(libm::round(value * 1e6) / 1e6 + 0.0));
    if *distance == 0.0 {
        let at = number(one.arc_length);
        return format!(
            "nearest points may jump, from the corner at {at} m on, at [{x}, {y}]: on its inner side all places of the bisector have two"
        );
    }
    let far = number(*distance);
    let (first, second) = (one.arc_length.min(other.arc_length), one.arc_length.max(other.arc_length));
    let made = if (one.point - other.point).norm() <= ONE * distance {
        format!("beyond [{x}, {y}], about the centre of curvature of the bend at {} m", number(first))
    } else {
        format!(
            "first at [{x}, {y}], where the points at {} m and {} m are equally near",
            number(first),
            number(second)
        )
    };
    format!("nearest points may jump {far} m or more from the segment, {made}")
}
