//! What the run-time monitor says.

use crate::bench::{Bench, LAWS, PERIOD, formation, leader, make};
use trench_formation::kinematics::Pose;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use trench_msgs::msg::{LeaderState, RobotState, Stability};

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
