//! Robots to queues and places, teams to chains.

use nalgebra::Isometry2;
use std::collections::BTreeMap;
use trench_formation::Vector2;
use trench_formation::assignment::{AssignmentError, CostMatrix, Hysteresis, reassign, robots_per_queue};
use trench_formation::chain::{self, ChainError, Robot};
use trench_formation::curve::Placed;
use trench_msgs::msg::{Assignment, Member};
use trench_plan::Plan;

/// A new assignment must be shorter by this much, m^2 a robot, besides the relative margin.
const NOISE: f64 = 0.01;

/// Why robots get no places.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OrganiseError {
    /// No assignment.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
    /// No chain.
    #[error(transparent)]
    Chain(#[from] ChainError),
}

/// Who follows whom in a queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ChainOrder {
    /// The rule of 6.2.1: whoever is nearest to the robot ahead is next. Two robots abreast may have to change sides.
    #[default]
    Nearest,
    /// As the places that they got follow one another: ways are short, and seldom cross.
    Places,
}

/// How robots are seated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Seating {
    /// The present seats stay unless the best ones are shorter by this fraction.
    pub keep_margin: f64,
    /// The order of each queue.
    pub order: ChainOrder,
}

/// A robot with its place and its rank.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seated {
    /// Its name.
    pub robot: String,
    /// Index of its queue.
    pub queue: usize,
    /// Index of its place in the queue.
    pub place: usize,
    /// Its rank in the queue's chain, from 1.
    pub rank: usize,
    /// The robot ahead of it; none for the chain leader.
    pub leader: Option<String>,
}

impl Seated {
    /// Its line in an Assignment.
    #[must_use]
    pub fn member(&self) -> Member {
        Member {
            robot: self.robot.clone(),
            queue: self.queue as u32,
            rank: self.rank as u32,
            place: self.place as u32,
            leader: self.leader.clone().unwrap_or_default(),
        }
    }

    /// The seats an Assignment tells of; none if it does not fit the plan.
    #[must_use]
    pub fn of_assignment(plan: &Plan, assignment: &Assignment) -> Vec<Self> {
        let seat = |member: &Member| {
            let (queue, place) = (member.queue as usize, member.place as usize);
            let fits = plan.queues.get(queue).is_some_and(|queue| place < queue.places.len());
            let leader = (!member.leader.is_empty()).then(|| member.leader.clone());
            fits.then(|| Self { robot: member.robot.clone(), queue, place, rank: member.rank as usize, leader })
        };
        assignment.members.iter().map(seat).collect::<Option<Vec<_>>>().unwrap_or_default()
    }
}

/// Gives every robot (name and position, m, formation's frame) a place: queues get robots by their shares, places so that
/// the sum of squared distances to the starts of the virtual points is least. Ordered by queue, then rank.
///
/// # Errors
/// When there are more robots than places, or a position is not finite.
pub fn organise(
    plan: &Plan,
    robots: &[(String, Vector2<f64>)],
    present: &[Seated],
    seating: Seating,
) -> Result<Vec<Seated>, OrganiseError> {
    let open = open_places(plan, robots.len())?;
    let start = |&(queue, place): &(usize, usize)| {
        let queue = &plan.queues[queue];
        queue.curve.at(queue.places[place].start).point
    };
    let starts: Vec<Vector2<f64>> = open.iter().map(start).collect();
    let positions: Vec<Vector2<f64>> = robots.iter().map(|(_, position)| *position).collect();
    let costs = CostMatrix::squared_distances(&positions, &starts)?;
    let margin = Hysteresis { relative: seating.keep_margin, absolute: NOISE * robots.len() as f64 };
    let columns = reassign(&costs, &present_columns(robots, &open, present), margin)?;
    let seats: Vec<(usize, usize)> = columns.into_iter().map(|column| open[column]).collect();
    let chains = (0..plan.queues.len()).map(|queue| seated_chain(plan, queue, robots, &seats, seating.order));
    Ok(chains.collect::<Result<Vec<_>, _>>()?.concat())
}

