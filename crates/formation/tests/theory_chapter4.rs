//! Chapter 4 against integration of the unicycle itself, and the corrections of its propositions.
use nalgebra::{Vector1, Vector3};
use std::f64::consts::PI;
use trench_formation::Vector2;
use trench_formation::kinematics::{Axle, Polar, Pose, Wheels};
use trench_formation::laws::{Direct, Family, Lyapunov, Nominal, PointLaw, Robust};
use trench_formation::stability::{C1, ClosedForm, LAMBDA_STAR, TwoGainLaw, rk4, sine_integral};

/// Integrates (3.6) with headings counted through full turns. The goal point is the origin.
fn drive(law: &dyn PointLaw, start: (f64, f64, f64), duration: f64, steps: u32) -> Vector3<f64> {
    let step = duration / f64::from(steps);
    let mut state = Vector3::new(start.0, start.1, start.2);
    for index in 0..steps {
        state = rk4(f64::from(index) * step, state, step, |_, state| {
            let twist = law.twist(Polar::of(Pose::new(state.x, state.y, state.z), Vector2::zeros()));
            Vector3::new(twist.v * libm::cos(state.z), twist.v * libm::sin(state.z), twist.omega)
        });
    }
    state
}

const LAWS: [TwoGainLaw; 2] = [TwoGainLaw::Direct, TwoGainLaw::Nominal];

fn law_of(law: TwoGainLaw, k1: f64, k2: f64) -> Box<dyn PointLaw> {
    match law {
        TwoGainLaw::Direct => Box::new(Direct { k1, k2 }),
        TwoGainLaw::Nominal => Box::new(Nominal { k1, k2 }),
    }
}

/// (4.6), (4.7) and the headings of 4.2.1, for every start of 4.4.1 and beyond.
#[test]
fn closed_forms_match_the_driven_robot() {
    for law in LAWS {
        for (k1, k2) in [(1.0, 5.0), (1.0, 1.0), (1.0, 0.2)] {
            for phi0 in [PI / 4.0, -2.0, 3.0] {
                let start = Polar { distance: 1.0, misalignment: phi0 };
                let form = ClosedForm { law, k1, k2, start };
                // From (1, 0) the goal lies at bearing pi.
                let theta0 = PI + phi0;
                let end = drive(&*law_of(law, k1, k2), (1.0, 0.0, theta0), 1.5, 6000);
                let polar = Polar::of(Pose::new(end.x, end.y, end.z), Vector2::zeros());
                assert!((polar.distance - form.distance(1.5)).abs() < 1e-9, "{law:?} {k1} {k2} {phi0}");
                assert!((polar.misalignment - form.misalignment(1.5)).abs() < 1e-8);
                assert!((end.z - theta0 - form.heading_change(1.5)).abs() < 1e-9);
            }
        }
    }
}

/// theta(inf), H_c1 > H_c2, and theta_1 < theta_2 for phi0 > 0 (4.2.1).
#[test]
fn turning_of_heading() {
    for phi0 in [-2.9, -1.0, 0.4, 2.0, PI] {
        let change = |law| {
            let start = Polar { distance: 2.0, misalignment: phi0 };
            ClosedForm { law, k1: 0.7, k2: 0.5, start }.final_heading_change()
        };
        let (first, second) = (change(TwoGainLaw::Direct), change(TwoGainLaw::Nominal));
        assert!((first + phi0 + 1.4 * sine_integral(phi0)).abs() < 1e-14);
        assert!((second + phi0 + 0.7 * sine_integral(2.0 * phi0)).abs() < 1e-14);
        assert!(first.abs() > second.abs());
        assert_eq!(first < second, phi0 > 0.0);
    }
}

/// Propositions 4.2.1 and 4.2.2: equal gain ratio, equal path, whatever the speed.
#[test]
fn the_path_depends_on_the_gain_ratio_alone() {
    for law in LAWS {
        let start = Polar { distance: 1.0, misalignment: PI / 4.0 };
        let (slow, fast) = (ClosedForm { law, k1: 1.0, k2: 0.2, start }, ClosedForm { law, k1: 10.0, k2: 2.0, start });
        for tick in 1..50 {
            let time = 0.1 * f64::from(tick);
            let phi = fast.misalignment(time);
            assert!((phi - slow.misalignment(10.0 * time)).abs() < 1e-14);
            assert!((fast.distance(time) - slow.distance_at(phi)).abs() < 1e-13);
            assert!((fast.heading_change(time) - slow.heading_change(10.0 * time)).abs() < 1e-13);
        }
    }
}

/// 4.4.1: the bearing of the robot from its goal point sweeps lambda Si(phi0): which trajectory leaves its quadrant.
#[test]
fn sweep_around_the_goal_point() {
    let sweep = |law, lambda: f64| {
        let start = Polar { distance: 1.0, misalignment: PI / 4.0 };
        let change = ClosedForm { law, k1: lambda, k2: 1.0, start }.final_heading_change();
        (change + PI / 4.0).abs().to_degrees()
    };
    for (law, lambda, degrees) in [
        (TwoGainLaw::Direct, 5.0, 217.4),
        (TwoGainLaw::Nominal, 5.0, 196.3),
        (TwoGainLaw::Direct, 1.0, 43.5),
        (TwoGainLaw::Nominal, 1.0, 39.3),
    ] {
        assert!((sweep(law, lambda) - degrees).abs() < 0.05, "{law:?} {lambda}: {}", sweep(law, lambda));
    }
}

