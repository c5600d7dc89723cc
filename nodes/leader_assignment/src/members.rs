//! Robots that quit and join during a run (A.22): the others keep their places, those behind close up in their chain.

use crate::organise::Seated;
use std::collections::BTreeMap;
use trench_formation::Vector2;
use trench_formation::assignment::robots_per_queue;
use trench_formation::chain::joining;
use trench_plan::Plan;

/// The seats without the robots that `gone` names (A.22, case 2.1): nobody gets another vertex; in a chain those behind move
/// up by one.
pub(crate) fn without(plan: &Plan, seats: &[Seated], gone: impl Fn(&str) -> bool) -> Vec<Seated> {
    renumbered(plan, seats.iter().filter(|seat| !gone(&seat.robot)).cloned().collect())
}

/// The seats with a robot more (A.22, case 2.2): in the queue whose share lacks one, the nearest of them. In a chain it takes
/// the place where it makes the chain longer by the least; otherwise the nearest free vertex. Nothing where all are taken. Shares are
/// those of a formation of `size` robots: all who will take part, so that several who come back at once each find their place.
pub(crate) fn with(
    plan: &Plan,
    seats: &[Seated],
    (robot, position): (&str, Vector2<f64>),
    others: &BTreeMap<String, Vector2<f64>>,
    size: usize,
) -> Option<Vec<Seated>> {
    let queue = queue_to_join(plan, seats, position, size.max(seats.len() + 1))?;
    let team: Vec<&Seated> = seats.iter().filter(|seat| seat.queue == queue).collect();
    let end = |place: usize| plan.queues[queue].curve.at(plan.queues[queue].places[place].end).point;
    let free = (0..plan.queues[queue].places.len()).filter(|place| team.iter().all(|seat| seat.place != *place));
    let place = free.min_by(|a, b| (end(*a) - position).norm().total_cmp(&(end(*b) - position).norm()))?;
    let goal = plan.queues[queue].vertices.first().copied().unwrap_or_default();
    // Who is not seen just now is no mark to go by.
    let seen: Vec<(usize, Vector2<f64>)> =
        (0..).zip(&team).filter_map(|(rank, seat)| Some((rank, *others.get(&seat.robot)?))).collect();
    let marks: Vec<Vector2<f64>> = seen.iter().map(|(_, position)| *position).collect();
    let before = seen.get(joining(position, goal, &marks)).map_or(team.len(), |(rank, _)| *rank);
    let seat = Seated { robot: robot.to_owned(), queue, place, rank: 0, leader: None };
    let at = seats.iter().filter(|seat| seat.queue < queue).count() + before;
    let mut all = seats.to_vec();
    all.insert(at.min(all.len()), seat);
    Some(renumbered(plan, all))
}

/// Of the queues with a free place the one nearest to the robot, those whose share of `size` robots lacks one before the others.
fn queue_to_join(plan: &Plan, seats: &[Seated], position: Vector2<f64>, size: usize) -> Option<usize> {
    let shares: Vec<f64> = plan.queues.iter().map(|queue| queue.share).collect();
    let filled: Vec<usize> =
        (0..shares.len()).map(|queue| seats.iter().filter(|seat| seat.queue == queue).count()).collect();
    let lacking = lacking(&shares, &filled, size)?;
    let away = |queue: usize| plan.queues[queue].curve.nearest(position).distance;
    let free = (0..plan.queues.len()).filter(|queue| filled[*queue] < plan.queues[*queue].places.len());
    free.min_by(|a, b| lacking[*b].cmp(&lacking[*a]).then(away(*a).total_cmp(&away(*b))))
}

