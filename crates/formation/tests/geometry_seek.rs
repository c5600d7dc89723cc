//! Nearest points on fragments, and the seeking algorithm of 7.5.2.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may fail by a panic in a function of its own")]
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::curve::{Curve, CurveShape, Placed};
use trench_formation::hull::{Obstacle, Outline, Shape};
use trench_formation::seek::{Fragments, LeaderRule, LeaderView, SeekSettings, Seeker, Sought, apparent_obstacles};
use trench_formation::zoning::Radii;

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

const SETTINGS: SeekSettings = SeekSettings {
    room: 0.5,
    transit_margin: 0.05,
    settled_distance: 0.1,
    settled_speed: 0.1,
    leader_rule: LeaderRule::StepSix,
};

/// y = sin x over one period and a half.
fn wave() -> Curve {
    let shape = CurveShape::Sinusoid {
        origin: at(-FRAC_PI_2, 0.0),
        direction: 0.0,
        length: 3.0 * PI,
        amplitude: 1.0,
        wavelength: TAU,
        phase: -FRAC_PI_2,
    };
    Curve::new(&shape, false, false).unwrap()
}

fn radii() -> Radii {
    Radii::new(0.2, 0.4, 1.0, 2.0, 3.0).unwrap()
}

fn resting(position: Vector2<f64>) -> LeaderView {
    LeaderView { position, distance: 0.0, speed: 0.0 }
}

/// Where the seeker is sent, as a point.
fn point(sought: Sought) -> Vector2<f64> {
    match sought {
        Sought::Point(foot) => foot.point,
        other => panic!("{other:?}"),
    }
}

fn near(fragments: &Fragments, expected: &[(f64, f64)], tolerance: f64) -> bool {
    let found = fragments.intervals();
    let near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < tolerance && (a.1 - b.1).abs() < tolerance;
    found.len() == expected.len() && found.iter().zip(expected).all(near)
}

/// A robot under the middle of a trough of sin x: (0, 0) and (pi, 0) are both nearest.
#[test]
fn ties() {
    let curve = wave();
    let segment = Placed::new(&curve, Isometry2::identity());
    let (robot, whole) = (at(FRAC_PI_2, -FRAC_PI_2), (0.0, curve.length()));
    let fragments = Fragments::whole(whole);
    let seek = |leader: Option<LeaderView>| {
        let radii = radii();
        Seeker::default().seek(&SETTINGS, &segment, (whole, &fragments), robot, leader.map(|view| (view, &radii)))
    };
    assert_eq!(seek(Some(LeaderView { position: at(9.0, 0.0), distance: 2.0, speed: 0.0 })), Sought::Tie, "step (5)");
    assert!(point(seek(None)).norm() < 1e-8, "the chain leader decides by arc length");
    assert!((point(seek(None)) - robot).norm() - PI / SQRT_2 < 1e-9);
    assert!((point(seek(Some(resting(at(4.0, 0.0))))) - at(PI, 0.0)).norm() < 1e-8, "step (6)");
    assert!(point(seek(Some(resting(at(-1.0, 0.0))))).norm() < 1e-8, "step (6)");
}

/// Step (6) discards all nearest points out of the attractive zone of a settled leader, however many there are: from the middle of three sides
/// that touch a circle, whichever side the leader is beside.
#[test]
fn three_tied_points() {
    let corners = [at(1.5, 1.0), at(-(3.0_f64.sqrt()), 1.0), at(0.0, -2.0), at(0.9 * 3.0_f64.sqrt(), 0.7)];
    let curve = Curve::new(&CurveShape::Polyline(corners.to_vec()), false, false).unwrap();
    let segment = Placed::new(&curve, Isometry2::identity());
    let whole = (0.0, curve.length());
    let radii = radii();
    let touching = [90.0_f64, 210.0, 330.0].map(|degrees| at(degrees.to_radians().cos(), degrees.to_radians().sin()));
    let second = curve.nearest(touching[1]).arc_length;
    // In one piece, and with the corners cut out.
    let cut = [(second - 2.6, second - 1.8), (second + 1.8, second + 2.0)];
    for fragments in [Fragments::whole(whole), Fragments::beside(&curve, whole, &cut, 0.0)] {
        let seek = |leader: LeaderView| {
            Seeker::default().seek(&SETTINGS, &segment, (whole, &fragments), at(0.0, 0.0), Some((leader, &radii)))
        };
        for touching in touching {
            let found = point(seek(resting(2.5 * touching)));
            assert!((found - touching).norm() < 1e-8, "{found:?}, not {touching:?}");
            assert_eq!(seek(LeaderView { speed: 1.0, ..resting(2.5 * touching) }), Sought::Tie, "step (5)");
        }
    }
}

