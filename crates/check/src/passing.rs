//! Whether obstacles that move leave a segment room while they do.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::curve::Placed;
use trench_formation::hull::Outline;
use trench_formation::seek::{Fragments, Room};
use trench_formation::simulate::ChainScenario;

const EQUATION: &str = "n places on the fragments at all times, each rho_hat or more from all others (7.5.1)";
/// Moments of a run that are looked at; when room is lost is found between two of them.
const MOMENTS: u32 = 200;
/// When room is lost is told to this, s.
const FINE: f64 = 1e-3;

/// Judges the run beyond its beginning, if obstacles or segment move: a segment that is without room at the end makes it fail, one that is so
/// for a while makes a note. What passes within less than a two hundredth of the run may be missed.
pub(crate) fn room_on_the_way<T: Clone>(subject: &str, task: &ChainScenario<T>, duration: f64) -> Option<Verdict> {
    if task.obstacles.is_empty() || !task.moves() && task.carriage.is_parked() {
        return None;
    }
    let robots = task.robots.len();
    let at = |index: u32| duration * f64::from(index) / f64::from(MOMENTS);
    let enough = |time: f64| places(task, time).is_none_or(|places| places >= robots);
    if !enough(0.0) {
        return None;
    }
    let lost = (1..=MOMENTS).find(|index| !enough(at(*index)));
    let Some(lost) = lost else {
        let finding = format!(
            "obstacles move: at {MOMENTS} moments up to {} s fragments may have places for {robots} robots",
            number(duration)
        );
        return Some(Verdict::new("room", subject, true, finding, EQUATION));
    };
    let since = between(at(lost - 1), at(lost), &enough);
    let (left, least) =
        (places(task, duration).unwrap_or(robots), (lost..=MOMENTS).filter_map(|index| places(task, at(index))).min());
    Some(if left < robots {
        let last_with = (1..=MOMENTS).rev().find(|index| enough(at(*index))).unwrap_or(lost - 1);
        let since = if last_with < lost { since } else { between(at(last_with), at(last_with + 1), &enough) };
        let finding = format!(
            "obstacles that move leave {} from {since:.2} s on to the end of the run: move them elsewhere, or lengthen the segment",
            few(left, robots)
        );
        Verdict::new("room", subject, false, finding, EQUATION)
    } else {
        let finding = format!(
            "obstacles that pass leave {} from {since:.2} s on for a while: robots that have no place wait until they have passed",
            few(least.unwrap_or(left), robots)
        );
        Verdict::noted("room", subject, finding, EQUATION)
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

/// How many robots find places at `time` (s), at most; none on queues that go on for ever, and where nobody can say.
fn places<T: Clone>(task: &ChainScenario<T>, time: f64) -> Option<usize> {
    let hulls = task.combined(&task.obstacles_at(time).ok()?).ok()?;
    let outlines: Vec<Outline<'_>> = hulls.iter().map(|obstacle| obstacle.shape.outline()).collect();
    let placed = Placed::new(&task.segment, task.carriage.at(time).0);
    let fragments = Fragments::find(&placed, task.segment.domain(), &outlines, task.potential.cut(), task.seeking.room);
    let intervals = fragments.intervals();
    if intervals.iter().any(|(from, to)| from.is_infinite() || to.is_infinite()) {
        return None;
    }
    Some(Room::count(&task.segment, intervals, task.zoning.radii().rho_hat, task.robots.len()).most)
}
