//! Formations that change under way.

use crate::bench::{Bench, FILE, ROBOTS, make, said};
use trench_core::Event;
use trench_msgs::diagnostic_msgs::DiagnosticStatus;
use trench_msgs::msg::{Assignment, Formation, Goal, Goals, RobotState, RunState};

#[test]
fn the_formation_changes_while_running_in_size_and_number() {
    let mut bench = Bench::running();
    let before: Formation = {
        let fresh = Bench::new(0.0, None);
        fresh.last("/formation").unwrap()
    };
    let answer = bench.set_formation("", 0.5, &["robot1", "robot2", "robot3"]);
    assert!(answer.success, "{answer:?}");
    let formation: Formation = bench.last("/formation").unwrap();
    let assignment: Assignment = bench.last("/assignment").unwrap();
    assert_ne!(formation.hash, before.hash);
    assert_eq!((assignment.formation_hash, assignment.epoch, assignment.members.len()), (formation.hash, 2, 3));
    bench.seconds += 0.1;
    bench.see(RobotState::STATUS_TRACKED);
    let goals: Goals = bench.last("/goals").unwrap();
    assert_eq!((goals.epoch, goals.goals.len()), (2, 3));
    let again = bench.set_formation("", 0.0, &[]);
    assert!(again.success && again.message.contains("already"), "{again:?}");
    assert!(bench.last::<Assignment>("/assignment").is_none(), "nothing flaps");
    let state: RunState = Bench::running().last("/run_state").unwrap();
    assert_eq!(state.state, RunState::RUNNING);
}

/// What a frame at this moment brings.
fn goals(bench: &mut Bench) -> Vec<Goal> {
    bench.out.take();
    bench.see(RobotState::STATUS_TRACKED);
    bench.last::<Goals>("/goals").unwrap().goals
}

