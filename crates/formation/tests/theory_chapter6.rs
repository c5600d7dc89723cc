//! Chapter 6: the simulation of 6.5 and the energy argument of A.12.
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
#![expect(clippy::print_stdout, reason = "the figures are of interest")]
mod edges;

use edges::{Edges, counted};
use proptest::prelude::*;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Attraction, ZonedAttraction};
use trench_formation::simulate::{Integration, ZonedChain, ZonedChainScenario};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, Radii, Sharpness, Zone, Zoning};

/// Table 6.1, in the printed order.
const STARTS: [[f64; 4]; 10] = [
    [26.0026, 29.7094, 0.0153, 0.0056],
    [27.8260, 19.8633, 0.7468, 0.4189],
    [25.4281, 16.7758, 0.4451, -0.1422],
    [14.8357, 21.3381, 0.9318, -0.3908],
    [14.2419, 15.1141, 0.4660, -0.6207],
    [13.7641, 8.8730, 0.4186, -0.6131],
    [12.3089, 4.2053, 0.8462, 0.3644],
    [9.7197, 1.0574, 0.5252, -0.3945],
    [1.5191, 3.0657, 0.2026, 0.0833],
    [0.7206, -1.0582, 0.6721, -0.6983],
];
const TRENCH: Hyperbolic = Hyperbolic { alpha: 10.0, a: 1.0 };
const DIAGONAL: Vector2<f64> = Vector2::new(std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2);
const ACROSS: Vector2<f64> = Vector2::new(-std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2);

fn table_6_2() -> Zoning {
    with_edges(Edge::Jump)
}

fn with_edges(edge: Edge) -> Zoning {
    let radii = Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap();
    Zoning::new(radii, (10.0, 10.0), Sharpness::Two, edge, 1e4).unwrap()
}

fn table_6_3() -> Zoning {
    let radii = Radii::new(1.5, 4.5, 9.0, 12.0, 30.0).unwrap();
    Zoning::new(radii, (10.0, 10.0), Sharpness::Two, Edge::Jump, 1e4).unwrap()
}

struct Run {
    robots: Vec<PointState>,
    closest: f64,
    last_outside_neutral: f64,
    /// Jumps of the force and reversals at the edges of zones 2 and 4 of leaders.
    edges: [(u32, u32); 2],
}

impl Run {
    fn leader_distances(&self) -> Vec<f64> {
        self.robots.windows(2).map(|pair| (pair[0].position - pair[1].position).norm()).collect()
    }
}

/// 300 s of 6.5: the segment y = x, directions of attraction across it, the chain leader drawn to (70, 70) by (5.3).
fn simulate(zoning: Zoning, damping: f64, method: Integration) -> Run {
    let follower = ZonedAttraction { trench: TRENCH, zoning, damping, leader_damping: 0.0, compensates: true };
    simulate_with(follower, method)
}

fn simulate_with(law: ZonedAttraction<Hyperbolic>, method: Integration) -> Run {
    let zoning = law.zoning;
    let state = |[x, y, vx, vy]: [f64; 4]| PointState { position: Vector2::new(x, y), velocity: Vector2::new(vx, vy) };
    let scenario = ZonedChainScenario {
        origin: Vector2::zeros(),
        tangent: DIAGONAL,
        directions: vec![ACROSS; 10],
        team_goal: Vector2::new(70.0, 70.0),
        robots: STARTS.map(state).to_vec(),
        law,
    };
    let mut chain = ZonedChain::new(scenario, method, 0.01);
    let (mut closest, mut last_outside_neutral) = (f64::INFINITY, 0.0);
    let mut seen = [[Edges::default(); 9]; 2];
    for _ in 0..30_000 {
        chain.step();
        for (index, pair) in chain.robots().windows(2).enumerate() {
            let distance = (pair[0].position - pair[1].position).norm();
            for (seen, edge) in seen.iter_mut().zip([zoning.radii().rho_hat, zoning.radii().rho]) {
                seen[index].see((distance, zoning.force(distance)), edge, 5.0 / 27.0);
            }
        }
        for (index, robot) in chain.robots().iter().enumerate() {
            for other in &chain.robots()[..index] {
                closest = closest.min((robot.position - other.position).norm());
            }
        }
        let neutral = |pair: &[PointState]| zoning.zone((pair[0].position - pair[1].position).norm()) == Zone::Neutral;
        if !chain.robots().windows(2).all(neutral) {
            last_outside_neutral = chain.time();
        }
    }
    Run { robots: chain.robots().to_vec(), closest, last_outside_neutral, edges: seen.map(|seen| counted(&seen)) }
}

#[test]
fn simulation_of_6_5() {
    let run = simulate(table_6_2(), 2.0, Integration::RungeKutta);
    let expected = [8.7725, 9.8873, 9.8957, 9.8966, 9.8969, 9.8971, 9.8973, 9.8974, 9.8974];
    for (rank, (got, wanted)) in run.leader_distances().iter().zip(expected).enumerate() {
        assert!((got - wanted).abs() < 1e-3, "r{}: {got}, not {wanted}", rank + 2);
    }
    assert!(run.robots.iter().all(|robot| robot.position.dot(&ACROSS).abs() < 1e-6));
    assert!((run.robots[0].position - Vector2::new(70.0, 70.0)).norm() < 1e-6);
    assert!((run.closest - 3.534).abs() < 1e-3, "{}", run.closest);
}