/// The places that are filled when `robots` robots take part: of each queue as many as its share gives it, then whatever
/// is left of the others.
fn open_places(plan: &Plan, robots: usize) -> Result<Vec<(usize, usize)>, AssignmentError> {
    let shares: Vec<f64> = plan.queues.iter().map(|queue| queue.share).collect();
    let counts = robots_per_queue(&shares, robots)?;
    let filled = |queue: usize| counts[queue].min(plan.queues[queue].places.len());
    let queues = 0..plan.queues.len();
    let mut open: Vec<(usize, usize)> =
        queues.clone().flat_map(|queue| (0..filled(queue)).map(move |place| (queue, place))).collect();
    let missing = robots.saturating_sub(open.len());
    let places = |queue: usize| plan.queues[queue].places.len();
    let spare = queues.flat_map(|queue| (filled(queue)..places(queue)).map(move |place| (queue, place)));
    open.extend(spare.take(missing));
    Ok(open)
}

/// The columns that the present seats mean; none unless they seat exactly these robots on open places.
fn present_columns(robots: &[(String, Vector2<f64>)], open: &[(usize, usize)], present: &[Seated]) -> Vec<usize> {
    let column = |(name, _): &(String, Vector2<f64>)| {
        let seat = present.iter().find(|seat| seat.robot == *name)?;
        open.iter().position(|place| *place == (seat.queue, seat.place))
    };
    robots.iter().map(column).collect::<Option<_>>().unwrap_or_default()
}

