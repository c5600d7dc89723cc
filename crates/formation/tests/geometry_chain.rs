//! Chains: the order of Table 6.1, ties, and changes of the team.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::chain::{Chain, ChainError, Leader, Robot, joining, organise};
use trench_formation::curve::{Curve, CurveShape, Placed};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

const NAMES: [&str; 10] = ["r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8", "r9", "r10"];

fn organised(robots: &[Robot<'_>], goal: Vector2<f64>) -> Chain {
    let diagonal = Curve::new(&CurveShape::Line(at(-5.0, -5.0), at(100.0, 100.0)), false, false).unwrap();
    organise(robots, goal, &Placed::new(&diagonal, Isometry2::identity())).unwrap()
}

fn table_6_1() -> Vec<Robot<'static>> {
    let positions = [
        at(26.0026, 29.7094),
        at(27.8260, 19.8633),
        at(25.4281, 16.7758),
        at(14.8357, 21.3381),
        at(14.2419, 15.1141),
        at(13.7641, 8.8730),
        at(12.3089, 4.2053),
        at(9.7197, 1.0574),
        at(1.5191, 3.0657),
        at(0.7206, -1.0582),
    ];
    NAMES.iter().zip(positions).map(|(name, position)| Robot { name, position }).collect()
}

#[test]
fn table_6_1_by_the_rule() {
    let chain = organised(&table_6_1(), at(70.0, 70.0));
    assert_eq!(chain.names(), ["r1", "r2", "r3", "r5", "r4", "r6", "r7", "r8", "r9", "r10"]);
    assert_eq!(chain.leader("r1"), Some(Leader::TeamGoal));
    assert_eq!(chain.leader("r4"), Some(Leader::Robot("r5")));
    assert_eq!((chain.rank("r4"), chain.rank("r11"), chain.leader("r11")), (Some(5), None, None));
}

#[test]
fn ties_go_to_the_segment_then_to_the_name() {
    let lead = Robot { name: "z", position: at(10.0, 10.0) };
    // Both 5 from the leader; the second is nearer to the diagonal.
    let tied = [lead, Robot { name: "a", position: at(5.0, 10.0) }, Robot { name: "b", position: at(6.0, 7.0) }];
    assert_eq!(organised(&tied, at(20.0, 20.0)).names(), ["z", "b", "a"]);
    let mirrored = [lead, Robot { name: "b", position: at(7.0, 6.0) }, Robot { name: "a", position: at(6.0, 7.0) }];
    assert_eq!(organised(&mirrored, at(20.0, 20.0)).names(), ["z", "a", "b"]);
}

/// Joining looks along the pairs, ordering at the next robot alone: they agree but where the rule turns back.
#[test]
fn who_comes_back_to_the_chain_of_table_6_1_takes_its_place() {
    let (robots, goal) = (table_6_1(), at(70.0, 70.0));
    let place = |name: &str| robots.iter().find(|robot| robot.name == name).unwrap().position;
    let chain = organised(&robots, goal);
    for (index, name) in chain.names().iter().enumerate() {
        let others: Vec<_> = chain.names().iter().filter(|other| *other != name).map(|other| place(other)).collect();
        // The rule of 6.2.1 goes r3, r5, r4, back to r4: the chain is shorter, and as printed, with these two the other way round.
        let expected = match name.as_str() {
            "r4" => 3,
            "r5" => 4,
            _ => index,
        };
        assert_eq!(joining(place(name), goal, &others), expected, "{name}");
    }
}

#[test]
fn teams_that_cannot_be_ordered_are_refused() {
    let line = Curve::new(&CurveShape::Line(at(0.0, 0.0), at(1.0, 0.0)), false, false).unwrap();
    let placed = Placed::new(&line, Isometry2::identity());
    let robot = |name, x| Robot { name, position: at(x, 0.0) };
    let error = organise(&[robot("a", 0.0), robot("a", 1.0)], at(0.0, 0.0), &placed).unwrap_err();
    assert_eq!(error.to_string(), "two robots are named `a`: give each its own name");
    assert!(organise(&[robot("a", f64::NAN)], at(0.0, 0.0), &placed).is_err());
    assert_eq!(organise(&[], at(f64::NAN, 0.0), &placed), Err(ChainError::GoalNotFinite));
    assert!(organise(&[], at(0.0, 0.0), &placed).unwrap().names().is_empty());
}

proptest! {
    /// On a coarse grid, where ties abound.
    #[test]
    fn the_order_of_the_input_does_not_matter(
        cells in prop::collection::vec((0..4_u8, 0..4_u8), 1..10),
        turn in 0..10_usize,
        goal in (0..4_u8, 0..4_u8),
    ) {
        let robots: Vec<Robot<'_>> = cells
            .iter()
            .zip(NAMES)
            .map(|((x, y), name)| Robot { name, position: at(f64::from(*x), f64::from(*y)) })
            .collect();
        let goal = at(f64::from(goal.0), f64::from(goal.1));
        let chain = organised(&robots, goal);
        let mut turned = robots.clone();
        turned.reverse();
        turned.rotate_left(turn % robots.len());
        prop_assert_eq!(&organised(&turned, goal), &chain);
        let mut names = chain.names().to_vec();
        names.sort();
        let mut all: Vec<&str> = NAMES[..robots.len()].to_vec();
        all.sort_unstable();
        prop_assert_eq!(names, all, "each robot exactly once");
        let place = |name: &str| robots.iter().find(|robot| robot.name == name).unwrap().position;
        let mut last = goal;
        for (rank, name) in chain.names().iter().enumerate() {
            let distance = (place(name) - last).norm();
            prop_assert!(chain.names()[rank..].iter().all(|other| (place(other) - last).norm() >= distance - 1e-9));
            last = place(name);
        }
    }
}