/// Semi-implicit Euler at the thesis's 10 ms is only near: r2, which coasts into its place, ends 0.029 farther behind (0.003
/// at 1 ms).
#[test]
fn sampling_shows_in_6_5() {
    let run = simulate(table_6_2(), 2.0, Integration::SemiImplicitEuler);
    assert!((run.leader_distances()[0] - 8.8014).abs() < 1e-3, "{:?}", run.leader_distances());
}

#[test]
fn simulation_of_6_5_with_more_damping() {
    let run = simulate(table_6_2(), 5.0, Integration::RungeKutta);
    assert!(
        run.leader_distances().iter().all(|distance| (distance - 9.985).abs() < 2e-3),
        "{:?}",
        run.leader_distances()
    );
    assert!((run.last_outside_neutral - 79.3).abs() < 0.1, "{}", run.last_outside_neutral);
}

#[test]
fn modified_radii_of_table_6_3() {
    let run = simulate(table_6_3(), 2.0, Integration::RungeKutta);
    assert!(
        run.leader_distances().iter().all(|distance| (4.5..=9.0).contains(distance)),
        "{:?}",
        run.leader_distances()
    );
    assert!(run.closest > 1.5);
    assert!(run.robots.iter().all(|robot| robot.position.dot(&ACROSS).abs() < 1e-6));
}

/// With the printed edge the force of a zone jumps (by 10/27) each time that a robot enters or leaves one; with a continuous one never. Nobody
/// bounces at the edges in 6.5, with either: k = 2 takes a robot across, or lets it coast in.
#[test]
fn continuous_edges_end_the_jumps() {
    let edges = |edge| simulate(with_edges(edge), 2.0, Integration::SemiImplicitEuler).edges;
    let (jump, continuous) = (edges(Edge::Jump), edges(Edge::Continuous));
    println!(
        "figure: jumps and reversals at rho_hat and rho: {jump:?} with the printed edge, {continuous:?} with a continuous one"
    );
    assert!(jump[0].0 > 0 && jump[1].0 >= 9, "each follower comes to its place from zone 4: {jump:?}");
    assert_eq!(continuous.map(|(jumps, _)| jumps), [0, 0]);
    assert!(continuous.iter().zip(&jump).all(|(new, old)| new.1 <= old.1 && new.1 <= 9), "{continuous:?}");
}

/// k = 1 whips the chain against its zoning walls; damping relative to the leader cures it.
#[test]
fn leader_damping_calms_the_chain() {
    let follower =
        ZonedAttraction { trench: TRENCH, zoning: table_6_2(), damping: 1.0, leader_damping: 0.0, compensates: true };
    let wild = simulate_with(follower, Integration::SemiImplicitEuler);
    let calm = simulate_with(ZonedAttraction { leader_damping: 2.0, ..follower }, Integration::SemiImplicitEuler);
    assert!(wild.closest < 1.0 && calm.closest > 3.0, "{} {}", wild.closest, calm.closest);
    assert!(calm.robots.iter().all(|robot| robot.position.dot(&ACROSS).abs() < 1e-6));
    assert!(calm.last_outside_neutral < 20.0, "{}", calm.last_outside_neutral);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// A.12: V' = -k |r'|^2 with delta, oblique directions included; without delta the point of attraction does work.
    #[test]
    fn lyapunov_function_of_a_12(
        x in 8.0..12.0_f64, y in -3.0..3.0_f64, vx in -1.0..1.0_f64, vy in -1.0..1.0_f64, angle in 0.5..2.6_f64,
        compensates: bool, edge: bool,
    ) {
        prop_assume!(vx.hypot(vy) > 0.05 && y.abs() > 0.05);
        let edge = if edge { Edge::Continuous } else { Edge::Jump };
        let zoning = Zoning::new(*table_6_2().radii(), (10.0, 4.0), Sharpness::One, edge, 50.0).unwrap();
        let law = ZonedAttraction { trench: TRENCH, zoning, damping: 1.5, leader_damping: 0.3, compensates };
        let direction = Vector2::new(libm::cos(angle), libm::sin(angle));
        let (leader, ahead) = (PointState::at_rest(Vector2::new(-1.0, 0.5)), [Vector2::new(9.0, -4.5)]);
        let steer = |robot: PointState| {
            let attraction = Attraction::on_line(robot, direction, Vector2::zeros(), Vector2::new(1.0, 0.0)).unwrap();
            law.steer(robot, attraction, leader, &ahead)
        };
        let start = PointState { position: Vector2::new(x, y), velocity: Vector2::new(vx, vy) };
        for other in [leader.position, ahead[0]] {
            let distance = (other - start.position).norm();
            prop_assume!(zoning.radii().rho_hat - distance < -1e-3 || zoning.radii().rho_hat - distance > 1e-3);
            prop_assume!((zoning.radii().rho - distance).abs() > 1e-3);
        }
        let now = steer(start);
        let step = 1e-5;
        let (after, before) = (steer(start.advanced(now.acceleration, step)), steer(start.advanced(now.acceleration, -step)));
        let slope = (after.lyapunov - before.lyapunov) / (2.0 * step);
        prop_assert!((slope - now.lyapunov_rate).abs() < 1e-4 * (1.0 + slope.abs()), "{slope} {}", now.lyapunov_rate);
        if compensates {
            let expected = -1.5 * start.velocity.norm_squared() - 0.3 * start.velocity.norm_squared();
            prop_assert!((now.lyapunov_rate - expected).abs() < 1e-9 * (1.0 + now.lyapunov));
        }
    }
}
