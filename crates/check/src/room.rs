//! Whether a segment has room for a chain, beside obstacles.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::curve::{Curve, Interval};
use trench_formation::seek::Room;

const EQUATION: &str = "n places on the fragments, each rho_hat or more from all others (7.5.1)";
/// More places than these are not counted, unless there are as many robots.
const COUNTED: usize = 1000;

/// Whether the fragments have a place for every robot. On a segment that bends back, where places that were found and places that can be
/// are not the same, numbers between are noted: nothing is proved of them.
pub(crate) fn room(subject: &str, segment: &Curve, fragments: &[Interval], robots: usize, rho_hat: f64) -> Verdict {
    let apart = number(rho_hat);
    let enough = robots.max(COUNTED);
    if fragments.iter().any(|(from, to)| from.is_infinite() || to.is_infinite()) {
        let finding =
            format!("the queue is open and goes on for ever: {robots} robots have places, {apart} m from each other");
        return Verdict::new("room", subject, true, finding, EQUATION);
    }
    let Room { found, most } = Room::count(segment, fragments, rho_hat, enough);
    let length: f64 = fragments.iter().map(|(from, to)| to - from).sum();
    let on = format!("{} m in {} fragments", number(length), segment.count_fragments(fragments));
    if found >= robots {
        let more = if found == enough { " and more" } else { "" };
        let finding = format!("{on} have {found} places{more} for {robots} robots, {apart} m from each other");
        return Verdict::new("room", subject, true, finding, EQUATION);
    }
    if most >= robots {
        let finding = format!(
            "{on} have {found} places that were found and no more than {most}, {apart} m from each other: that {robots} robots fit is neither \
             proved nor refuted"
        );
        return Verdict::noted("room", subject, finding, EQUATION);
    }
    let places = if found == most {
        format!("{most} places")
    } else {
        format!("no more than {most} places ({found} were found)")
    };
    let finding = format!(
        "{on} have {places}, {apart} m from each other, but there are {robots} robots: lengthen the segment or move obstacles away"
    );
    Verdict::new("room", subject, false, finding, EQUATION)
}