#[test]
fn another_size_and_other_robots_go_on_where_they_are_on_their_way() {
    let mut bench = Bench::running();
    bench.seconds += 5.0;
    let whole = goals(&mut bench);
    assert!(whole.iter().all(|goal| goal.phase == Goal::PHASE_MOVING), "{whole:?}");
    let scaled = |goal: &Goal| {
        let smaller = |value: f64| 0.9 * value;
        let (place, speed) = (&goal.position, &goal.velocity);
        [smaller(place.x), smaller(place.y), smaller(speed.x), smaller(speed.y)]
    };
    let close = |goals: &[Goal], expected: &[[f64; 4]]| {
        let told = goals.iter().map(|goal| [goal.position.x, goal.position.y, goal.velocity.x, goal.velocity.y]);
        assert_eq!(goals.len(), expected.len());
        for (told, expected) in told.zip(expected) {
            assert!(told.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{told:?}, not {expected:?}");
        }
    };
    let expected: Vec<[f64; 4]> = whole.iter().map(scaled).collect();
    for twice in ["smaller", "asked for again"] {
        assert!(bench.set_formation("", 0.9, &[]).success);
        let smaller = goals(&mut bench);
        assert!(smaller.iter().all(|goal| goal.phase == Goal::PHASE_MOVING), "{twice}: {smaller:?}");
        close(&smaller, &expected);
    }
    assert!(bench.set_formation("", 0.0, &["robot1", "robot2", "robot3"]).success);
    let checkpoint = bench.checkpoint();
    close(&goals(&mut bench), &expected[..3]);
    let mut again = Bench::new(bench.seconds + 0.5, Some(checkpoint));
    bench.seconds += 0.5;
    assert_eq!(goals(&mut again), goals(&mut bench), "a process that is started again goes on, too");
    assert!(bench.set_formation("", 0.0, &["robot1", "robot2", "robot3", "robot4"]).success);
    assert_eq!(goals(&mut bench).len(), 4);
    assert!(bench.set_formation("", 1.0, &[]).success);
    let back = goals(&mut bench);
    assert!((back[0].velocity.x - whole[0].velocity.x).abs() < 1e-9, "{back:?}");
}

/// Robots of the last assignment with their queues, in order of name.
fn queues(bench: &Bench) -> Vec<(String, u32)> {
    let members = bench.assigned().members.into_iter();
    let mut queues: Vec<_> = members.map(|member| (member.robot, member.queue)).collect();
    queues.sort();
    queues
}

#[test]
fn another_formation_of_the_library_comes_by_its_name_for_as_many_robots_as_it_has_places() {
    let mut bench = Bench::running_with(&[("more_formations", "[config/formations/triangle.yaml]")]);
    let square = bench.assigned();
    bench.seconds += 5.0;
    assert!(goals(&mut bench).iter().all(|goal| goal.phase == Goal::PHASE_MOVING));
    bench.assignment = Some(square.clone());
    bench.out.take();
    let refused = bench.set_formation("triangle", 0.0, &[]);
    assert!(!refused.success && refused.message.contains("4 robots, but triangle has 3 places"), "{refused:?}");
    assert_eq!(said(&bench, "formation"), (DiagnosticStatus::WARN, refused.message.clone()));
    assert!(bench.last::<Formation>("/formation").is_none() && bench.last::<Assignment>("/assignment").is_none());
    let three = ["robot4", "robot1", "robot2"];
    let answer = bench.set_formation("triangle", 0.0, &three);
    assert!(answer.success, "{answer:?}");
    let formation: Formation = bench.last("/formation").unwrap();
    assert_eq!((formation.name.as_str(), formation.queues.len()), ("triangle", 3));
    let assignment = bench.assigned();
    assert_eq!((assignment.epoch, assignment.formation_hash), (square.epoch + 1, formation.hash));
    let taken = queues(&bench);
    assert_eq!(taken.iter().map(|(robot, _)| robot.as_str()).collect::<Vec<_>>(), ["robot1", "robot2", "robot4"]);
    let names: std::collections::BTreeSet<_> = taken.iter().map(|(_, queue)| *queue).collect();
    assert_eq!(names.len(), 3, "{taken:?}");
    bench.seconds += 0.1;
    bench.see(RobotState::STATUS_TRACKED);
    let goals: Goals = bench.last("/goals").unwrap();
    assert_eq!((goals.epoch, goals.goals.len()), (assignment.epoch, 3));
    assert!(goals.goals.iter().all(|goal| goal.phase == Goal::PHASE_APPROACH), "another shape sets out now");
    bench.assignment = Some(assignment);
    let answer = bench.set_formation("square", 0.0, &["robot1", "robot2", "robot3", "robot4"]);
    assert!(answer.success, "{answer:?}");
    assert_eq!((bench.assigned().epoch, bench.assigned().members), (square.epoch + 2, square.members));
}

#[test]
fn another_shape_may_come_as_a_message_if_it_has_places_for_all() {
    let message = |file: &str, robots: &str| -> Formation {
        let core = make(&[("formation_file", file), ("robots", robots)], None).unwrap();
        Bench::of(core, 0.0).last("/formation").unwrap()
    };
    let mut bench = Bench::running();
    let square = bench.assigned();
    bench.out.take();
    bench.assignment = Some(square.clone());
    bench.send("/set_formation", &message("config/formations/triangle.yaml", "[robot1]"));
    let (level, text) = said(&bench, "formation");
    assert_eq!(level, DiagnosticStatus::WARN);
    assert!(text.contains("4 robots, but triangle has 3 places"), "{text}");
    assert_eq!(bench.assigned(), square, "the old one stays");
    let diagonal = message("config/formations/diagonal.yaml", "[robot1]");
    bench.send("/set_formation", &diagonal);
    let now: Formation = bench.last("/formation").unwrap();
    assert_eq!((now.hash, now.queues.len()), (diagonal.hash, 1));
    let assignment = bench.assigned();
    assert_eq!((assignment.epoch, assignment.formation_hash), (square.epoch + 1, now.hash));
    // One chain now: each robot but the first follows another.
    let chain = assignment.members.iter().map(|member| member.leader.as_str()).collect::<Vec<_>>();
    assert_eq!((chain.len(), chain[0], chain[1..].contains(&"")), (4, "", false), "{chain:?}");
    let goals = |bench: &mut Bench| {
        bench.seconds += 0.1;
        bench.out.take();
        bench.see(RobotState::STATUS_TRACKED);
        assert!(bench.last::<Assignment>("/assignment").is_none(), "nothing flaps");
        bench.last::<Goals>("/goals").unwrap()
    };
    assert_eq!((goals(&mut bench).epoch, goals(&mut bench).goals.len()), (assignment.epoch, 4));
}

#[test]
fn a_formation_that_does_not_fit_is_refused_and_the_old_one_stays() {
    let mut bench = Bench::running();
    let mut refused = |name, scale, robots: &[&str], expected: &str| {
        let answer = bench.set_formation(name, scale, robots);
        assert!(!answer.success && answer.message.contains(expected), "{answer:?}");
        assert!(bench.last::<Formation>("/formation").is_none());
    };
    refused("star", 0.0, &[], "no formation is called star; there are square");
    refused("", -1.0, &[], "scale is -1");
    refused("", f64::NAN, &[], "scale is NaN");
    refused("", 0.0, &["robot1", "robot9"], "robot9 is none of the robots");
    refused("", 0.0, &["robot1", "robot1"], "robot1 is named twice");
    refused("", 0.0, &["robot1", "robot1"], "stays as it is");
    bench.see(RobotState::STATUS_TRACKED);
    assert_eq!(bench.last::<Goals>("/goals").unwrap().goals.len(), 4);
}

#[test]
fn a_formation_larger_than_the_field_is_refused() {
    let field = ("field", "[0.0, 0.0, 2.48, 1.83]");
    let mut bench = Bench::of(make(&[FILE, ROBOTS, field], None).unwrap(), 1.0);
    let answer = bench.set_formation("", 2.0, &[]);
    assert!(!answer.success && answer.message.contains("outside the field"), "{answer:?}");
    let small = ("field", "[0.0, 0.0, 1.0, 1.0]");
    assert!(make(&[FILE, ROBOTS, small], None).map(drop).unwrap_err().contains("outside the field"));
}

#[test]
fn a_formation_whose_bodies_would_overlap_is_refused() {
    let mut bench = Bench::running();
    let answer = bench.set_formation("", 0.1, &[]);
    assert!(!answer.success && answer.message.contains(" m apart: two bodies need 0.160 m"), "{answer:?}");
    let large = ("body.radius", "0.6");
    let refused = make(&[FILE, ROBOTS, large], None).map(drop).unwrap_err();
    assert!(refused.contains("formation_file") && refused.contains("two bodies need 1.200 m"), "{refused}");
}

#[test]
fn a_formation_may_come_as_a_message() {
    let mut bench = Bench::running();
    let mut formation: Formation = Bench::new(0.0, None).last("/formation").unwrap();
    formation.queues[0].tolerance = 0.05;
    bench.out.take();
    bench.send("/set_formation", &formation);
    let now: Formation = bench.last("/formation").unwrap();
    assert_eq!(now.queues[0].tolerance, 0.05);
    assert_ne!(now.hash, formation.hash, "the hash is of the content, whatever the sender wrote");
    formation.queues.clear();
    bench.out.take();
    bench.send("/set_formation", &formation);
    assert!(bench.last::<Formation>("/formation").is_none(), "a formation without segments changes nothing");
}

#[test]
fn a_changed_formation_outlives_the_process() {
    let mut died = Bench::running();
    assert!(died.set_formation("", 0.5, &["robot1", "robot2", "robot3"]).success);
    let held: Formation = died.last("/formation").unwrap();
    died.seconds += 1.0;
    died.handle(Event::Wakeup);
    let again = Bench::new(died.seconds + 1.0, Some(died.checkpoint()));
    assert_eq!(again.last::<Formation>("/formation").unwrap().hash, held.hash);
    assert_eq!(again.last::<Assignment>("/assignment").unwrap().members.len(), 3);
    assert_eq!(again.last::<RunState>("/run_state").unwrap().state, RunState::RUNNING);
}