/// From the centre of an arc all of it is nearest: what of it is in the leader's attractive zone counts.
#[test]
fn arcs_that_tie_as_a_whole() {
    let arc = CurveShape::Arc { centre: at(1.0, 2.0), radius: 5.0, start_angle: 0.0, sweep: PI };
    let curve = Curve::new(&arc, false, false).unwrap();
    let segment = Placed::new(&curve, Isometry2::identity());
    let (whole, radii) = ((0.0, curve.length()), radii());
    for angle in [0.3_f64, 1.5, 3.0] {
        let leader = resting(at(1.0 + 6.0 * angle.cos(), 2.0 + 6.0 * angle.sin()));
        let seek = |leader| {
            let fragments = Fragments::whole(whole);
            Seeker::default().seek(&SETTINGS, &segment, (whole, &fragments), at(1.0, 2.0), Some((leader, &radii)))
        };
        assert!((point(seek(leader)) - leader.position).norm() < radii.rho_check, "{angle}");
        assert_eq!(seek(LeaderView { speed: 1.0, ..leader }), Sought::Tie, "step (5)");
    }
}

/// A robot keeps its nearest point while the other is nearer by less than the margin.
#[test]
fn transits() {
    let curve = wave();
    let segment = Placed::new(&curve, Isometry2::identity());
    let whole = (0.0, curve.length());
    let fragments = Fragments::whole(whole);
    let mut seeker = Seeker::default();
    let mut x_at = |x: f64| point(seeker.seek(&SETTINGS, &segment, (whole, &fragments), at(x, -FRAC_PI_2), None)).x;
    assert!(x_at(FRAC_PI_2 - 0.1) < 0.5);
    assert!(x_at(FRAC_PI_2 + 0.02) < 0.5, "the other is nearer, but by less than the margin");
    assert!(x_at(FRAC_PI_2 + 0.2) > 2.5, "a transit");
    assert!(x_at(FRAC_PI_2 - 0.02) > 2.5, "and not back at once");
    assert!(x_at(FRAC_PI_2 - 0.2) < 0.5);
}

/// A straight segment with a disc on it, the leader settled beyond.
#[test]
fn fragments_trap_unless_the_leader_counts() {
    let curve = Curve::new(&CurveShape::Line(at(0.0, 0.0), at(20.0, 0.0)), false, false).unwrap();
    let segment = Placed::new(&curve, Isometry2::identity());
    let whole = (0.0, curve.length());
    let centre = [at(10.0, 0.0)];
    let fragments = Fragments::find(&segment, whole, &[Outline { points: &centre, radius: 0.5 }], 0.5, SETTINGS.room);
    assert!(near(&fragments, &[(0.0, 9.0), (11.0, 20.0)], 1e-9), "{fragments:?}");
    let radii = radii();
    let seek = |rule: LeaderRule, leader: LeaderView| {
        let settings = SeekSettings { leader_rule: rule, ..SETTINGS };
        let sought =
            Seeker::default().seek(&settings, &segment, (whole, &fragments), at(9.7, 0.5), Some((leader, &radii)));
        point(sought).x
    };
    let moving = LeaderView { speed: 1.0, ..resting(at(12.0, 0.0)) };
    assert!((seek(LeaderRule::StepSix, moving) - 9.0).abs() < 1e-9, "trapped while the leader is under way");
    assert!((seek(LeaderRule::StepSix, resting(at(12.0, 0.0))) - 11.0).abs() < 1e-9);
    assert!((seek(LeaderRule::StepSix, resting(at(10.5, 0.0))) - 9.0).abs() < 1e-9, "near enough");
    assert!((seek(LeaderRule::WholeSegmentWhileFar, moving) - 9.7).abs() < 1e-9);
    let covered = Fragments::find(&segment, whole, &[Outline { points: &centre, radius: 20.0 }], 0.5, SETTINGS.room);
    let sought = Seeker::default().seek(&SETTINGS, &segment, (whole, &covered), at(9.7, 0.5), None);
    assert_eq!(sought, Sought::NoFragment);
}

/// A robot ahead and a disc leave no passage between them: one apparent obstacle, which encroaches as a whole.
#[test]
fn robots_ahead_are_obstacles() {
    let disc = Obstacle { id: 4, shape: Shape::new(&[at(3.0, 0.0)], 0.5).unwrap() };
    let found = apparent_obstacles(&[disc], &[at(4.5, 0.0), at(15.0, 0.0)], 0.25, 1.0, |_, _| false).unwrap();
    assert_eq!(found.iter().map(|obstacle| obstacle.members.clone()).collect::<Vec<_>>(), [vec![4, 5], vec![6]]);
    let curve = Curve::new(&CurveShape::Line(at(0.0, 0.0), at(20.0, 0.0)), false, false).unwrap();
    let segment = Placed::new(&curve, Isometry2::identity());
    let outlines: Vec<Outline<'_>> = found.iter().map(|obstacle| obstacle.shape.outline()).collect();
    let fragments = Fragments::find(&segment, (0.0, 20.0), &outlines, 0.25, 1.0);
    let expected = [(0.0, 2.25), (5.0, 14.5), (15.5, 20.0)];
    assert!(near(&fragments, &expected, 5e-3), "{fragments:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nearest_within_agrees_with_sampling(
        x in -3.0..10.0_f64, y in -4.0..4.0_f64, from in 0.0..0.95_f64, share in 0.0..1.0_f64, shape in 0..3,
    ) {
        let curve = match shape {
            0 => wave(),
            1 => Curve::new(&CurveShape::Polyline(vec![at(0.0, 0.0), at(3.0, 2.0), at(6.0, -1.0)]), true, true).unwrap(),
            _ => Curve::new(&CurveShape::Ellipse { centre: at(3.0, 0.0), semi_axes: [3.0, 1.0], rotation: 0.4 }, false, false)
                .unwrap(),
        };
        let interval = (from * curve.length(), (from + share * (1.0 - from)) * curve.length());
        let found = curve.nearest_within(at(x, y), interval);
        prop_assert!(interval.0 - 1e-9 <= found.arc_length && found.arc_length <= interval.1 + 1e-9, "{found:?}");
        prop_assert!((curve.at(found.arc_length).point - found.point).norm() < 1e-9);
        let sampled = (0..=2000).map(|i| {
            let s = interval.0 + (interval.1 - interval.0) * f64::from(i) / 2000.0;
            (curve.at(s).point - at(x, y)).norm()
        });
        let least = sampled.fold(f64::INFINITY, f64::min);
        prop_assert!(found.distance <= least + 1e-9 && found.distance >= least - curve.length() / 4000.0, "{found:?} {least}");
    }
}

