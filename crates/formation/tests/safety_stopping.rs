//! The safety filter of robots that are commanded by accelerations: whatever the laws want, bodies do not meet.
use nalgebra::Vector2;
use proptest::prelude::*;
use trench_formation::hull::Outline;
use trench_formation::kinematics::PointState;
use trench_formation::laws::Capability;
use trench_formation::safety::{Line, Passing, Stopping};

const SAFETY: Stopping = Stopping { radius: 0.1, capability: Capability { speed: 0.5, acceleration: 2.0 } };
const STEP: f64 = 0.01;
const TICK: u32 = 3;

/// Corners of a wall in the middle.
const WALL: [Vector2<f64>; 3] = [Vector2::new(-0.3, -0.2), Vector2::new(0.3, -0.2), Vector2::new(0.0, 0.4)];

/// A number of [-1, 1) from anything.
fn noise(seed: u64, index: usize, step: u32) -> f64 {
    let mut mixed = seed ^ ((index as u64) << 40) ^ u64::from(step).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Ten robots around a wall that all want to be at one place in it, or anywhere at random, at full power.
fn least_gaps(seed: u64, steps: u32) -> (f64, f64) {
    let place = |index: usize| {
        let (sine, cosine) = libm::sincos(core::f64::consts::TAU * index as f64 / 10.0 + 0.1 * noise(seed, index, 0));
        (1.5 + 0.3 * noise(seed, index, 1)) * Vector2::new(cosine, sine)
    };
    let mut robots: Vec<PointState> = (0..10).map(|index| PointState::at_rest(place(index))).collect();
    let outline = Outline { points: &WALL, radius: 0.0 };
    let (mut lines, mut between, mut wall): (Vec<Vec<Line>>, f64, f64) = (Vec::new(), f64::INFINITY, f64::INFINITY);
    for step in 0..steps {
        if step % TICK == 0 {
            let others = |index: usize| robots.iter().enumerate().filter(move |(other, _)| *other != index);
            let all = |(index, robot): (usize, &PointState)| {
                let before = SAFETY.before(*robot, &outline);
                others(index).map(|(_, other)| SAFETY.between(*robot, *other)).chain([before]).collect()
            };
            lines = robots.iter().enumerate().map(all).collect();
        }
        for (index, robot) in robots.iter_mut().enumerate() {
            let towards = if (step / 100 + index as u32).is_multiple_of(3) {
                Vector2::new(noise(seed, index, step / 50 + 7), noise(seed, index, step / 50 + 9))
            } else {
                -robot.position
            };
            let wanted = 2.0 * towards.normalize();
            let next = robot.velocity + STEP * wanted;
            let wanted = (next.cap_magnitude(0.5) - robot.velocity) / STEP;
            let admitted = SAFETY.admit(*robot, wanted, &lines[index], core::iter::empty(), STEP);
            assert!(admitted.norm() <= 2.0 + 1e-9, "{admitted}");
            *robot = robot.advanced_semi_implicit(admitted, STEP);
        }
        for (index, robot) in robots.iter().enumerate() {
            wall = wall.min(outline.approach(robot.position).gap);
            for other in &robots[..index] {
                between = between.min((robot.position - other.position).norm());
            }
        }
    }
    (between, wall)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn bodies_never_meet(seed: u64) {
        let (between, wall) = least_gaps(seed, 2000);
        prop_assert!(between >= 0.2 - 1e-9, "{between}");
        prop_assert!(wall >= 0.1 - 1e-9, "{wall}");
        prop_assert!(between < 0.25, "they came nowhere near each other: {between}");
    }

    /// What moves at half of the robot's speed does not catch a robot that has room, though its law wants it to stay.
    #[test]
    fn what_passes_is_evaded(angle in 0.0..core::f64::consts::TAU, speed in 0.05..0.25_f64, aside in -0.4..0.4_f64) {
        let (sine, cosine) = libm::sincos(angle);
        let velocity = speed * Vector2::new(cosine, sine);
        let start = Vector2::new(-2.0 * cosine - aside * sine, -2.0 * sine + aside * cosine);
        let mut robot = PointState::at_rest(Vector2::zeros());
        for step in 0..8000_u32 {
            let since = f64::from(step % TICK) * STEP;
            let centre = [start + (f64::from(step) * STEP - since) * velocity];
            let passing = Passing { outline: Outline { points: &centre, radius: 0.5 }, velocity, since };
            let stay = (-robot.velocity / STEP).cap_magnitude(2.0);
            let admitted = SAFETY.admit(robot, stay, &[], core::iter::once(passing), STEP);
            robot = robot.advanced_semi_implicit(admitted, STEP);
            let gap = (robot.position - start - f64::from(step + 1) * STEP * velocity).norm() - 0.5;
            prop_assert!(gap >= 0.1 - 5e-3, "{gap} at {step}");
        }
    }
}

#[test]
fn a_wish_that_keeps_clear_is_passed_on() {
    let robot = PointState { position: Vector2::new(0.0, 0.0), velocity: Vector2::new(0.1, 0.0) };
    let other = PointState::at_rest(Vector2::new(1.0, 0.0));
    let wanted = Vector2::new(0.3, -1.2);
    let lines = [SAFETY.between(robot, other)];
    assert_eq!(SAFETY.admit(robot, wanted, &lines, core::iter::empty(), STEP), wanted);
}

/// Bodies that overlap, as where somebody put them down so, come apart where their laws want it, and no nearer whatever these want.
#[test]
fn bodies_that_overlap_may_part() {
    for (wanted, parts) in [(2.0, true), (-2.0, false)] {
        let mut robots = [-0.08, 0.08].map(|x| PointState::at_rest(Vector2::new(x, 0.0)));
        let mut least = f64::INFINITY;
        for step in 0..200 {
            let seen = robots;
            for (index, robot) in robots.iter_mut().enumerate() {
                let way = Vector2::new(if index == 0 { -wanted } else { wanted }, 0.0);
                let line = SAFETY.between(seen[index], seen[1 - index]);
                let next = (robot.velocity + STEP * way).cap_magnitude(0.5);
                let admitted = SAFETY.admit(*robot, (next - robot.velocity) / STEP, &[line], core::iter::empty(), STEP);
                *robot = robot.advanced_semi_implicit(admitted, STEP);
            }
            least = least.min((robots[1].position - robots[0].position).norm());
            if step == 99 && parts {
                assert!((robots[1].position - robots[0].position).norm() > 0.2, "{robots:?}");
            }
        }
        assert!(least >= 0.16 - 1e-9, "{least}");
    }
}
