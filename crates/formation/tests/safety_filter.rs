//! The safety filter on simulated teams: no contact, and no standing still for ever.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
mod safety_bench;

use core::f64::consts::{PI, TAU};
use nalgebra::Vector2;
use safety_bench::{Bed, HALF_AXLE, MARGIN, RADIUS, Random, Robot, random_team, random_team_under_way};
use trench_formation::hull::Outline;
use trench_formation::kinematics::{Pose, Twist};
use trench_formation::safety::{
    Constraint, MovingOutline, Neighbour, SafetyFilter, SafetyParameters, Scene, Side, Wish,
};

const MIDDLE: Vector2<f64> = Vector2::new(1.24, 0.915);

/// Runs until all have arrived or `seconds` have passed; the least gap seen and the time needed.
fn run(bed: &mut Bed<'_>, seconds: u32) -> (f64, Option<f64>) {
    let mut least = bed.least_gap();
    for now in 0..seconds * 1000 {
        bed.step();
        least = least.min(bed.least_gap());
        if now % 100 == 0 && bed.all_arrived() {
            return (least, Some(f64::from(now) / 1000.0));
        }
    }
    (least, None)
}

/// Least gap over all seeds, and the seeds of teams that did not arrive within a minute.
fn survey(count: usize, seeds: core::ops::Range<u64>) -> (f64, Vec<u64>) {
    let (mut least, mut late) = (f64::INFINITY, Vec::new());
    for seed in seeds {
        let period = 30 + u32::try_from(seed % 11).unwrap();
        let mut bed = Bed::new(random_team(seed, count), period, 60);
        let (gap, time) = run(&mut bed, 60);
        least = least.min(gap);
        if time.is_none() {
            late.push(seed);
        }
    }
    (least, late)
}

#[test]
fn random_teams_never_touch() {
    for count in [2, 3, 5, 6, 7, 8] {
        let (least, late) = survey(count, 0..60);
        assert!(least > 0.5 * MARGIN, "{count} robots came within {least} m");
        assert!(late.len() <= 2, "{count} robots were late with seeds {late:?}");
    }
}

/// From poses and speeds anywhere, if only there was room to stop.
#[test]
fn random_teams_under_way_never_touch() {
    let (mut late, mut running) = (Vec::new(), 0);
    for count in 2..=8 {
        for seed in 0..60 {
            let team = random_team_under_way(seed, count, 0.1);
            running += team.iter().filter(|robot| robot.twist() != Twist::ZERO).count();
            let mut bed = Bed::new(team, 33, 60);
            let (gap, time) = run(&mut bed, 60);
            assert!(gap > 0.0, "{count} robots, seed {seed}: contact ({gap} m)");
            late.extend(time.is_none().then_some((count, seed)));
        }
    }
    assert!(running > 1000, "{running} robots alone were under way");
    assert!(late.len() <= 14, "late: {late:?}");
}

#[test]
fn four_robots_arrive() {
    let (least, late) = survey(4, 0..1000);
    assert!(least > 0.5 * MARGIN, "{least}");
    assert!(late.len() <= 1, "at least 99.9 % arrive; these did not: {late:?}");
}

/// `count` robots on a circle, each facing its goal on the other side.
fn ring(count: u32, radius: f64) -> Vec<Robot> {
    let place = |i| {
        let angle = TAU * f64::from(i) / f64::from(count);
        let arm = radius * Vector2::new(libm::cos(angle), libm::sin(angle));
        Robot::new(Pose::new(MIDDLE.x + arm.x, MIDDLE.y + arm.y, angle + PI), MIDDLE - arm)
    };
    (0..count).map(place).collect()
}

#[test]
fn symmetric_crossings_resolve() {
    for count in 2..=8 {
        let (least, time) = run(&mut Bed::new(ring(count, 0.7), 33, 60), 30);
        assert!(least > 0.5 * MARGIN && time.is_some(), "{count} robots: {least} {time:?}");
    }
}

#[test]
fn head_on_robots_keep_right() {
    let mut bed = Bed::new(ring(2, 0.7), 33, 60);
    let mut lowest = f64::INFINITY;
    while !bed.all_arrived() && bed.now < 20_000 {
        bed.step();
        lowest = lowest.min(bed.robots[1].pose.y);
    }
    assert!(bed.all_arrived());
    assert!(lowest < MIDDLE.y - 0.05, "the robot that drives along +x passes at lower y");
}

#[test]
fn a_robot_at_rest_is_passed() {
    let resting = Robot::new(Pose::new(MIDDLE.x, MIDDLE.y, 0.0), MIDDLE);
    let passing = Robot::new(Pose::new(0.3, MIDDLE.y, 0.0), Vector2::new(2.2, MIDDLE.y));
    let (least, time) = run(&mut Bed::new(vec![resting, passing], 33, 60), 30);
    assert!(least > 0.5 * MARGIN && time.is_some(), "{least} {time:?}");
}

