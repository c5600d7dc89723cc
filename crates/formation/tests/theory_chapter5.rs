//! Chapter 5: trenches, critical damping, and the simulation of 5.6.
use proptest::prelude::*;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Capability, GoalMotion, GoalTracking};
use trench_formation::simulate::{GoalTeam, Integration, WaveGoals};
use trench_formation::stability::rk4;
use trench_formation::trench::{
    Conic, ConstantDamping, CriticallyDamped, Damping, Hyperbolic, HyperbolicDamping, Quadratic, Saturated,
    SaturatedDamping, SlopeTable, SquareRoot, Trench,
};

/// Table 5.1: position errors and velocities of r5 and r15.
const R5: (usize, [f64; 4]) = (5, [-1.7826, -1.5746, 0.4660, 0.2426]);
const R15: (usize, [f64; 4]) = (15, [-0.3525, 1.2047, 0.8318, 0.4746]);

/// Goal points at x = 45 - 3i + t (ERRATA: not 45 - i + t), y = sin(x/2).
const GOALS: WaveGoals =
    WaveGoals { first: 42.0, spacing: 3.0, speed: 1.0, amplitude: 1.0, wave_number: 0.5, phase: 0.0 };

fn goal(robot: usize, time: f64) -> GoalMotion {
    GOALS.at(robot - 1, time)
}

/// Runs 5.6 for one robot and compares its position error every 1.6 s.
fn check(trench: impl Trench, (robot, [dx, dy, vx, vy]): (usize, [f64; 4]), expected: [f64; 6]) {
    let law = GoalTracking { trench, damping: ConstantDamping { coefficient: 1.0 } };
    let position = goal(robot, 0.0).position + Vector2::new(dx, dy);
    let start = PointState { position, velocity: Vector2::new(vx, vy) };
    let mut team = GoalTeam::new(vec![start], Integration::RungeKutta, 0.002);
    for wanted in expected {
        let time = team.time();
        let error = (team.robots()[0].position - goal(robot, time).position).norm();
        assert!((error - wanted).abs() < 1e-4, "t = {time}: {error}, not {wanted}");
        (0..800).for_each(|_| team.step(|_, time| goal(robot, time), |robot, goal| law.steer(robot, goal)));
    }
}

#[test]
fn simulation_of_5_6_with_the_first_trench() {
    let errors = [2.378451, 0.929814, 0.130394, 0.167359, 0.057971, 0.020165];
    check(Hyperbolic { alpha: 10.0, a: 1.0 }, R5, errors);
}

#[test]
fn simulation_of_5_6_with_the_second_trench() {
    let errors = [1.255212, 0.425783, 0.052716, 0.109309, 0.039687, 0.004094];
    check(Saturated { stiffness: 7.07, edge: 1.0 }, R15, errors);
}

/// Whether x'' + k x' + phi = 0 passes 0 within a long time, started at rest at 0.8.
fn overshoots(damping: impl Damping, trench: impl Trench) -> bool {
    let mut state = nalgebra::Vector2::new(0.8, 0.0);
    for _ in 0..40_000 {
        state = rk4(0.0, state, 0.005, |_, s| {
            nalgebra::Vector2::new(s.y, -damping.coefficient(s.x) * s.y - trench.slope(s.x))
        });
        if state.x < 0.0 {
            return true;
        }
    }
    false
}

/// Corollary A.9.1 sits on the edge; beta > alpha lies on the under-damped side (the thesis says over-damped).
#[test]
fn critical_damping_is_the_edge_of_overshooting() {
    let hyperbolic = |alpha| HyperbolicDamping { alpha, a: 0.5 };
    for (share, expected) in [(0.9, false), (1.0, false), (1.2, true)] {
        let beta = 2.0 * share;
        let constant = ConstantDamping { coefficient: 2.0 };
        assert_eq!(overshoots(constant, CriticallyDamped(ConstantDamping { coefficient: beta })), expected);
        assert_eq!(overshoots(hyperbolic(2.0), CriticallyDamped(hyperbolic(beta))), expected);
        let saturated = |alpha| SaturatedDamping(hyperbolic(alpha));
        assert_eq!(overshoots(saturated(2.0), CriticallyDamped(saturated(beta))), expected);
    }
}

