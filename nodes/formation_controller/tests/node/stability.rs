//! What the run-time monitor says.

use crate::bench::{Bench, LAWS, PERIOD, formation, leader, make};
use trench_formation::kinematics::Pose;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use trench_msgs::msg::{
    ApparentObstacle, ApparentObstacleArray, Assignment, LeaderState, Member, Obstacle, Point2, RobotState, Stability,
};

/// robot1 under `law`, a quarter turn away from its goal and off its segment.
fn under(law: &str) -> Bench {
    let mut bench = Bench::of(make(&[("team", "[robot1, robot2]"), ("law", law)]).unwrap());
    formation(&mut bench);
    bench.pose = Pose::new(1.0, 1.1, 1.2);
    bench
}

fn said(bench: &Bench) -> Vec<Stability> {
    bench.out.published(bench.port("/robot1/stability"))
}

/// The level of the part `stability` of the newest word on /diagnostics, and its text.
fn diagnosed(bench: &Bench) -> (u8, String) {
    let said: DiagnosticArray = bench.out.last(bench.port("/diagnostics")).unwrap();
    let stability = |status: &DiagnosticStatus| status.name.ends_with(": stability");
    said.status.into_iter().find(stability).map_or_else(Default::default, |status| (status.level, status.message))
}

#[test]
fn every_law_holds_for_a_robot_that_does_what_it_is_told() {
    for law in LAWS {
        let mut bench = under(law);
        for _ in 0..300 {
            leader(&mut bench);
            bench.drive(1);
        }
        let said = said(&bench);
        let broken = said.iter().find(|one| !one.holds || one.value > one.bound);
        assert_eq!(broken, None, "{law}");
        let (first, last) = (&said[0], &said[said.len() - 1]);
        assert!(last.value < 0.2 * first.value, "{law}: {first:?} {last:?}");
        assert!(said.iter().any(|one| one.sign < 0) && last.sign == 0, "{law}");
        assert!((90..=110).contains(&said.len()), "{law}: about ten words a second, not {}", said.len());
    }
}

/// (8.26) at run time: M_j = a |e_j| + b M_{j-1} with what the robot ahead says of itself; it never rises while that does not.
#[test]
fn the_queue_law_says_what_its_errors_stay_within() {
    let run = |bound_ahead: f64| {
        let mut bench = under("queue");
        let mut bounds = Vec::new();
        for _ in 0..300 {
            let mut state = LeaderState { epoch: 4, formation_hash: 7, rank: 1, ..Default::default() };
            state.header.stamp = bench.times().ros.into();
            state.point = trench_msgs::msg::Point2 { x: 1.9, y: 0.9 };
            state.error_bound = bound_ahead;
            bench.send("/robot2/leader_state", &state);
            bench.drive(1);
            let told: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
            bounds.push((told.error_bound, told.limited_by));
        }
        (said(&bench), bounds)
    };
    let (said, bounds) = run(0.0);
    assert!(said.iter().all(|one| one.error <= one.error_bound), "{said:?}");
    let falls = |pair: &[(f64, u8)]| pair[1].0 <= pair[0].0 || pair[0].1 != 0;
    assert!(bounds.windows(2).all(falls), "it rises only after limits have acted: {bounds:?}");
    let (first, last) = (&said[0], &said[said.len() - 1]);
    // K = (1, 2) has both poles at -1: P = [[1.5, 0.5], [0.5, 0.5]], a = sqrt(lmax/lmin) = 1 + sqrt 2.
    assert!((first.error_bound - (1.0 + 2.0_f64.sqrt()) * first.error).abs() < 1e-9, "{first:?}");
    assert!(last.error_bound < 0.1 * first.error_bound, "{last:?}");
    // b = 2 lmax^(3/2) mu / (theta lmin^(1/2)), mu = |B K| = sqrt 5, theta = 1/2.
    let (high, low) = (1.0 + 0.5_f64.sqrt(), 1.0 - 0.5_f64.sqrt());
    let gain = 4.0 * high.powf(1.5) * 5.0_f64.sqrt() / low.sqrt();
    let (with_errors_ahead, _) = run(0.25);
    let added = with_errors_ahead[0].error_bound - first.error_bound;
    assert!((added - 0.25 * gain).abs() < 1e-9, "{added} {gain}");
    let (unbounded, _) = run(f64::INFINITY);
    assert!(unbounded.iter().all(|one| one.error_bound == f64::INFINITY && one.holds));
}

/// Something carries the robot off that nobody told of: every law says so within a second, with its equation.
#[test]
fn a_robot_that_is_carried_off_is_reported_within_a_second() {
    for law in LAWS {
        let mut bench = under(law);
        for _ in 0..30 {
            leader(&mut bench);
            bench.drive(1);
        }
        let began = bench.seconds;
        while diagnosed(&bench).0 == 0 && bench.seconds < began + 2.0 {
            leader(&mut bench);
            bench.drive(1);
            bench.pose.y += 0.6 * PERIOD;
            bench.pose.x -= 0.6 * PERIOD;
        }
        let elapsed = bench.seconds - began;
        let (level, text) = diagnosed(&bench);
        let last = said(&bench).pop().unwrap();
        assert!(elapsed <= 1.0 && level == 2, "{law}: {elapsed} s, {text}");
        assert!(!last.holds && last.violation == text, "{last:?}");
        assert!(text.starts_with(&format!("robot1: {}: V = ", last.equation)), "{text}");
    }
}

