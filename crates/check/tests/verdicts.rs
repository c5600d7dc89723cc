//! The texts of verdicts that depend on numbers alone.

use trench_check::{Approach, ChainOfRobots, Team, Values, Verdict, chain, direction, formation, potential, zones};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Placed};
use trench_formation::trench::{Conic, Hyperbolic, Quadratic};

fn check(verdict: &Verdict, holds: bool, finding: &str) {
    assert_eq!((verdict.holds, verdict.finding.as_str()), (holds, finding), "{verdict:?}");
}

#[test]
fn zones_are_in_order_and_larger_than_robots() {
    check(
        &zones("bed", [0.20, 0.26, 0.34, 0.45, 1.2], 0.08),
        true,
        "0.2 < 0.26 < 0.34 < 0.45 < 1.2 m are in order; bodies touch at 0.16 m",
    );
    check(
        &zones("bed", [0.12, 0.26, 0.34, 0.45, 1.2], 0.08),
        false,
        "rho_underbar = 0.12 m, but bodies touch at 0.16 m: make it at least 0.16",
    );
    check(
        &zones("bed", [0.20, 0.34, 0.26, 0.45, 1.2], 0.08),
        false,
        "rho_hat = 0.34 and rho = 0.26 are out of order (6.2.2): rho_hat must be below rho",
    );
}

#[test]
fn potentials_are_admissible_or_not() {
    check(
        &potential("a", &Hyperbolic { alpha: 0.3, a: 0.3 }, 100.0),
        true,
        "admissible up to 100 m (proved), pulls with at most 0.3 m/s^2",
    );
    check(
        &potential("a", &Quadratic { alpha: -1.0 }, 100.0),
        false,
        "the potential does not pull towards 0 at x = 0.00000009 (slope -0.00000009): a robot \
         beyond would be trapped; x phi(x) must be positive (Definition 5.2.1, strengthened)",
    );
    assert!(!potential("a", &Conic { alpha: -1.0 }, 10.0).holds);
}

#[test]
fn chains_are_bounded_rank_by_rank() {
    let of = ChainOfRobots {
        instead_of: None,
        robots: 4,
        gains: (2.0, 3.0),
        initial_error: 0.02,
        by_rank: &[],
        tolerance: 0.06,
        setting_out: 0.0,
        acceleration: None,
    };
    check(
        &chain("line", &of),
        true,
        "the linear queue law (8.11) with K = (2, 3) and errors of 0.02 at the start: rank 4 stays within 0.06 (0.03932; by (8.26) 6453), as up to 9 robots in one chain would; by rank 0.02034, \
         0.02963, 0.0354, 0.03932",
    );
    check(
        &chain("line", &ChainOfRobots { robots: 10, tolerance: 0.05, ..of }),
        false,
        "the linear queue law (8.11) with K = (2, 3) and errors of 0.02 at the start: rank 8 may leave 0.05 (0.05416; by (8.26) 4e10): at most 7 robots in one \
         chain stay within; by rank 0.02034, 0.02963, 0.0354, 0.03932, 0.04236, 0.04559, 0.04958, 0.05416, ...",
    );
    check(
        &chain("line", &ChainOfRobots { gains: (2.0, -3.0), ..of }),
        false,
        "K = (2, -3): robot 1 of the chain: the closed loop A - B K is not Hurwitz: its error does not decay (Theorem 8.2.1 needs a gain \
         K that makes it so)",
    );
}

/// Robots with K = (2, 3) that begin within 0.02 of their places.
fn with_tolerance(robots: usize, tolerance: f64) -> ChainOfRobots<'static> {
    ChainOfRobots {
        instead_of: None,
        robots,
        gains: (2.0, 3.0),
        initial_error: 0.02,
        by_rank: &[],
        tolerance,
        setting_out: 0.0,
        acceleration: None,
    }
}

/// As many ranks are computed as there are robots, up to 100; of more nothing is promised, and that is said.
#[test]
fn long_chains_are_computed_to_their_end() {
    for robots in [13, 30] {
        let verdict = chain("line", &with_tolerance(robots, 1.0));
        assert!(verdict.holds && verdict.finding.contains(&format!("rank {robots} stays within 1 (")), "{verdict:?}");
    }
    let some = chain("line", &with_tolerance(30, 0.06));
    assert!(!some.holds && some.finding.contains("at most 9 robots in one chain stay within"), "{some:?}");
    let many = chain("line", &with_tolerance(101, 1e9));
    assert!(
        !many.holds && many.finding.contains("ranks beyond 100 are not computed, and not promised anything"),
        "{many:?}"
    );
}