/// The robots of one queue in their order.
fn seated_chain(
    plan: &Plan,
    queue: usize,
    robots: &[(String, Vector2<f64>)],
    seats: &[(usize, usize)],
    order: ChainOrder,
) -> Result<Vec<Seated>, OrganiseError> {
    let team = robots.iter().zip(seats).filter(|(_, seat)| seat.0 == queue);
    let places: BTreeMap<&str, usize> = team.clone().map(|((name, _), seat)| (name.as_str(), seat.1)).collect();
    let team: Vec<Robot<'_>> = team.map(|((name, position), _)| Robot { name, position: *position }).collect();
    let team_goal = plan.queues[queue].vertices.first().copied().unwrap_or_default();
    let segment = Placed::new(&plan.queues[queue].curve, Isometry2::identity());
    let chain = chain::organise(&team, team_goal, &segment)?;
    let mut names = chain.names().to_vec();
    if order == ChainOrder::Places {
        names.sort_by_key(|name| places.get(name.as_str()).copied());
    }
    let mut leader = None;
    let mut seated = Vec::with_capacity(team.len());
    for (index, robot) in names.iter().enumerate() {
        let next = leader.replace(robot.clone());
        // In a chain the rank is the place: nobody overtakes to a place further ahead.
        let place = match plan.queues[queue].chain {
            Some(_) => index,
            None => places.get(robot.as_str()).copied().unwrap_or_default(),
        };
        seated.push(Seated { robot: robot.clone(), queue, place, rank: index + 1, leader: next });
    }
    Ok(seated)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plan(name: &str) -> Plan {
        let path = format!("{}/../../config/formations/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        trench_plan::parse(&path, &std::fs::read_to_string(&path).unwrap()).unwrap()
    }

    fn team(points: &[(f64, f64)]) -> Vec<(String, Vector2<f64>)> {
        let robot = |(index, &(x, y)): (usize, &(f64, f64))| (format!("robot{}", index + 1), Vector2::new(x, y));
        points.iter().enumerate().map(robot).collect()
    }

    const SEATING: Seating = Seating { keep_margin: 0.2, order: ChainOrder::Nearest };

    /// Starts of experiment 2 (4.6).
    const SQUARE: [(f64, f64); 4] = [(0.15, 0.25), (0.95, 0.20), (0.20, 1.60), (0.90, 1.55)];

    #[test]
    fn the_square_of_4_6() {
        let seats = organise(&plan("square"), &team(&SQUARE), &[], SEATING).unwrap();
        let told: Vec<_> = seats.iter().map(|seat| (seat.robot.as_str(), seat.queue, seat.place, seat.rank)).collect();
        let expected = [("robot2", 0, 1, 1), ("robot1", 0, 0, 2), ("robot4", 1, 1, 1), ("robot3", 1, 0, 2)];
        assert_eq!(told, expected, "robots nearest to the vertex (1.275, ..) lead their chains");
        assert_eq!(seats[1].leader.as_deref(), Some("robot2"));
    }

    /// robot3 is nearer to robot1 than robot2 is, but farther from the second place: by 6.2.1 the two change sides.
    #[test]
    fn by_places_nobody_overtakes() {
        let robots = team(&[(0.0, 0.0), (-0.3, 0.5), (-0.55, 0.0), (-1.2, 0.0)]);
        let told = |order| -> Vec<String> {
            let seats = organise(&plan("column"), &robots, &[], Seating { order, ..SEATING }).unwrap();
            assert!(seats.iter().enumerate().all(|(index, seat)| seat.place == index && seat.rank == index + 1));
            assert!(seats.windows(2).all(|pair| pair[1].leader.as_ref() == Some(&pair[0].robot)));
            seats.into_iter().map(|seat| seat.robot).collect()
        };
        assert_eq!(told(ChainOrder::Nearest), ["robot1", "robot3", "robot2", "robot4"]);
        assert_eq!(told(ChainOrder::Places), ["robot1", "robot2", "robot3", "robot4"]);
    }

    #[test]
    fn noise_does_not_flap() {
        let plan = plan("square");
        // Two robots nearly as far from each other's places.
        let before = organise(&plan, &team(&[(0.9, 0.501), (0.9, 0.2), (0.2, 1.6), (0.9, 1.5)]), &[], SEATING).unwrap();
        let after =
            organise(&plan, &team(&[(0.901, 0.5), (0.899, 0.2), (0.2, 1.6), (0.9, 1.5)]), &before, SEATING).unwrap();
        let places = |seats: &[Seated]| -> Vec<_> {
            let mut all: Vec<_> = seats.iter().map(|seat| (seat.robot.clone(), seat.queue, seat.place)).collect();
            all.sort();
            all
        };
        assert_eq!(places(&before), places(&after));
    }

    #[test]
    fn more_robots_than_places_and_robots_nowhere() {
        let five = team(&[SQUARE.as_slice(), &[(1.0, 1.0)]].concat());
        assert!(organise(&plan("square"), &five, &[], SEATING).is_err());
        assert!(organise(&plan("square"), &team(&[(f64::NAN, 0.0)]), &[], SEATING).is_err());
    }

    #[test]
    fn fewer_robots_than_places() {
        let seats = organise(&plan("square"), &team(&SQUARE[..3]), &[], SEATING).unwrap();
        assert_eq!(seats.len(), 3);
    }

    #[test]
    fn an_assignment_tells_its_seats() {
        let plan = plan("triangle");
        let seats = organise(&plan, &team(&SQUARE[..3]), &[], SEATING).unwrap();
        let assignment = Assignment { members: seats.iter().map(Seated::member).collect(), ..Default::default() };
        assert_eq!(Seated::of_assignment(&plan, &assignment), seats);
        let mut foreign = assignment;
        foreign.members[0].queue = 9;
        assert!(Seated::of_assignment(&plan, &foreign).is_empty());
    }

    proptest! {
        #[test]
        fn everyone_has_a_place_of_their_own_and_a_rank(
            points in proptest::collection::vec((0.0..2.4_f64, 0.0..1.8_f64), 0..5), keep_margin in 0.0..1.0_f64,
            places in proptest::bool::ANY,
        ) {
            let seating = Seating { keep_margin, order: if places { ChainOrder::Places } else { ChainOrder::Nearest } };
            let plan = plan("square");
            let robots = team(&points);
            let seats = organise(&plan, &robots, &[], seating).unwrap();
            prop_assert_eq!(seats.len(), robots.len());
            let mut places: Vec<_> = seats.iter().map(|seat| (seat.queue, seat.place)).collect();
            places.sort_unstable();
            places.dedup();
            prop_assert_eq!(places.len(), robots.len());
            for pair in seats.windows(2).filter(|pair| pair[0].queue == pair[1].queue) {
                prop_assert_eq!(pair[1].rank, pair[0].rank + 1);
                prop_assert_eq!(pair[1].leader.as_ref(), Some(&pair[0].robot));
            }
            prop_assert_eq!(organise(&plan, &robots, &seats, seating).unwrap(), seats);
        }
    }
}
