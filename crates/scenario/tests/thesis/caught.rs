//! Hulls that spring up beside robots, and robots that are caught: at corners, on segments that move on, across hairpins, behind walls that
//! were seen late.

use super::{TEAM, run_text};
use trench_scenario::{CaseSummary, Sample};

/// Radii of Table 6.2, remedies that wait for a second, and what else is in the file; with what is kept at `moments` (s).
fn case(duration: f64, rest: &str, moments: &[f64]) -> (CaseSummary, Vec<Vec<Sample>>) {
    let text = format!(
        "{TEAM}duration: {duration}
step: 0.001
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2, edge: jump, full_acceleration: 1.0e+4}}
remedies: {{radius: 0.1, patience: 1.0, arrived: 0.05, rising: 0.5}}
{rest}"
    );
    run_text(&text, moments)
}

/// Two discs come nearer than the clearance beside r1, which rests 0.05 m from their hull then: it was thrown away with 70 m/s.
#[test]
fn hulls_that_spring_up_throw_nobody() {
    let moments: Vec<f64> = (0..600).map(|tick| 0.1 * f64::from(tick)).collect();
    let (case, kept) = case(
        60.0,
        "segment: {kind: line, points: [[-40, 0], [40, 0]]}
team_goal: [0, 0]
clearance: 1.2
obstacle_potential: {pole: 0.2, cut: 0.6, strength: 10.0, m: 2, edge: continuous}
encroaching: obstacles
obstacles:
- {disc: [-4.0, -1.05], radius: 1.0, velocity: [0.1, 0]}
- {disc: [2.0, -1.05], radius: 1.0}
robots:
- {position: [0, 0]}
- {position: [-8, 0.5]}
- {position: [-16, 0]}
",
        &moments,
    );
    assert!(case.conforms_after.is_some() && case.collisions.is_empty(), "{case:?}");
    // From 10 s on all rest but for what the hull does; it rises by 0.5 m/s.
    let fastest = kept[100..].iter().flatten().map(|sample| sample.velocity.norm()).fold(0.0, f64::max);
    assert!((0.1..1.5).contains(&fastest), "{fastest}");
}

const CORNER: &str = "segment: {kind: polyline, points: [[0, 0], [30, 0], [30, 30]]}\nteam_goal: [30, 30]\n";

/// Remark 6.2.1: where the corner is nearest, the way goes on along the piece ahead.
#[test]
fn lost_robots_go_round_corners() {
    for start in ["[2, 2.0]", "[2, 0.0]", "[2, -2.0]"] {
        let rest = format!(
            "{CORNER}recovery: {{speed: 1.0}}
robots:
- {{position: [30, 30]}}
- {{position: [30, 22]}}
- {{position: {start}}}
"
        );
        let (case, _) = case(80.0, &rest, &[]);
        assert!(
            case.changes.iter().any(|change| change.change == "lost")
                && case.conforms_after.is_some_and(|after| after < 60.0),
            "{case:?}"
        );
    }
}

/// Remark 8.4.1: the same for whose link is broken.
#[test]
fn retargeted_robots_go_round_corners() {
    let rest = format!(
        "{CORNER}recovery: {{speed: 1.0}}
broken_links:
- {{robot: r2, from: 0.5, to: 140}}
robots:
- {{position: [20, 0]}}
- {{position: [12, 0]}}
- {{position: [4, 0]}}
"
    );
    let (case, _) = case(120.0, &rest, &[]);
    assert!(case.conforms_after.is_some_and(|after| after < 60.0), "{case:?}");
}

/// A robot beyond the vertex that another has, and one between two: what holds them goes along with the segment, whatever its speed.
#[test]
fn segments_that_move_on_carry_who_is_caught() {
    for (speed, robots) in [(0.2, ["[45, 0]", "[48, 0.3]", "[37, 0]"]), (0.3, ["[45, 0]", "[39.5, 0]", "[42.3, 1.5]"])]
    {
        let [first, second, third] = robots;
        let rest = format!(
            "segment: {{kind: line, points: [[0, 0], [45, 0]]}}
team_goal: [45, 0]
segment_motion: {{velocity: [{speed}, 0.0]}}
robots:
- {{position: {first}}}
- {{position: {second}}}
- {{position: {third}}}
"
        );
        let (case, _) = case(60.0, &rest, &[]);
        assert!(case.conforms_after.is_some() && case.neutral_after.is_some(), "{case:?}");
    }
}

/// The leader draws r2 off the near arm of a hairpin: its place is on the other, 75 m on along the segment and 13 m away.
#[test]
fn places_are_found_across_a_hairpin() {
    let (case, _) = case(
        60.0,
        "segment: {kind: polyline, points: [[0, 0], [40, 0], [40, 16], [0, 16]]}
team_goal: [5, 16]
robots:
- {position: [5, 16]}
- {position: [5.5, 4.0]}
",
        &[],
    );
    assert!(case.conforms_after.is_some() && case.neutral_after.is_some(), "{case:?}");
}

/// A robot among walls that open upwards, of which it sees so far (m), and a segment below them.
fn among_walls(walls: &str, start: &str, range: f64) -> CaseSummary {
    let rest = format!(
        "segment: {{kind: line, points: [[-20, 0], [20, 0]]}}
obstacles:
- {{walls: {walls}}}
clearance: 2.0
obstacle_potential: {{pole: 0.0, cut: 1.0, strength: 10.0, m: 2, edge: jump}}
encroaching: obstacles
sight: {{range: {range}, piece: 0.5}}
robots:
- {{position: {start}}}
"
    );
    case(150.0, &rest, &[]).0
}

/// A way out of a hull may turn out to be walled once more is seen: another one is sought.
#[test]
fn out_of_a_trough_of_which_little_is_seen() {
    for (start, range) in [("[0.3, 16]", 4.0), ("[0.3, 16]", 3.0), ("[0.3, 7]", 2.0), ("[0.3, 7]", 6.0)] {
        let case = among_walls("[[-4, 12], [-4, 4], [4, 4], [4, 12]]", start, range);
        assert!(case.conforms_after.is_some() && case.collisions.is_empty(), "{start}, {range} m: {case:?}");
    }
}

/// So it is within a spiral, where ways end before walls that nobody saw.
#[test]
fn out_of_a_spiral_of_which_little_is_seen() {
    let spiral = "[[-6, 14], [-6, 3], [6, 3], [6, 14], [-2, 14], [-2, 7], [2, 7], [2, 10]]";
    for range in [3.0, 6.0] {
        let case = among_walls(spiral, "[0.0, 8.2]", range);
        assert!(case.conforms_after.is_some() && case.collisions.is_empty(), "{range} m: {case:?}");
    }
}
