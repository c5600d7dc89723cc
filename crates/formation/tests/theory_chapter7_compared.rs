//! 7.8: the crevices of Fig. 7.15 under other methods.
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
use trench_formation::Vector2;
use trench_formation::avoidance::{ComparedRepulsion, WatchSettings};
use trench_formation::compared::{Course, Guide, InstantGoals, Outcome, Unguided, VirtualObstacles};

/// Two troughs that open towards the robot, with a crevice of 1.2 m between them.
fn course(goal_exponent: i32, strength: f64) -> Course {
    let corners = |xs: [f64; 2]| [[xs[0], 6.0], [xs[0], 3.0], [xs[1], 3.0], [xs[1], 6.0]].map(Vector2::from).to_vec();
    Course {
        goal: Vector2::new(-0.5, 0.0),
        obstacles: vec![corners([-6.0, -0.6]), corners([0.6, 4.0])],
        repulsion: ComparedRepulsion { strength, reach: 1.0, goal_exponent },
        pull: 10.0,
        damping: 5.0,
        watch: WatchSettings { radius: 0.1, patience: 1.0, arrived: 0.05 },
    }
}

fn drive(course: &Course, guide: &mut impl Guide, x: f64) -> Outcome {
    let outcome = course.drive(guide, Vector2::new(x, 12.0), 120.0, 1e-3).unwrap();
    println!("from x = {x}: {outcome:?}");
    outcome
}

#[test]
fn crevices_of_fig_7_15() {
    // From x = -2 the robot falls into the left trough.
    for (name, course) in [("conventional", course(0, 1.0)), ("Ge and Cui", course(2, 0.05))] {
        let outcome = drive(&course, &mut Unguided, -2.0);
        assert!(outcome.arrived.is_none() && outcome.position.y > 3.0, "{name}: {outcome:?}");
    }
    let recovered = drive(&course(0, 1.0), &mut VirtualObstacles::new(0.7), -2.0);
    assert!(recovered.arrived.is_some() && recovered.recoveries >= 1 && recovered.least_gap > 0.1, "{recovered:?}");
    let instant = drive(&course(0, 0.05), &mut InstantGoals::new(2.0, 0.7), -2.0);
    assert!(instant.arrived.is_some() && instant.least_gap > 0.1, "{instant:?}");
}
