//! Whether robots with a safety filter begin as it assumes: their stopping ways are apart, from one another and from obstacles.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::Vector2;
use trench_formation::hull::Outline;
use trench_formation::kinematics::PointState;
use trench_formation::safety::{Line, Stopping};
use trench_formation::simulate::Neighbours;

const EQUATION: &str = "ways v^2/(2 a) to stop that are 2 R apart stay so (docs/theory/chapter7.md, \"The safety filter of accelerations\")";
/// Ways may touch, m.
const ROUNDING: f64 = 1e-9;
/// Bodies and ways are sought this much farther than they reach.
const WIDER: f64 = 1.01;

/// Moments of braking that are looked at.
const MOMENTS: u32 = 1000;

/// Somebody whose way to stop is too near another's, or an obstacle.
struct Short {
    who: String,
    /// Between bodies, m.
    gap: f64,
    /// m/s.
    closing: f64,
    /// What each needs to stop, m.
    ways: Vec<f64>,
    /// By which the ways are too near, m.
    missing: f64,
    /// Whether they touch though they brake at once.
    touch: bool,
}

/// Judges robots under one filter before obstacles that rest, by their ids. It fails where nobody can help touching; where ways are too near
/// but those who brake do not touch, it is a note.
pub(crate) fn stopping(
    subject: &str,
    filter: &Stopping,
    robots: &[PointState],
    obstacles: &[(u32, Outline<'_>)],
) -> Verdict {
    let longest = robots.iter().map(|robot| way(filter, robot)).fold(0.0, f64::max);
    let mut neighbours = Neighbours::default();
    neighbours.seek(WIDER * 2.0 * (filter.radius + longest), robots);
    let pairs = (0..robots.len())
        .flat_map(|index| neighbours.of(index).iter().map(move |other| (*other as usize, index)))
        .filter(|(one, other)| one < other)
        .filter_map(|pair| between(filter, robots, pair));
    let before = robots.iter().enumerate().flat_map(|(index, robot)| {
        obstacles.iter().filter_map(move |(id, outline)| before(filter, (index, robot), *id, outline))
    });
    let mut all: Vec<Short> = pairs.chain(before).collect();
    all.sort_by(|one, other| other.touch.cmp(&one.touch).then(other.missing.total_cmp(&one.missing)));
    let braking = number(filter.capability.acceleration);
    let Some(worst) = all.first() else {
        let finding = format!(
            "the filter keeps bodies of {} m apart, which brake with {braking} m/s^2: all {} begin with room to stop",
            number(filter.radius),
            robots.len()
        );
        return Verdict::new("stopping", subject, true, finding, EQUATION);
    };
    let others = match all.len() - 1 {
        0 => String::new(),
        more => format!(" (and {more} more)"),
    };
    let ways = worst.ways.iter().map(|way| number(*way)).collect::<Vec<_>>().join(" and ");
    let begins = format!(
        "{}{others}: {} m are between them, they close at {} m/s, and need {ways} m to stop with {braking} m/s^2",
        worst.who,
        number(worst.gap),
        number(worst.closing)
    );
    let missing = number(worst.missing);
    if worst.touch {
        let finding = format!(
            "{begins}; {missing} m are missing, and no filter keeps them apart: begin so much farther apart, or slower, or give \
             limits.acceleration more"
        );
        return Verdict::new("stopping", subject, false, finding, EQUATION);
    }
    let finding = format!(
        "{begins}. Braking at once they do not touch, but their ways are {missing} m too near each other for the filter, which promises nothing \
         then: begin so much farther apart, or slower"
    );
    Verdict::noted("stopping", subject, finding, EQUATION)
}

/// How far a robot goes until it stands, m.
fn way(filter: &Stopping, robot: &PointState) -> f64 {
    let [from, to] = filter.way(*robot);
    (to - from).norm()
}

/// Where a robot is that has braked for a time (s).
fn braked(filter: &Stopping, robot: &PointState, time: f64) -> Vector2<f64> {
    let (speed, braking) = (robot.velocity.norm(), filter.capability.acceleration);
    let time = time.min(speed / braking);
    // The mean velocity until then.
    let mean = if speed > 0.0 { (1.0 - 0.5 * braking * time / speed) * robot.velocity } else { robot.velocity };
    robot.position + time * mean
}

/// Whether two bodies touch though both brake at once.
fn touch(filter: &Stopping, a: &PointState, b: &PointState) -> bool {
    let lasting = a.velocity.norm().max(b.velocity.norm()) / filter.capability.acceleration;
    let apart = |time: f64| (braked(filter, a, time) - braked(filter, b, time)).norm();
    let moments = (0..=MOMENTS).map(|index| lasting * f64::from(index) / f64::from(MOMENTS));
    moments.map(apart).fold(f64::INFINITY, f64::min) < 2.0 * filter.radius
}

/// By how much a robot's way is beyond a line, m.
fn beyond(filter: &Stopping, robot: &PointState, line: &Line) -> f64 {
    filter.way(*robot).into_iter().map(|end| line.outward.dot(&end) - line.reach).fold(f64::NEG_INFINITY, f64::max)
}

fn between(filter: &Stopping, robots: &[PointState], (one, other): (usize, usize)) -> Option<Short> {
    let (a, b) = (&robots[one], &robots[other]);
    let own = beyond(filter, a, &filter.between(*a, *b)).max(0.0);
    let missing = own + beyond(filter, b, &filter.between(*b, *a)).max(0.0);
    let apart = b.position - a.position;
    (missing > ROUNDING).then(|| Short {
        who: format!("r{} and r{}", one + 1, other + 1),
        gap: apart.norm() - 2.0 * filter.radius,
        closing: closing(a.velocity - b.velocity, apart),
        ways: vec![way(filter, a), way(filter, b)],
        missing,
        touch: touch(filter, a, b),
    })
}

fn before(filter: &Stopping, (index, robot): (usize, &PointState), id: u32, outline: &Outline<'_>) -> Option<Short> {
    let approach = outline.approach(robot.position);
    let missing = beyond(filter, robot, &filter.before(*robot, outline));
    (missing > ROUNDING).then(|| Short {
        who: format!("r{} and obstacle {id}", index + 1),
        gap: approach.gap - filter.radius,
        closing: closing(robot.velocity, approach.towards),
        ways: vec![way(filter, robot)],
        missing,
        touch: true,
    })
}

/// How fast somebody with a velocity (m/s) comes nearer to what is `towards` it, m/s.
pub(crate) fn closing(velocity: Vector2<f64>, towards: Vector2<f64>) -> f64 {
    towards.try_normalize(0.0).map_or(0.0, |towards| velocity.dot(&towards))
}