#[test]
fn a_goal_under_a_resting_robot_is_approached() {
    let resting = Robot::new(Pose::new(MIDDLE.x, MIDDLE.y, 0.0), MIDDLE);
    let coming = Robot::new(Pose::new(0.3, MIDDLE.y, 0.0), MIDDLE);
    let mut bed = Bed::new(vec![resting, coming], 33, 60);
    let (least, time) = run(&mut bed, 20);
    assert!(least > 0.5 * MARGIN && time.is_none());
    assert!((bed.robots[1].pose.position() - MIDDLE).norm() < 2.0 * RADIUS + MARGIN + 0.02);
    assert!(bed.robots[1].twist().v.abs() < 0.01);
}

#[test]
fn an_obstacle_is_passed() {
    let corners = [Vector2::new(1.1, 0.6), Vector2::new(1.4, 0.7), Vector2::new(1.3, 1.2), Vector2::new(1.1, 1.3)];
    let robot = Robot::new(Pose::new(0.4, 0.9, 0.5), Vector2::new(2.1, 0.95));
    let mut bed = Bed::new(vec![robot], 33, 60);
    let outline = Outline { points: &corners, radius: 0.03 };
    bed.obstacles.push(MovingOutline { outline, velocity: Vector2::zeros() });
    let (least, time) = run(&mut bed, 40);
    assert!(least > 0.5 * MARGIN && time.is_some(), "{least} {time:?}");
}

#[test]
fn a_robot_carried_into_the_way_touches_only_who_stands_still() {
    for seed in 0..200 {
        let mut bed = Bed::new(random_team(seed, 4), 33, 60);
        let random = &mut Random(seed + 77_777);
        let starts = [bed.robots.iter().map(|robot| robot.pose.position()).collect(), random.places(40, 0.0)].concat();
        let clear = |place: &&Vector2<f64>| starts[..4].iter().all(|other| (**place - other).norm() > 0.5);
        let Some(&start) = starts[4..].iter().find(clear) else { continue };
        let heading = random.between(-PI, PI);
        let speed = random.between(0.02, 0.15);
        bed.intruders.push((start, speed * Vector2::new(libm::cos(heading), libm::sin(heading))));
        for _ in 0..20_000 {
            bed.step();
            let intruder = bed.intruders[0].0;
            for robot in &bed.robots {
                let gap = (robot.pose.position() - intruder).norm() - 2.0 * RADIUS;
                let closing = robot.velocity().dot(&(intruder - robot.pose.position()));
                assert!(gap > 0.0 || closing <= 1e-3, "seed {seed}: a robot drives at what is carried into its way");
            }
            assert!(bed.least_gap() > 0.0, "seed {seed}: dodging must not cause another contact");
        }
    }
}

fn filter() -> SafetyFilter {
    let (delay, period, braking, detour_speed) = (0.06, 0.033, 0.5, 0.12);
    let parameters =
        SafetyParameters { radius: RADIUS, half_axle: HALF_AXLE, delay, period, braking, margin: MARGIN, detour_speed };
    SafetyFilter::new(parameters).unwrap()
}

fn wish(v: f64, omega: f64) -> Wish {
    Wish { twist: Twist { v, omega }, goal: None, kept: None, pace: 0.0 }
}

fn neighbour(x: f64, y: f64) -> Neighbour {
    let (position, velocity) = (Vector2::new(x, y), Vector2::zeros());
    Neighbour { position, velocity, radius: RADIUS, cooperative: true, settled: false }
}

#[test]
fn a_harmless_wish_passes_bit_for_bit() {
    let neighbours = [neighbour(1.0, 0.0)];
    let scene = Scene { neighbours: &neighbours, ..Scene::default() };
    let twist = Twist { v: 0.1 + 0.2, omega: -0.0 };
    let filtered =
        filter().apply(Pose::default(), Twist::ZERO, Wish { twist, goal: None, kept: None, pace: 0.0 }, &scene);
    assert_eq!(filtered.acted, None);
    assert_eq!(filtered.twist.v.to_bits(), twist.v.to_bits());
    assert_eq!(filtered.twist.omega.to_bits(), twist.omega.to_bits());
}