#[test]
fn a_robot_that_does_not_obey_is_reported() {
    let mut bench = under("goal");
    for _ in 0..30 {
        bench.running();
        // The wheels turn as they are told, the vision sees the robot at rest.
        bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
        bench.seconds += PERIOD;
    }
    assert_eq!(diagnosed(&bench), (2, "robot1: (3.8): the robot has not followed its commands for a while".to_owned()));
}

#[test]
fn gains_that_the_operator_allowed_against_the_theory_stay_reported() {
    let overrides = [("law", "robust"), ("gains.k3", "50.0"), ("refuse_unstable_gains", "false")];
    let mut bench = Bench::of(make(&overrides).unwrap());
    bench.drive(3);
    let (level, text) = diagnosed(&bench);
    assert_eq!(level, 1);
    assert!(text.starts_with("robot1: (3.13): ") && text.contains("4.3.1"), "{text}");
}

/// A leader backs towards its follower, and faster than that may, until the follower is within zone 1, 0.2 m.
#[test]
fn a_robot_in_zone_1_is_reported_within_a_second() {
    let mut bench = under("chain");
    bench.pose = Pose::new(1.0, 0.9, 0.0);
    let (mut entered, mut told, mut gap) = (None, None, 0.4_f64);
    for _ in 0..90 {
        gap = (gap - 0.3 * PERIOD).max(0.13);
        let mut state = LeaderState { epoch: 4, formation_hash: 7, rank: 1, ..Default::default() };
        state.header.stamp = bench.times().ros.into();
        let steered = bench.pose.position() + 0.05 * bench.pose.heading();
        state.point = Point2 { x: steered.x + gap, y: steered.y };
        bench.send("/robot2/leader_state", &state);
        let now = bench.seconds;
        bench.drive(1);
        if gap < 0.2 {
            entered.get_or_insert(now);
        }
        let (level, text) = diagnosed(&bench);
        if level != 0 {
            told.get_or_insert(now);
            assert!(level == 1 && gap < 0.205, "{gap} m: {text}");
            let last = said(&bench).pop().unwrap();
            assert!(!last.holds && last.violation.starts_with("robot1: A.12 (i): 0.1"), "{last:?}");
            assert!(text.starts_with("robot1: A.12 (i): 0.1"), "{text}");
            assert!(text.ends_with(" m from robot2, within zone 1 of 0.2 m"), "{text}");
        }
    }
    let delay = told.unwrap() - entered.unwrap();
    assert!(delay <= 1.0, "{delay} s");
}

/// A tick of robot1, third in a chain: robot2, which it follows, rests in its neutral zone, and robot3 is at `other` (m) and says that it
/// rests.
fn third(bench: &mut Bench, other: [f64; 2]) {
    for (robot, rank, [x, y]) in [("robot2", 2, [1.35, 0.9]), ("robot3", 1, other)] {
        let mut state = LeaderState { epoch: 5, formation_hash: 7, rank, ..Default::default() };
        state.header.stamp = bench.times().ros.into();
        state.point = Point2 { x, y };
        bench.send(&format!("/{robot}/leader_state"), &state);
    }
    bench.drive(1);
}