fn slope_is_the_derivative(trench: &impl Trench, x: f64) -> Result<(), TestCaseError> {
    let step = 1e-6;
    let difference = (trench.value(x + step) - trench.value(x - step)) / (2.0 * step);
    prop_assert!((difference - trench.slope(x)).abs() < 1e-6, "{x}: {difference} {}", trench.slope(x));
    prop_assert_eq!(trench.value(x), trench.value(-x));
    prop_assert_eq!(trench.slope(x), -trench.slope(-x));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Values and slopes of every trench belong together, and so do k and K.
    #[test]
    fn slopes_are_derivatives(x in 0.001..4.0_f64) {
        prop_assume!((x - 1.0).abs() > 1e-5 && (x - 2.0).abs() > 1e-5);
        let damping = HyperbolicDamping { alpha: 1.5, a: 0.4 };
        slope_is_the_derivative(&Conic { alpha: 1.2 }, x)?;
        slope_is_the_derivative(&Quadratic { alpha: 1.2 }, x)?;
        slope_is_the_derivative(&Hyperbolic { alpha: 10.0, a: 0.3 }, x)?;
        slope_is_the_derivative(&Saturated { stiffness: 3.0, edge: 1.0 }, x)?;
        slope_is_the_derivative(&SquareRoot, x)?;
        slope_is_the_derivative(&CriticallyDamped(damping), x)?;
        slope_is_the_derivative(&CriticallyDamped(SaturatedDamping(damping)), x)?;
        slope_is_the_derivative(&SlopeTable::new(vec![(0.0, 0.5), (1.0, 2.0), (2.0, 1.0)]).unwrap(), x)?;
        let saturated = SaturatedDamping(damping);
        let difference = (saturated.integral(x + 1e-6) - saturated.integral(x - 1e-6)) / 2e-6;
        prop_assert!((difference - saturated.coefficient(x)).abs() < 1e-6);
        prop_assert_eq!(saturated.integral(-x), -saturated.integral(x));
    }

    /// A.10: V' = -k |d'|^2 along the motion, whatever the goal point does.
    #[test]
    fn lyapunov_function_of_a_10(dx in -2.0..2.0_f64, dy in -2.0..2.0_f64, vx in -1.0..1.0_f64, vy in -1.0..1.0_f64) {
        prop_assume!(dx.hypot(dy) > 0.01);
        let law = GoalTracking { trench: Hyperbolic { alpha: 3.0, a: 0.5 }, damping: HyperbolicDamping { alpha: 2.0, a: 0.3 } };
        let start = PointState { position: goal(4, 0.0).position + Vector2::new(dx, dy), velocity: Vector2::new(vx, vy) };
        let now = law.steer(start, goal(4, 0.0));
        let step = 1e-5;
        let (after, before) = (start.advanced(now.acceleration, step), start.advanced(now.acceleration, -step));
        let slope = (law.steer(after, goal(4, step)).lyapunov - law.steer(before, goal(4, -step)).lyapunov) / (2.0 * step);
        prop_assert!((slope - now.lyapunov_rate).abs() < 1e-5 * (1.0 + slope.abs()), "{slope} {}", now.lyapunov_rate);
    }

    /// 9.2: a bounded actuator, without a cut: neither speed nor acceleration is exceeded, and the robot arrives.
    #[test]
    fn bounded_tracking_stays_within_its_capability(
        x in -20.0..20.0_f64, y in -20.0..20.0_f64, speed in 0.2..2.0_f64, acceleration in 0.2..2.0_f64, direction in 0.0..6.0_f64,
    ) {
        let law = GoalTracking::within(Capability { speed, acceleration });
        let (sin, cos) = libm::sincos(direction);
        let mut robot = PointState { position: Vector2::new(x, y), velocity: Vector2::new(cos, sin) * speed };
        let goal = GoalMotion::at_rest(Vector2::zeros());
        // The way there at full speed, and sixty time constants of the damping.
        let step = 0.01 / law.damping.coefficient;
        for _ in 0..6000 + (60.0 / (speed * step)) as u32 {
            let steered = law.steer(robot, goal);
            prop_assert!(steered.acceleration.norm() <= acceleration * (1.0 + 1e-12));
            robot = robot.advanced_semi_implicit(steered.acceleration, step);
            prop_assert!(robot.velocity.norm() <= speed * (1.0 + 1e-12));
        }
        prop_assert!(robot.position.norm() < 1e-3, "{}", robot.position);
    }
}