/// Proposition 4.1.1 fails for q >= 1: r stops at r0 exp(-lambda integral of u^(2q-1) cos^(2p+2) u), s = n = 0.
#[test]
fn members_with_q_stop_short_of_the_goal_point() {
    let (k1, k2, phi0) = (1.3, 0.9, 1.1);
    let family = Family { k1, k2, n: 0, p: 0, q: 1, s: 0 };
    assert!(!family.is_asymptotically_stable());
    let end = drive(&family, (1.0, 0.0, PI + phi0), 60.0, 60_000);
    // Integral of u cos^2 u from 0 to phi0.
    let integral = phi0 * phi0 / 4.0 + phi0 * libm::sin(2.0 * phi0) / 4.0 + (libm::cos(2.0 * phi0) - 1.0) / 8.0;
    let expected = libm::exp(-k1 / k2 * integral);
    assert!((end.xy().norm() - expected).abs() < 1e-8, "{} {expected}", end.xy().norm());
}

/// Proposition 4.3.2 fails beyond pi/2: there K4 > 0 slows phi, and speeds it up only once |phi| < pi/2.
#[test]
fn k4_expedites_only_within_a_right_angle() {
    let rate = |k3: f64, phi: f64| Robust { k1: 1.0, k2: 1.0, k3 }.misalignment_rate(phi);
    assert!(rate(2.0, 1.0) < rate(1.0, 1.0));
    assert!(rate(2.0, 2.5) > rate(1.0, 2.5));
}

/// The wheel speeds printed below (3.16) are mirrored: with (3.14) they make phi diverge.
#[test]
fn printed_wheel_speeds_turn_the_wrong_way() {
    let (axle, polar) = (Axle { half_track: 0.06 }, Polar { distance: 1.0, misalignment: 0.5 });
    let wheels = axle.wheels(Nominal { k1: 0.5, k2: 1.0 }.twist(polar));
    let mirrored = Wheels { left: wheels.right, right: wheels.left };
    assert!(polar.rates(axle.twist(wheels)).misalignment < 0.0);
    assert!(polar.rates(axle.twist(mirrored)).misalignment > 0.0);
}

/// A.2's second family, to which (3.9) belongs, lets V grow while |phi| > pi/2: the robot drives away while it turns.
#[test]
fn law_3_9_may_raise_the_lyapunov_function() {
    let polar = Polar { distance: 3.0, misalignment: 2.8 };
    assert!(Lyapunov::of(polar, Direct { k1: 1.0, k2: 0.2 }.twist(polar)).rate > 0.0);
    assert!(Lyapunov::of(polar, Nominal { k1: 1.0, k2: 0.2 }.twist(polar)).rate < 0.0);
}

/// phi(t) of (4.8), by RK4.
fn misalignment_after(gains: Robust, start: f64, duration: f64) -> f64 {
    let steps = (duration * 100.0) as u32;
    let mut phi = Vector1::new(start);
    for _ in 0..steps {
        phi = rk4(0.0, phi, duration / f64::from(steps), |_, phi| Vector1::new(gains.misalignment_rate(phi.x)));
    }
    phi.x
}

/// The lower edge of the stable zone: phi vanishes as sqrt(3/(4 K2 t)), slower than any exponential; on the upper edge it
/// stays where 2 phi = tan 2 phi; for K2 < 0 it grows.
#[test]
fn edges_of_the_stable_zone() {
    let low = misalignment_after(Robust { k1: 1.0, k2: 0.5, k3: 0.5 }, 0.5, 4000.0);
    let predicted = libm::sqrt(3.0 / (4.0 * 0.5 * 4000.0));
    assert!((low / predicted - 1.0).abs() < 0.01, "{low} {predicted}");
    let high = misalignment_after(Robust { k1: 1.0, k2: 1.0, k3: 1.0 + 2.0 * C1 }, 3.1, 2000.0);
    assert!((high - 2.2467).abs() < 2e-3, "{high}");
    assert!(misalignment_after(Robust { k1: 1.0, k2: -0.1, k3: 0.9 }, 0.01, 5.0) > 0.01);
}

/// H_c is the net change: under (3.10) with lambda > lambda* and |phi0| > pi/2 the robot turns to and fro.
#[test]
fn total_turning_exceeds_h_c() {
    let turning = |lambda: f64| {
        let start = Polar { distance: 1.0, misalignment: 3.0 };
        let form = ClosedForm { law: TwoGainLaw::Nominal, k1: lambda, k2: 1.0, start };
        let headings: Vec<f64> = (0..=3000).map(|tick| form.heading_change(0.01 * f64::from(tick))).collect();
        let total: f64 = headings.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
        total - form.final_heading_change().abs()
    };
    assert!(turning(LAMBDA_STAR - 0.1).abs() < 1e-9);
    assert!(turning(8.0) > 0.1);
}