/// Which queues may take a robot more of `size` without another having too few. Where a robot is left over between queues of
/// equal right to it (the first of two robots, with two equal queues), each of them may, so that it stays where it is.
fn lacking(shares: &[f64], filled: &[usize], size: usize) -> Option<Vec<bool>> {
    let mut whole: Vec<usize> = shares.iter().map(|share| (share * size as f64 + 1e-9) as usize).collect();
    let counts = robots_per_queue(shares, size).ok()?;
    let rest = |queue: usize| shares[queue] * size as f64 - whole[queue] as f64;
    let over = (0..shares.len()).filter(|queue| counts[*queue] > whole[*queue]);
    let least = over.map(rest).min_by(f64::total_cmp).unwrap_or(f64::INFINITY);
    let may_have_more: Vec<bool> = (0..shares.len()).map(|queue| rest(queue) >= least - 1e-9).collect();
    let left = size.saturating_sub(whole.iter().sum());
    let taken = (0..shares.len()).filter(|queue| filled[*queue] > whole[*queue]).count();
    if taken < left {
        whole.iter_mut().zip(may_have_more).for_each(|(count, more)| *count += usize::from(more));
    }
    Some(filled.iter().zip(whole).map(|(filled, count)| *filled < count).collect())
}

/// Ranks and leaders by the order in each queue; in a chain the rank is the place.
fn renumbered(plan: &Plan, mut seats: Vec<Seated>) -> Vec<Seated> {
    let mut last: Option<(usize, usize, String)> = None;
    for seat in &mut seats {
        let ahead = last.take().filter(|(queue, ..)| *queue == seat.queue);
        seat.rank = ahead.as_ref().map_or(1, |(_, rank, _)| rank + 1);
        seat.leader = ahead.map(|(.., robot)| robot);
        if plan.queues[seat.queue].chain.is_some() {
            seat.place = seat.rank - 1;
        }
        last = Some((seat.queue, seat.rank, seat.robot.clone()));
    }
    seats
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ChainOrder, Seating, organise};

    const SEATING: Seating = Seating { keep_margin: 0.2, order: ChainOrder::Nearest };

    fn plan(name: &str) -> Plan {
        let path = format!("{}/../../config/formations/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        trench_plan::parse(&path, &std::fs::read_to_string(&path).unwrap()).unwrap()
    }

    fn team(points: &[(f64, f64)]) -> Vec<(String, Vector2<f64>)> {
        let robot = |(index, &(x, y)): (usize, &(f64, f64))| (format!("robot{}", index + 1), Vector2::new(x, y));
        points.iter().enumerate().map(robot).collect()
    }

    fn told(seats: &[Seated]) -> Vec<(&str, usize, usize, &str)> {
        let leader = |seat: &Seated| seat.leader.as_deref().unwrap_or("").to_owned();
        let told = |seat| (seat, leader(seat));
        let told: Vec<(&Seated, String)> = seats.iter().map(told).collect();
        told.into_iter()
            .map(|(seat, leader)| {
                let leader = seats.iter().find(|other| other.robot == leader).map_or("", |other| other.robot.as_str());
                (seat.robot.as_str(), seat.rank, seat.place, leader)
            })
            .collect()
    }

    #[test]
    fn a_chain_closes_up_and_takes_a_robot_in_where_it_is() {
        let plan = plan("column");
        let robots = team(&[(-0.1, 0.0), (-0.5, 0.1), (-0.8, 0.0), (-1.2, 0.0)]);
        let seats = organise(&plan, &robots, &[], SEATING).unwrap();
        let three = without(&plan, &seats, |robot| robot == "robot2");
        let closed = [("robot1", 1, 0, ""), ("robot3", 2, 1, "robot1"), ("robot4", 3, 2, "robot3")];
        assert_eq!(told(&three), closed);
        let positions: BTreeMap<String, Vector2<f64>> = robots.into_iter().collect();
        let again = with(&plan, &three, ("robot2", positions["robot2"]), &positions, 4).unwrap();
        assert_eq!(again, seats, "it comes back where it was");
        let behind = with(&plan, &three, ("robot2", Vector2::new(-1.9, 0.3)), &positions, 4).unwrap();
        assert_eq!(told(&behind)[3], ("robot2", 4, 3, "robot4"));
        let ahead = with(&plan, &three, ("robot2", Vector2::new(0.05, 0.0)), &positions, 4).unwrap();
        assert_eq!(told(&ahead)[..2], [("robot2", 1, 0, ""), ("robot1", 2, 1, "robot2")]);
        assert_eq!(with(&plan, &seats, ("robot5", Vector2::zeros()), &positions, 5), None, "four places are taken");
    }

    #[test]
    fn at_vertices_everybody_stays() {
        let plan = plan("square");
        let robots = team(&[(0.15, 0.25), (0.95, 0.20), (0.20, 1.60), (0.90, 1.55)]);
        let seats = organise(&plan, &robots, &[], SEATING).unwrap();
        let positions: BTreeMap<String, Vector2<f64>> = robots.into_iter().collect();
        for robot in ["robot1", "robot2", "robot3", "robot4"] {
            let three = without(&plan, &seats, |name| name == robot);
            let kept = |seat: &Seated| seats.iter().any(|old| old.robot == seat.robot && old.place == seat.place);
            assert!(three.len() == 3 && three.iter().all(kept));
            let again = with(&plan, &three, (robot, positions[robot]), &positions, 4).unwrap();
            let place = |seats: &[Seated]| -> BTreeMap<String, (usize, usize)> {
                seats.iter().map(|seat| (seat.robot.clone(), (seat.queue, seat.place))).collect()
            };
            assert_eq!(place(&again), place(&seats), "{robot} gets its own place back");
        }
    }

    #[test]
    fn who_come_back_together_or_one_after_another_get_their_places_back() {
        let plan = plan("square");
        let robots = team(&[(0.15, 0.25), (0.95, 0.20), (0.20, 1.60), (0.90, 1.55)]);
        let seats = organise(&plan, &robots, &[], SEATING).unwrap();
        let end = |seat: &Seated| {
            let queue = &plan.queues[seat.queue];
            queue.curve.at(queue.places[seat.place].end).point
        };
        // They stand at their vertices.
        let positions: BTreeMap<String, Vector2<f64>> =
            seats.iter().map(|seat| (seat.robot.clone(), end(seat))).collect();
        let place = |seats: &[Seated]| -> BTreeMap<String, (usize, usize)> {
            seats.iter().map(|seat| (seat.robot.clone(), (seat.queue, seat.place))).collect()
        };
        for order in [[1, 2, 3, 4], [4, 3, 2, 1], [3, 1, 4, 2], [2, 4, 1, 3]] {
            for here in [4, 1] {
                let joined = order.iter().fold(Vec::new(), |seats, number| {
                    let robot = format!("robot{number}");
                    let size = here.max(seats.len() + 1);
                    with(&plan, &seats, (&robot, positions[&robot]), &positions, size).unwrap()
                });
                // One after another, the second goes where nobody is yet.
                let alike = order.iter().take(2).map(|number| {
                    let robot = format!("robot{number}");
                    seats.iter().find(|seat| seat.robot == robot).map(|seat| seat.queue)
                });
                let alike: Vec<_> = alike.collect();
                if here == 4 || alike[0] != alike[1] {
                    assert_eq!(place(&joined), place(&seats), "{order:?}, {here} here");
                }
            }
        }
    }

    #[test]
    fn shares_are_kept_and_ties_left_to_who_is_near() {
        let check = |shares: &[f64], filled: &[usize], size: usize, expected: &[bool]| {
            assert_eq!(lacking(shares, filled, size).unwrap(), expected, "{shares:?} {filled:?} of {size}");
        };
        check(&[0.5, 0.5], &[0, 0], 1, &[true, true]);
        check(&[0.5, 0.5], &[1, 0], 2, &[false, true]);
        check(&[0.5, 0.5], &[1, 1], 3, &[true, true]);
        check(&[0.5, 0.5], &[2, 1], 4, &[false, true]);
        check(&[0.5, 0.5], &[0, 0], 4, &[true, true]);
        let third = 1.0 / 3.0;
        check(&[third, third, third], &[2, 1, 0], 4, &[false, false, true]);
        check(&[0.75, 0.25], &[2, 0], 3, &[false, true]);
        check(&[0.75, 0.25], &[1, 1], 3, &[true, false]);
    }
}
