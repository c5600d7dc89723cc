//! Whether the chain leader can stand at a team goal among obstacles, all the time.

use crate::Verdict;
use crate::passing::MOMENTS;
use crate::verdict::number;
use trench_formation::hull::ApparentObstacle;
use trench_formation::simulate::ChainScenario;

const EQUATION: &str =
    "obstacles push within their cut, and with all their force within their pole: the team goal is beyond (7.12)";

/// How near a goal is to obstacles, and for whom.
struct Reach {
    /// Nearer than this nobody stands: the pole, or the body of a robot, m.
    none: f64,
    /// As far as obstacles push, m.
    cut: f64,
}

/// The obstacle that is nearest to a goal at a moment.
struct Near {
    /// s.
    time: f64,
    /// From the outline of its hull; negative inside, m.
    gap: f64,
    /// What it is, for people.
    name: String,
}

/// Judges a team goal among obstacles, with robots of the radius `body` (m). It fails where nobody can stand at it all the run; for a while, or
/// where r1 is but pushed off a little, makes a note. What passes within less than a two hundredth of the run may be missed.
pub(crate) fn goal_among_obstacles<T: Clone>(
    subject: &str,
    task: &ChainScenario<T>,
    body: f64,
    duration: f64,
) -> Option<Verdict> {
    let rests = !task.moves() && task.carriage.is_parked();
    let moments = if rests { 0 } else { MOMENTS };
    let at = |index: usize| duration * index as f64 / MOMENTS as f64;
    let all: Vec<Near> = (0..=moments).filter_map(|index| nearest(task, at(index))).collect();
    let reach = Reach { none: task.potential.pole().max(body), cut: task.potential.cut() };
    let closest = all.iter().min_by(|one, other| one.gap.total_cmp(&other.gap))?;
    let within = |limit: f64| all.iter().filter(move |near| near.gap < limit);
    let (first, last) = (within(reach.none).next(), within(reach.none).next_back());
    let away = reach.told(closest);
    let remedy = format!("move team_goal or the obstacle {} m apart", number(reach.cut - closest.gap));
    match (first, last) {
        (Some(first), Some(last)) => {
            if within(reach.none).count() == all.len() {
                return Some(Verdict::new(
                    "goal",
                    subject,
                    false,
                    format!("{away}: r1 is kept off; {remedy}"),
                    EQUATION,
                ));
            }
            let until =
                if last.time < at(moments) { format!("to {:.1} s", last.time) } else { "to the end".to_owned() };
            let finding = format!(
                "{away} at {:.1} s: from about {:.1} s {until} r1 is kept off; {remedy}",
                closest.time, first.time
            );
            Some(Verdict::noted("goal", subject, finding, EQUATION))
        }
        _ if closest.gap < reach.cut => {
            let when = if rests { String::new() } else { format!(" at {:.1} s", closest.time) };
            let finding = format!(
                "{away}{when}: it is pushed up to {} m off the outline, and r1 comes to rest beside the goal; {remedy}",
                number(reach.cut)
            );
            Some(Verdict::noted("goal", subject, finding, EQUATION))
        }
        _ => None,
    }
}

impl Reach {
    /// Where the goal is.
    fn told(&self, near: &Near) -> String {
        let Near { gap, name, .. } = near;
        let what = if self.none > 0.0 {
            format!("nobody stands within {} m of it", number(self.none))
        } else {
            "nobody stands in it".to_owned()
        };
        match *gap {
            gap if gap < 0.0 => format!("team_goal lies {} m inside {name}, and {what}", number(-gap)),
            gap if gap < self.none => format!("team_goal lies {} m from {name}, and {what}", number(gap)),
            gap => format!("team_goal lies {} m from {name}, which pushes", number(gap)),
        }
    }
}

/// The hull that is nearest to the goal at `time` (s); nothing where there is no goal, or no hull.
fn nearest<T: Clone>(task: &ChainScenario<T>, time: f64) -> Option<Near> {
    let goal = task.carriage.at(time).0.transform_point(&task.team_goal?.into()).coords;
    let hulls = task.combined(&task.obstacles_at(time).ok()?).ok()?;
    let near = |hull: &ApparentObstacle| Near { time, gap: hull.shape.outline().approach(goal).gap, name: named(hull) };
    hulls.iter().map(near).min_by(|one, other| one.gap.total_cmp(&other.gap))
}

/// Obstacles count from 1, in the order of the file.
fn named(hull: &ApparentObstacle) -> String {
    let members: Vec<String> = hull.members.iter().map(u32::to_string).collect();
    match &members[..] {
        [one] => format!("obstacle {one}"),
        _ => format!("the hull of obstacles {}", members.join(", ")),
    }
}
