//! Who was led away, or has lost its team, comes back gently; nobody stays where zoning does not let it; ways out of hulls that grow.

use super::{TEAM, run_scenario, run_text, scenario_with};
use trench_scenario::CaseSummary;

/// Radii of Table 6.2, remedies, and what else is in the file.
fn case(duration: f64, rest: &str) -> CaseSummary {
    let text = format!(
        "{TEAM}duration: {duration}
step: 0.002
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2, edge: continuous, full_acceleration: 1.0e+3}}
clearance: 1.6
obstacle_potential: {{pole: 0.2, cut: 1.2, strength: 10.0, m: 2, edge: continuous}}
encroaching: obstacles
remedies: {{radius: 0.1, patience: 1.0, arrived: 0.05, rising: 1.0}}
{rest}"
    );
    run_text(&text, &[]).0
}

fn least_gap(case: &CaseSummary) -> f64 {
    case.obstacles.iter().map(|obstacle| obstacle.least_gap).fold(f64::INFINITY, f64::min)
}

/// r3 is led round obstacles, and is 23 m behind r2 then: the full acceleration of zone 5 threw it through a wall at 100 m/s.
#[test]
fn who_was_led_away_comes_back_gently() {
    let case = case(
        60.0,
        "segment: {kind: spline, points: [[-40.0,0.0],[-15.0,8.0],[10.0,-6.0],[40.0,2.0]]}
obstacles:
- {disc: [-7.601, -0.645], radius: 2.666}
- {polygon: [[0.838, 12.479], [-0.06, 12.935], [-0.526, 12.16], [0.298, 11.581]]}
- {walls: [[8.653, -1.098], [7.222, -0.875], [6.776, -3.735], [8.206, -3.958]]}
- {disc: [25.430, 7.037], radius: 2.436}
- {polygon: [[15.939, -0.909], [14.369, -0.11], [13.553, -1.465], [14.995, -2.478]]}
robots:
- {position: [17.79, 22.64]}
- {position: [11.47, 22.22]}
- {position: [6.29, 20.39]}
- {position: [0.37, 18.42]}
- {position: [-4.95, 20.0]}
",
    );
    assert!(case.conforms_after.is_some() && case.neutral_after.is_some(), "{case:?}");
    assert!(least_gap(&case) > 0.5 && case.closest_pair.unwrap() > 2.0, "{case:?}");
}

/// A corridor with a bend at right angles, its walls 4 m apart: nobody goes through them.
#[test]
fn a_right_angled_corridor() {
    let bend = [
        ("[62.0, 22.0]", "[40.0, 30.0]"),
        ("[40.8, -2.0], [54.8, 12.0]", "[42.0, -2.0], [42.0, 12.0]"),
        ("[39.2, 2.0], [51.2, 14.0]", "[38.0, 2.0], [38.0, 12.0]"),
        (
            "team_goal: [60.0, 20.0]",
            "remedies: {radius: 0.1, patience: 1.0, arrived: 0.05, rising: 1.0}\nsidesteps: true\nteam_goal: [40.0, 24.0]",
        ),
    ];
    let case = run_scenario(&scenario_with("9.1_bent_corridor.yaml", &bend), &[]).0.cases.remove(0);
    assert!(case.conforms_after.is_some() && case.neutral_after.is_some(), "{case:?}");
    assert!(least_gap(&case) > 0.05 && case.closest_pair.unwrap() > 4.0, "{case:?}");
}

/// r2 is drawn to the end of a fragment that lies in the zone 2 of r1: it goes to the other side of the obstacle.
#[test]
fn nobody_stays_where_zoning_does_not_let_it() {
    let case = case(
        60.0,
        "segment: {kind: circle, centre: [0.0, -10.0], radius: 18.0}
obstacles:
- {walls: [[-3.807, 8.188], [-4.717, 7.737], [-3.816, 5.918], [-2.906, 6.368]]}
robots:
- {position: [0.69, 20.94]}
- {position: [-3.96, 22.75]}
- {position: [-9.96, 22.19]}
",
    );
    assert!(case.conforms_after.is_some() && case.neutral_after.is_some(), "{case:?}");
}

/// Remark 6.2.1: the way along the segment to the team leads round what stands on it.
#[test]
fn who_has_lost_its_team_goes_round_what_stands_on_the_segment() {
    let case = case(
        60.0,
        "segment: {kind: line, points: [[-60.0, 0.0], [60.0, 0.0]]}
team_goal: [50.0, 0.0]
obstacles:
- {disc: [20.0, 0.0], radius: 2.0}
recovery: {speed: 2.0}
robots:
- {position: [50.0, 1.0]}
- {position: [44.0, 2.0]}
- {position: [-10.0, 3.0]}
- {position: [-16.0, 3.0]}
",
    );
    assert!(case.conforms_after.is_some() && case.neutral_after.is_some(), "{case:?}");
    assert!(least_gap(&case) > 0.3 && case.closest_pair.unwrap() > 4.0, "{case:?}");
}

/// Remark 8.4.1: r3 follows as soon as its link is whole, though its leader is not in its neutral zone, and r1 stands between them.
#[test]
fn whose_link_is_whole_again_follows_at_once() {
    let case = case(
        60.0,
        "segment: {kind: line, points: [[-60.0, 0.0], [60.0, 0.0]]}
team_goal: [-20.0, 0.0]
recovery: {speed: 2.0}
broken_links:
- {robot: r3, from: 2.0, to: 6.0}
robots:
- {position: [20.0, 1.0]}
- {position: [14.0, 2.0]}
- {position: [8.0, 3.0]}
- {position: [2.0, 3.0]}
",
    );
    let times: Vec<f64> = case.changes.iter().map(|change| change.time).collect();
    assert!(times.len() == 2 && (times[1] - 6.0).abs() < 0.01, "{:?}", case.changes);
    assert!(case.conforms_after.is_some() && case.closest_pair.unwrap() > 1.0, "{case:?}");
}

/// A trough of which robots know more the deeper they are in it: where a way out ends, there is hull by then.
#[test]
fn ways_out_of_a_hull_that_grows() {
    let trough = [
        ("duration: 150.0", "duration: 300.0"),
        ("step: 0.001", "step: 0.002"),
        (
            "[[-6.0, 6.0], [-6.0, 3.0], [-0.6, 3.0], [-0.6, 6.0]]",
            "[[-8.0, 10.0], [-8.0, 3.0], [8.0, 3.0], [8.0, 10.0]]",
        ),
        ("- {walls: [[0.6, 6.0], [0.6, 3.0], [4.0, 3.0], [4.0, 6.0]]}\n", ""),
    ];
    let case = run_scenario(&scenario_with("7.6_partial_boundaries.yaml", &trough), &[]).0.cases.remove(0);
    assert!(case.conforms_after.is_some_and(|time| time < 250.0), "{case:?}");
    assert!(least_gap(&case) > 0.02 && case.in_zone_1 == Some(0.0), "{case:?}");
}