/// A.18 has the robots ahead and the obstacles at rest: what they do otherwise than they say brings energy in, as much as their potentials
/// grow by it, and is no violation. Nor does it hide one: what else moves the robot is still told within a second.
#[test]
fn robots_ahead_that_come_otherwise_and_hulls_that_appear_are_inputs_and_hide_nothing() {
    // Ends of fragments would move besides.
    let overrides = [("team", "[robot1, robot2, robot3]"), ("law", "chain"), ("encroaching", "nothing")];
    let mut bench = Bench::of(make(&overrides).unwrap());
    formation(&mut bench);
    let member = |robot: &str, rank, leader: &str| Member {
        robot: robot.to_owned(),
        rank,
        leader: leader.to_owned(),
        ..Default::default()
    };
    let members = vec![member("robot3", 1, ""), member("robot2", 2, "robot3"), member("robot1", 3, "robot2")];
    bench.send("/assignment", &Assignment { epoch: 5, formation_hash: 7, members, ..Default::default() });
    bench.pose = Pose::new(1.0, 0.9, 0.0);
    (0..30).for_each(|_| third(&mut bench, [1.05, 1.5]));
    let quiet = said(&bench).pop().unwrap();

    // From the side robot3 comes into zone 2, faster than robot1 gives way.
    let mut gap = 0.4;
    while gap > 0.21 {
        gap -= 0.6 * PERIOD;
        third(&mut bench, [1.05, 0.9 + gap]);
    }
    (0..3).for_each(|_| third(&mut bench, [1.05, 0.9 + gap]));
    let pushed = said(&bench).pop().unwrap();
    assert!(pushed.value > quiet.value + 0.02 && pushed.term == "robots", "{quiet:?} {pushed:?}");
    assert!(said(&bench).iter().all(|one| one.holds && one.value <= one.bound), "{:?}", said(&bench));

    // A hull stands beside it that nobody knew of.
    (0..60).for_each(|_| third(&mut bench, [1.05, 1.5]));
    let before = said(&bench).pop().unwrap();
    let [x, y] = [bench.pose.x + 0.05, bench.pose.y - 0.17];
    let hull =
        [[x - 0.1, y], [x - 0.1, y - 0.1], [x + 0.1, y - 0.1], [x + 0.1, y]].map(|[x, y]| Point2 { x, y }).to_vec();
    bench.obstacles = ApparentObstacleArray {
        obstacles: vec![ApparentObstacle { id: 3, hull: hull.clone(), members: vec![3], ..Default::default() }],
        members: vec![Obstacle { id: 3, polygon: hull, ..Default::default() }],
        ..Default::default()
    };
    (0..5).for_each(|_| third(&mut bench, [1.05, 1.5]));
    let beside = said(&bench).pop().unwrap();
    assert!(beside.value > before.value + 0.01 && beside.term == "obstacles", "{before:?} {beside:?}");
    assert!(said(&bench).iter().all(|one| one.holds && one.value <= one.bound), "{:?}", said(&bench));

    // Carried off while robot3 comes again.
    let (began, mut gap) = (bench.seconds, 0.5);
    while diagnosed(&bench).0 < 2 && bench.seconds < began + 2.0 {
        gap = f64::max(gap - 0.3 * PERIOD, 0.21);
        let other = [bench.pose.x + 0.05, bench.pose.y + gap];
        third(&mut bench, other);
        bench.pose.y += 0.6 * PERIOD;
        bench.pose.x -= 0.6 * PERIOD;
    }
    let (elapsed, (level, text)) = (bench.seconds - began, diagnosed(&bench));
    assert!(elapsed <= 1.0 && level == 2 && text.starts_with("robot1: (7.13): V = "), "{elapsed} s: {text}");
}

/// The input that the monitor names as the greatest of the last ticks.
fn term(bench: &Bench) -> String {
    said(bench).pop().unwrap().term
}

/// What brings energy in is named, each time another input.
#[test]
fn the_responsible_term_is_named() {
    // Off its way, the robot is asked for more than its motors can do; once it is there nothing but the law acts.
    let mut driven = under("goal");
    let terms = |bench: &mut Bench, ticks: u32| -> std::collections::BTreeSet<String> {
        (0..ticks).map(|_| (bench.drive(1), term(bench)).1).collect()
    };
    let seen = terms(&mut driven, 60);
    assert!(seen.contains("limits") && seen.contains("law") && seen.len() == 2, "{seen:?}");
    driven.drive(300);
    assert_eq!(terms(&mut driven, 60), ["law".to_owned()].into());

    // The goal point jumps: what the frame does otherwise than was expected.
    let mut jumping = under("goal");
    jumping.drive(45);
    jumping.goal = Point2 { x: 1.5, y: 1.3 };
    jumping.drive(6);
    assert_eq!(term(&jumping), "frame");
    assert!(said(&jumping).iter().all(|one| one.holds), "an input is no violation");

    // The leader goes away with more energy of its own than all else brings in.
    let mut led = under("chain");
    led.pose = Pose::new(0.6, 0.9, 0.0);
    for tick in 0..20 {
        let mut state = LeaderState { epoch: 4, formation_hash: 7, rank: 1, lyapunov: 0.5, ..Default::default() };
        state.header.stamp = led.times().ros.into();
        state.point = Point2 { x: 1.3 + 0.15 * PERIOD * f64::from(tick), y: 0.9 };
        state.point_velocity = Point2 { x: 0.15, y: 0.0 };
        led.send("/robot2/leader_state", &state);
        led.drive(1);
    }
    assert_eq!(term(&led), "leader");

    // A wall across the way: the filter brakes.
    let mut stopped = under("goal");
    stopped.pose = Pose::new(1.0, 0.9, 0.0);
    let hull = [[1.25, 0.6], [1.35, 0.6], [1.35, 1.2], [1.25, 1.2]].map(|[x, y]| Point2 { x, y }).to_vec();
    stopped.obstacles = ApparentObstacleArray {
        obstacles: vec![ApparentObstacle { id: 3, hull: hull.clone(), members: vec![3], ..Default::default() }],
        members: vec![Obstacle { id: 3, polygon: hull, ..Default::default() }],
        ..Default::default()
    };
    let seen = terms(&mut stopped, 60);
    assert!(seen.contains("safety"), "{seen:?}");
}

#[test]
fn a_chain_that_is_no_coordinated_one_is_reported() {
    let mut bench = under("chain");
    bench.pose = Pose::new(0.1, 0.9, 0.0);
    leader(&mut bench);
    bench.drive(1);
    let (level, text) = diagnosed(&bench);
    assert_eq!(level, 1);
    assert!(text.starts_with("robot1: 6.2.2: ") && text.contains("robot2, beyond rho_bar = 1.2 m"), "{text}");
}
