//! Chapter 7: the energy arguments of A.16 and A.18.
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::curve::{Curve, CurveShape, Placed};
use trench_formation::hull::Outline;
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Attracting, NearestAttraction, Push, Steered};
use trench_formation::simulate::Carriage;
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

const LAW: NearestAttraction<Hyperbolic> =
    NearestAttraction { trench: Hyperbolic { alpha: 10.0, a: 1.0 }, damping: 2.0, leader_damping: 0.0 };

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// V' = -k |r' - r_ns'|^2 for a curved segment that translates, with leader, robot ahead and obstacle at rest in its frame; the
    /// nearest point slides, which the print's derivative of d_ns counts and this one must not.
    #[test]
    fn lyapunov_function_of_a_18(
        x in -2.0..2.0_f64, y in 0.3..3.0_f64, vx in -1.0..1.0_f64, vy in -1.0..1.0_f64,
        drift_x in -1.0..1.0_f64, drift_y in -1.0..1.0_f64,
    ) {
        let curve = Curve::new(
            &CurveShape::Ellipse { centre: at(0.0, -1.0), semi_axes: [6.0, 1.0], rotation: 0.1 }, false, false,
        ).unwrap();
        let carriage = Carriage { origin: at(0.3, 0.1), heading: 0.2, velocity: at(drift_x, drift_y), turn_rate: 0.0 };
        let radii = Radii::new(0.5, 1.5, 2.5, 8.0, 30.0).unwrap();
        let zoning = Zoning::new(radii, (2.0, 3.0), Sharpness::One, Edge::Continuous, 50.0).unwrap();
        let potential = ObstaclePotential::new(0.2, 2.0, 4.0, Sharpness::Two, Edge::Continuous, 50.0).unwrap();
        let square = [[-4.0, 1.0], [-3.0, 1.0], [-3.0, 2.0]].map(Vector2::from);
        let outline = Outline { points: &square, radius: 0.1 };
        let steer = |robot: PointState, time: f64| -> Steered {
            let (map_from_curve, motion) = carriage.at(time);
            let moved = |point: Vector2<f64>| point + time * carriage.velocity;
            let foot = Placed::new(&curve, map_from_curve).nearest(robot.position);
            let pushes = [
                Push::of_leader(&zoning, robot.position, moved(at(4.0, 1.0))),
                Push::of_robot_ahead(&zoning, robot.position, moved(at(2.2, 1.5))),
                Push::of_obstacle(&potential, outline.approach(robot.position - time * carriage.velocity)),
            ];
            LAW.steer(robot, Attracting { foot: motion.at(foot.point), draws: true }, None, pushes)
        };
        let start = PointState { position: at(x, y), velocity: at(vx, vy) };
        for (distance, edge) in [
            ((at(4.0, 1.0) - start.position).norm(), 1.5), ((at(4.0, 1.0) - start.position).norm(), 2.5),
            ((at(2.2, 1.5) - start.position).norm(), 1.5), (outline.approach(start.position).gap, 2.0),
        ] {
            prop_assume!((distance - edge).abs() > 1e-3);
        }
        let now = steer(start, 0.0);
        let step = 1e-5;
        let value = |step: f64| steer(start.advanced(now.acceleration, step), step).lyapunov;
        let slope = (value(step) - value(-step)) / (2.0 * step);
        prop_assert!((slope - now.lyapunov_rate).abs() < 1e-4 * (1.0 + slope.abs() + now.lyapunov), "{slope} {now:?}");
        let expected = -2.0 * (start.velocity - carriage.velocity).norm_squared();
        prop_assert!((now.lyapunov_rate - expected).abs() < 1e-12);
    }
}

/// Without the attraction, damping goes on.
#[test]
fn suspended_attraction() {
    let robot = PointState { position: at(0.0, 3.0), velocity: at(1.0, 0.0) };
    let curve = Curve::new(&CurveShape::Line(at(-5.0, 0.0), at(5.0, 0.0)), false, false).unwrap();
    let foot = Placed::new(&curve, Isometry2::identity()).nearest(robot.position);
    let motion = Carriage::parked().at(0.0).1;
    let steered = LAW.steer(robot, Attracting { foot: motion.at(foot.point), draws: false }, None, []);
    assert_eq!((steered.acceleration, steered.lyapunov), (at(-2.0, 0.0), 0.5));
}