#[test]
fn the_closing_speed_obeys_the_rule() {
    for gap in [0.4, 0.1, 0.02, 0.0, -0.02] {
        let neighbours = [neighbour(2.0 * RADIUS + MARGIN + gap, 0.0)];
        let scene = Scene { neighbours: &neighbours, ..Scene::default() };
        let filtered = filter().apply(Pose::default(), Twist::ZERO, wish(1.0, 0.0), &scene);
        let v = filtered.twist.v;
        assert!((v * 0.093 + v * v - 0.5_f64 * gap.max(0.0)).abs() < 1e-9, "{gap} {v}");
        assert_eq!(filtered.acted, Some(Constraint::Neighbour(0)));
        let away = filter().apply(Pose::default(), Twist::ZERO, wish(-1.0, 0.0), &scene);
        assert_eq!(away.twist, Twist { v: -1.0, omega: 0.0 });
        let turn = filter().apply(Pose::default(), Twist::ZERO, wish(0.0, 3.0), &scene);
        assert_eq!(turn.twist, Twist { v: 0.0, omega: 3.0 }, "a disc may turn on the spot");
    }
}

#[test]
fn what_is_not_finite_stops_the_robot() {
    let check = |pose: Pose, now: Twist, wish: Wish, neighbour: Neighbour| {
        let scene = Scene { neighbours: &[neighbour], ..Scene::default() };
        let filtered = filter().apply(pose, now, wish, &scene);
        assert_eq!((filtered.twist, filtered.acted), (Twist::ZERO, Some(Constraint::NotFinite)));
    };
    let (pose, still, far) = (Pose::default(), Twist::ZERO, neighbour(1.0, 1.0));
    check(Pose { x: f64::NAN, ..pose }, still, wish(0.1, 0.0), far);
    check(pose, Twist { v: f64::INFINITY, omega: 0.0 }, wish(0.1, 0.0), far);
    check(pose, still, wish(0.1, f64::NAN), far);
    check(pose, still, wish(0.1, 0.0), neighbour(f64::NAN, 1.0));
    let goal = Some(Vector2::new(f64::NAN, 0.0));
    check(pose, still, Wish { goal, ..wish(0.1, 0.0) }, far);
}

/// A law that pulls across the way round has no speed along it: the way is driven at the law's pace, at least at `detour_speed`.
#[test]
fn a_way_round_is_driven_at_the_pace_of_the_law() {
    let neighbours = [Neighbour { settled: true, ..neighbour(0.5, 0.0) }];
    let scene = Scene { neighbours: &neighbours, ..Scene::default() };
    let goal = Some(Vector2::new(1.0, 0.0));
    let straight = filter().apply(Pose::default(), Twist::ZERO, Wish { goal, ..wish(0.0, 0.0) }, &scene);
    let theta = straight.twist.omega / 4.0;
    let fastest = |pace: f64| {
        let pose = Pose { theta, ..Pose::default() };
        filter().apply(pose, Twist::ZERO, Wish { goal, pace, ..wish(0.0, 0.0) }, &scene).twist.v
    };
    let speeds = [0.0, 0.05, 0.2].map(fastest);
    assert!((speeds[0] - 0.12).abs() < 1e-3 && speeds[1] == speeds[0] && speeds[2] > 0.18, "{speeds:?}");
}

#[test]
fn what_crosses_the_way_is_passed_behind_its_back() {
    let goal = Some(Vector2::new(1.0, 0.0));
    let side = |y: f64, speed: f64| {
        let velocity = Vector2::new(0.0, speed);
        let neighbours = [Neighbour { velocity, ..neighbour(0.5, y) }];
        let scene = Scene { neighbours: &neighbours, ..Scene::default() };
        filter().apply(Pose::default(), Twist::ZERO, Wish { goal, ..wish(0.15, 0.0) }, &scene).side
    };
    // At rest the shorter way, of ways about equal the right one.
    assert_eq!([side(0.0, 0.0), side(-0.04, 0.0)], [Some(Side::Right), Some(Side::Left)]);
    // Crossing to the left and to the right.
    assert_eq!([side(0.0, 0.15), side(-0.04, 0.15)], [Some(Side::Right); 2]);
    assert_eq!([side(0.0, -0.15), side(0.04, -0.15)], [Some(Side::Left); 2]);
}

#[test]
fn unusable_parameters_are_refused() {
    let parameters = SafetyParameters {
        radius: 0.1,
        half_axle: 0.06,
        delay: -0.1,
        period: 0.03,
        braking: 0.5,
        margin: 0.0,
        detour_speed: 0.1,
    };
    let error = SafetyFilter::new(parameters).unwrap_err();
    assert_eq!(error.to_string(), "safety parameter `delay` is -0.1, but must be finite and zero or more");
    let error = SafetyFilter::new(SafetyParameters { delay: 0.1, braking: 0.0, ..parameters }).unwrap_err();
    assert_eq!(error.to_string(), "safety parameter `braking` is 0, but must be finite and greater than zero");
}