/// An ellipse that begins at the end of its shorter semi-axis, (2, 0), with a gap far from there: one fragment across the beginning, or two
/// with another gap. Seen from within, (-2, 0) is as near as (2, 0).
fn ellipse() -> Curve {
    Curve::new(&CurveShape::Ellipse { centre: at(0.0, 0.0), semi_axes: [2.0, 5.0], rotation: 0.0 }, false, false)
        .unwrap()
}

#[test]
fn a_nearest_point_is_kept_across_the_beginning_of_a_closed_curve() {
    let curve = ellipse();
    let (segment, length) = (Placed::new(&curve, Isometry2::identity()), curve.length());
    let fragments = Fragments::beside(&curve, (0.0, length), &[(5.0, 6.0), (length - 6.0, length - 5.0)], 4.5);
    assert!(near(&fragments, &[(0.0, 5.0), (6.0, length - 6.0), (length - 5.0, length)], 1e-12), "{fragments:?}");
    for way in [1.0, -1.0] {
        let mut seeker = Seeker::default();
        for step in -20..=20 {
            // First nearer to (2, 0), then to the other side, by less than the margin.
            let robot = at(if step < -10 { 0.01 } else { -0.01 }, 0.01 * way * f64::from(step));
            let sought = point(seeker.seek(&SETTINGS, &segment, ((0.0, length), &fragments), robot, None));
            assert!((sought - at(2.0, 0.0)).norm() < 0.5, "{way} {step}: {sought}");
        }
    }
}

/// What goes across the beginning has its ends where it ends, on both sides.
#[test]
fn a_nearest_point_stays_on_a_fragment_across_the_beginning() {
    let curve = ellipse();
    let (segment, length) = (Placed::new(&curve, Isometry2::identity()), curve.length());
    let fragments = Fragments::beside(&curve, (0.0, length), &[(0.3, 6.0), (length - 6.0, length - 0.2)], 0.4);
    for (way, end) in [(1.0, 0.3), (-1.0, length - 0.2)] {
        let mut seeker = Seeker::default();
        for step in 0..=40 {
            let robot = at(if step == 0 { 0.1 } else { -0.005 }, 0.02 * way * f64::from(step - 20));
            let sought = point(seeker.seek(&SETTINGS, &segment, ((0.0, length), &fragments), robot, None));
            assert!(sought.x > 1.9, "{way} {step}: {sought}");
            if step == 40 {
                assert!((sought - curve.at(end).point).norm() < 1e-9, "{way}: {sought}");
            }
        }
    }
}

/// Step (6): where a leader's zone reaches one half, the whole fragment counts.
#[test]
fn a_leader_reaches_a_fragment_across_the_beginning_as_a_whole() {
    let curve = ellipse();
    let (segment, length) = (Placed::new(&curve, Isometry2::identity()), curve.length());
    let fragments = Fragments::beside(&curve, (0.0, length), &[(4.0, 4.2), (length - 4.2, length - 4.0)], 5.0);
    let (leader, robot) = (resting(curve.at(3.0).point), curve.at(length - 0.5).point);
    let sought = point(Seeker::default().seek(
        &SETTINGS,
        &segment,
        ((0.0, length), &fragments),
        robot,
        Some((leader, &radii())),
    ));
    assert!((sought - robot).norm() < 1e-9, "{sought}");
    // The beginning is no end of it, and ties with nothing beside it.
    let beside = curve.at(1e-5).point - at(0.3, 0.0);
    let leader = LeaderView { speed: 1.0, ..resting(at(2.0, 1.0)) };
    let sought =
        Seeker::default().seek(&SETTINGS, &segment, ((0.0, length), &fragments), beside, Some((leader, &radii())));
    assert!(matches!(sought, Sought::Point(_)), "{sought:?}");
}
