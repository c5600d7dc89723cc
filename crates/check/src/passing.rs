//! Whether obstacles that move leave a segment room while they do.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::curve::Placed;
use trench_formation::hull::Outline;
use trench_formation::seek::{Fragments, Room};
use trench_formation::simulate::ChainScenario;

const EQUATION: &str = "n places on the fragments at all times, each rho_hat or more from all others (7.5.1)";
/// Moments of a run that are looked at; when room is lost is found between two of them.
pub(crate) const MOMENTS: usize = 200;
/// When room is lost is told to this, s.
const FINE: f64 = 1e-3;

/// Judges the run beyond its beginning, if obstacles or segment move: a segment that is without room at the end makes it fail, one that is so
/// for a while makes a note. What passes within less than a two hundredth of the run may be missed.
pub(crate) fn room_on_the_way<T: Clone>(subject: &str, task: &ChainScenario<T>, duration: f64) -> Option<Verdict> {
    if task.obstacles.is_empty() || !task.moves() && task.carriage.is_parked() {
        return None;
    }
    let robots = task.robots.len();
    let at = |index: usize| duration * index as f64 / MOMENTS as f64;
    let counts: Vec<Option<usize>> = (0..=MOMENTS).map(|index| places(task, at(index))).collect();
    let is_room = |places: Option<usize>| places.is_none_or(|places| places >= robots);
    // When it is lost that a moment had and the next one has not.
    let lost_after = |index: usize| between(at(index), at(index + 1), &|time| is_room(places(task, time)));
    let first = counts.iter().position(|places| !is_room(*places));
    let (last_with, left) = (counts.iter().rposition(|places| is_room(*places)), counts[MOMENTS]);
    let Some(first) = first else {
        let finding = format!(
            "obstacles move: at {MOMENTS} moments up to {} s fragments may have places for {robots} robots",
            number(duration)
        );
        return Some(Verdict::new("room", subject, true, finding, EQUATION));
    };
    // Where it is not there at the beginning, another verdict says so.
    let before = first.checked_sub(1)?;
    Some(match left.filter(|left| *left < robots) {
        Some(left) => {
            let since = lost_after(last_with.unwrap_or(before));
            let finding = format!(
                "obstacles that move leave {} from {since:.2} s on to the end of the run: move them elsewhere, or lengthen the segment",
                few(left, robots)
            );
            Verdict::new("room", subject, false, finding, EQUATION)
        }
        None => {
            let (since, least) = (lost_after(before), counts[first..].iter().flatten().min());
            let finding = format!(
                "obstacles that pass leave {} from {since:.2} s on for a while: robots that have no place wait until they have passed",
                few(least.copied().unwrap_or(robots), robots)
            );
            Verdict::noted("room", subject, finding, EQUATION)
        }
    })
}

fn few(places: usize, robots: usize) -> String {
    match places {
        0 => "no qualified fragment".to_owned(),
        _ => format!("{places} places for {robots} robots"),
    }
}

/// When `holds` ceases to, between a time when it does and one when it does not, s.
fn between(mut with: f64, mut without: f64, holds: &impl Fn(f64) -> bool) -> f64 {
    while without - with > FINE {
        let middle = 0.5 * (with + without);
        if holds(middle) { with = middle } else { without = middle }
    }
    without
}

/// The segment's qualified fragments among the hulls of `time` (s); nothing where hulls cannot be combined.
pub(crate) fn fragments_at<T: Clone>(task: &ChainScenario<T>, time: f64) -> Option<Fragments> {
    let hulls = task.combined(&task.obstacles_at(time).ok()?).ok()?;
    let outlines: Vec<Outline<'_>> = hulls.iter().map(|obstacle| obstacle.shape.outline()).collect();
    let (placed, whole) = (Placed::new(&task.segment, task.carriage.at(time).0), task.segment.domain());
    Some(Fragments::find(&placed, whole, &outlines, task.potential.cut(), task.seeking.room))
}

/// How many robots find places at `time` (s), at most; none on queues that go on for ever, and where nobody can say.
fn places<T: Clone>(task: &ChainScenario<T>, time: f64) -> Option<usize> {
    let fragments = fragments_at(task, time)?;
    let intervals = fragments.intervals();
    if intervals.iter().any(|(from, to)| from.is_infinite() || to.is_infinite()) {
        return None;
    }
    Some(Room::count(&task.segment, intervals, task.zoning.radii().rho_hat, task.robots.len()).most)
}
