//! Chapter 8: chains of robots under the realisable queue law, against their bounds.
use proptest::prelude::*;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::laws::QueueFollowing;
use trench_formation::stability::{Coupling, cascade_bounds, input_to_state, recursive_bounds};

const LAW: QueueFollowing = QueueFollowing { position_gain: 2.0, velocity_gain: 3.0 };
const SPACING: Vector2<f64> = Vector2::new(1.0, 0.0);

/// The norm of (position error, velocity error) of each robot; the first keeps its distance from a resting point.
fn errors(robots: &[PointState]) -> Vec<f64> {
    let mut leader = PointState::at_rest(Vector2::zeros());
    let norms = robots.iter().map(|robot| {
        let position = leader.position - robot.position - SPACING;
        let velocity = leader.velocity - robot.velocity;
        leader = *robot;
        (position.norm_squared() + velocity.norm_squared()).sqrt()
    });
    norms.collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 48, ..ProptestConfig::default() })]

    /// No robot of a driven chain leaves its bounds, and all errors vanish.
    #[test]
    fn driven_chains_stay_within_their_bounds(
        starts in proptest::collection::vec((-0.5..0.5_f64, -0.5..0.5_f64, -0.5..0.5_f64, -0.5..0.5_f64), 1..6),
    ) {
        let mut robots: Vec<PointState> = (1_u32..).zip(&starts).map(|(rank, &(x, y, vx, vy))| PointState {
            position: Vector2::new(x, y) - SPACING * f64::from(rank),
            velocity: Vector2::new(vx, vy),
        }).collect();
        let (chain, initial) = (vec![LAW.model(); robots.len()], errors(&robots));
        let loose = recursive_bounds(&input_to_state(&chain, Coupling::Realisable, 0.5).unwrap(), &initial);
        let tight = cascade_bounds(&chain, Coupling::Realisable, &initial).unwrap();
        for _ in 0..12_000 {
            let mut leader = PointState::at_rest(Vector2::zeros());
            for robot in &mut robots {
                let now = *robot;
                *robot = now.advanced_semi_implicit(LAW.acceleration(now, leader, SPACING), 0.002);
                leader = now;
            }
            for ((error, tight), loose) in errors(&robots).iter().zip(&tight).zip(&loose) {
                // The step of the integration is worth a thousandth.
                prop_assert!(*error <= tight * 1.002 && *error <= loose * 1.002, "{error} {tight} {loose}");
            }
        }
        prop_assert!(errors(&robots).iter().all(|error| *error < 1e-3));
    }
}