/// All ranks are told to programs, and the longest chain within the tolerance whether or not this one is.
#[test]
fn ranks_and_the_longest_chain_are_values() {
    let of = |robots, tolerance| match chain("line", &with_tolerance(robots, tolerance)).values {
        Some(Values::Chain { bounds, recursive_bounds, longest, computed }) => {
            assert_eq!(bounds.len(), recursive_bounds.len());
            assert!(bounds.windows(2).all(|pair| pair[0] < pair[1]), "{bounds:?}");
            (bounds, longest, computed)
        }
        other => panic!("{other:?}"),
    };
    let (ten, longest, _) = of(10, 0.05);
    assert_eq!((ten.len(), longest), (10, 7));
    assert!((ten[8] - 0.0592).abs() < 1e-3 && (ten[9] - 0.06464).abs() < 1e-5, "{ten:?}");
    let (four, longest, _) = of(4, 0.06);
    assert_eq!((four.len(), longest), (4, 9));
    assert!(four.iter().zip(&ten).all(|(short, long)| (short - long).abs() < 1e-9), "{four:?} {ten:?}");
    let (_, longest, computed) = of(2, 1e9);
    assert_eq!((longest, computed), (100, 100), "no rank of a hundred leaves");
    let (two, longest, _) = of(2, 1e-9);
    assert_eq!((two.len(), longest), (2, 0));
}

/// config/profiles/chain.yaml on its columns: k = 2 and c = 0.5 are 2.5.
#[test]
fn what_the_bound_is_not_about_is_said() {
    check(
        &chain(
            "line",
            &ChainOfRobots {
                instead_of: Some("chain"),
                robots: 4,
                gains: (2.5, 2.5),
                initial_error: 0.05,
                by_rank: &[],
                tolerance: 0.14,
                setting_out: 0.0,
                acceleration: None,
            },
        ),
        true,
        "the linear queue law (8.11) with K = (2.5, 2.5) and errors of 0.05 at the start: rank 4 stays within 0.14 (0.1073; by (8.26) \
         7530), as up to 6 robots in one chain would; by rank 0.05253, 0.07935, 0.09611, 0.1073; law chain has these gains at the bottom of its trench, but is not this law: zones, \
         limits, obstacles are not in the bound",
    );
}

#[test]
fn directions_are_proper_or_not() {
    let arc = CurveShape::Arc { centre: Vector2::zeros(), radius: 2.0, start_angle: 0.0, sweep: core::f64::consts::PI };
    let curve = Curve::new(&arc, false, false).unwrap();
    let place = Placed::new(&curve, nalgebra::Isometry2::translation(10.0, 0.0));
    let approach = Approach {
        position: Vector2::new(9.0, -3.0),
        velocity: Vector2::new(1.0, 0.5),
        direction: Vector2::new(0.0, 1.0),
        damping: 2.0,
    };
    check(
        &direction("r1", &place, &approach),
        true,
        "across the direction the robot keeps to [9, 9.5] m, the segment spans [8, 12] m",
    );
    let fast = Approach { velocity: Vector2::new(8.0, 0.0), ..approach };
    check(
        &direction("r1", &place, &fast),
        false,
        "across the direction the robot keeps to [9, 13] m, but the segment spans [8, 12] m: turn the direction, or make the \
         segment 1 m longer there",
    );
    assert!(!direction("r1", &place, &Approach { damping: 0.0, ..approach }).holds);
}

const CHAIN: &str = "\
name: chain
queues:
- name: line
  segment: {kind: line, points: [[0.2, 0.5], [2.3, 0.5]]}
  vertices: [[2.2, 0.5]]
  chain: {robots: 6, spacing: 0.30}
  share: 1.0
  tolerance: 0.01
";

#[test]
fn chains_on_segments() {
    let team = Team {
        robots: Some(6),
        radius: 0.08,
        margin: 0.01,
        wheel_speed: 0.29,
        field: [[0.0, 2.48], [0.0, 1.83]],
        approach_gain: 1.0,
        feeds_forward: true,
        zones: Some([0.20, 0.26, 0.34, 0.45, 1.2]),
        chain_gains: Some((1.0, 2.0)),
        law: "chain".to_owned(),
        acceleration: 0.45,
        along: None,
        starts: Vec::new(),
    };
    let judged = |text: &str, team: &Team| formation("f", &trench_plan::parse("f.yaml", text).unwrap(), team);
    let one = |verdicts: &[Verdict], name: &str| verdicts.iter().find(|verdict| verdict.check == name).unwrap().clone();
    let good = judged(CHAIN, &team);
    assert!(good.iter().all(|verdict| verdict.holds), "{good:?}");
    check(
        &one(&good, "room"),
        true,
        "6 robots need 1.3 m of segment, which is 2.1 m long; places 0.3 m apart are neutral",
    );
    let wide = judged(&CHAIN.replace("0.30", "0.40"), &team);
    check(
        &one(&wide, "room"),
        true,
        "6 robots need 1.3 m of segment, which is 2.1 m long; places 0.4 m apart will be left for the neutral zone, 0.26 to 0.34 m",
    );
    let touching = judged(&CHAIN.replace("0.30", "0.20"), &team);
    check(&one(&touching, "room"), false, "places are 0.2 m apart, outside zones 2 to 4: take 0.26 to 0.34 m");
    let wider = Team { zones: Some([0.20, 0.46, 0.54, 0.65, 1.2]), ..team.clone() };
    check(
        &one(&judged(CHAIN, &wider), "room"),
        false,
        "6 robots need 2.3 m of segment, but it is 2.1 m long: at most 5 robots fit",
    );
    let many = Team { robots: Some(8), ..team.clone() };
    check(
        &one(&judged(CHAIN, &many), "places"),
        false,
        "queue line gets 8 of 8 robots, but has 6 places: give it more vertices or a smaller share",
    );
}
