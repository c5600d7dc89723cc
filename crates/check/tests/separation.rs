//! Goal points, and places of queues, at which robots cannot all stand.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
use trench_check::Verdict;

/// The verdicts `separation` on a file; what fails must be told by `trench sim`, too.
fn judged(text: &str) -> Vec<Verdict> {
    let parsed = trench_scenario::parse("it", text).unwrap();
    let of = |verdicts: Vec<Verdict>| verdicts.into_iter().filter(|verdict| verdict.check == "separation").collect();
    let found: Vec<Verdict> = of(trench_check::scenario("it", &parsed));
    let failed: Vec<Verdict> = found.iter().filter(|verdict| !verdict.holds).cloned().collect();
    assert_eq!(of(trench_check::infeasible("it", &parsed)), failed);
    found
}

fn check(text: &str, holds: bool, parts: &[&str]) {
    let found = judged(text);
    assert!(!found.is_empty() && found.iter().all(|verdict| verdict.holds == holds), "{found:#?}");
    for part in parts {
        assert!(found[0].finding.contains(part), "{part:?} in {found:#?}");
    }
}

/// Five robots, far enough from one another at the start.
const FIVE: &str = "
- {position: [42, 5]}
- {position: [40.5, 5]}
- {position: [39, 5]}
- {position: [37.5, 5]}
- {position: [36, 5]}
";

/// Robots that track goal points, 20 s long.
fn goals(goals: &str, bodies: &str) -> String {
    format!(
        "\
name: it
kind: goal_tracking
duration: 20.0
step: 0.01
method: semi_implicit_euler
tolerance: 0.1
goals: {{first: 42.0, {goals}}}
cases:
- {{name: one, law: {{kind: trench, trench: {{kind: hyperbolic, alpha: 2.5, a: 2.0}}, damping: 2.0}}}}
- {{name: two, law: {{kind: trench, trench: {{kind: hyperbolic, alpha: 2.5, a: 2.0}}, damping: 3.0}}{bodies}}}
robots:{FIVE}"
    )
}

#[test]
fn goal_points() {
    let bodies = ", limits: {speed: 2.0, acceleration: 9.0}, safety: {body_radius: 0.4, margin: 0.1}";
    let wave = "speed: 1.0, amplitude: 1.0, wave_number: 0.5";
    // The first alone ever conformed, and every verdict held. Bodies are a case's own.
    let near = judged(&goals(&format!("spacing: 0.6, {wave}"), bodies));
    assert!(near[0].holds && !near[1].holds && near.len() == 2, "{near:#?}");
    assert_eq!(near[1].subjects, ["it, case two"]);
    let told = "goal points of r1 and r2 come to 0.6 m of each other, at 5.42 s, but two bodies of R + margin = 0.5 m need 1 m";
    assert!(
        near[1].finding.starts_with(told)
            && near[1].finding.ends_with("make goals.spacing 1 m or more, which is enough on any wave")
    );
    check(&goals(&format!("spacing: 1.0, {wave}"), bodies), true, &["more than the tolerance of 0.1 m"]);
    // Steep enough while nothing moves; not once the wave's crests are passed.
    let steep = |speed: &str| {
        goals(&format!("spacing: 0.6, speed: {speed}, amplitude: 1.0, wave_number: 5.235988, phase: 1.5708"), bodies)
    };
    assert!(judged(&steep("0.0")).iter().all(|verdict| verdict.holds));
    assert!(!judged(&steep("1.0"))[1].holds);
    // Points are apart where they are told apart.
    check(&goals(&format!("spacing: 0.1, {wave}"), ""), false, &["make goals.spacing more than 0.1 m"]);
    check(&goals(&format!("spacing: 0.11, {wave}"), ""), true, &[]);
    check(&goals("spacing: 0.0, speed: 1.0", ""), false, &["goal points of r1 and r2 are 0 m apart"]);
}

/// A queue of five, who may have more to say.
fn queue(segment: &str, spacing: f64, besides: &str, robots: &str) -> String {
    format!(
        "\
name: it
kind: queue
duration: 60.0
step: 0.01
method: semi_implicit_euler
limits: {{speed: 2.0, acceleration: 4.0}}
segment: {segment}
spacing: {spacing}
law: {{poles: [-1.0, -2.0]}}
{besides}
robots:{robots}"
    )
}

#[test]
fn places_of_queues() {
    let bodies = "safety: {body_radius: 0.5}";
    let line = "{kind: line, points: [[0, 0], [40, 0]]}\ntarget: [40, 0]";
    let near =
        "place 1 and place 2 are 0.8 m apart, but two bodies of R + margin = 0.5 m need 1 m: make spacing 1 m or more";
    check(&queue(line, 0.8, bodies, FIVE), false, &[near]);
    check(&queue(line, 1.0, bodies, FIVE), true, &[]);
    check(&queue(line, 0.8, "", FIVE), true, &["more than the tolerance of 0.05 m"]);
    check(&queue(line, 0.05, "", FIVE), false, &["make spacing more than 0.05 m"]);
    // There and back, 0.3 m beside: neighbours along the way are far from each other, and so nobody saw.
    let hairpin = "{kind: polyline, points: [[0, 0], [10, 0], [10, 0.3], [0, 0.3]]}\ntarget: [0, 0.3]";
    check(
        &queue(hairpin, 5.0, bodies, FIVE),
        false,
        &["place 2 and place 4 are 0.4243 m apart", "comes back to itself there, 10 m farther along it"],
    );
    check(&queue(hairpin, 5.0, "", FIVE), true, &[]);
    // Round a circle of 37.7 m the last place is beside the first.
    let circle = "{kind: circle, centre: [20, 0], radius: 6}\ntarget: [26, 0]";
    check(&queue(circle, 7.5, bodies, FIVE), true, &[]);
    let round = trench_scenario::parse("it", &queue(circle, 7.6, bodies, FIVE)).unwrap_err().to_string();
    assert!(
        round.contains("it:9: spacing = 7.6: leaves no places for 5 robots: round the closed segment they need 38 m"),
        "{round}"
    );
    // One robot has nobody beside it.
    assert!(judged(&queue(line, 0.8, bodies, "\n- {position: [40, 5]}\n")).is_empty());
}

/// Points beside the queue count while somebody is there.
#[test]
fn points_beside_queues() {
    let line = "{kind: line, points: [[0, 0], [40, 0]]}\ntarget: [40, 0]";
    let with = |robots: &str| queue(line, 4.0, "", robots);
    let both = "\n- {position: [40, 2], quits: {at: 5, to: [45, 12]}}\n- {position: [36, 2], quits: {at: 9, to: [45, 12.04]}}\n- {position: [32, 2]}\n";
    check(
        &with(both),
        false,
        &["the point to which r1 quits and the point to which r2 quits are 0.04 m apart", "write another point"],
    );
    // Where r1 went to there is a place; the third one is free for good once it has gone.
    let to = |place: &str| with(&both.replace("12.04", "14").replace("[45, 12]", place));
    check(&to("[36, 0]"), false, &["place 2 and the point to which r1 quits are 0 m apart"]);
    check(&to("[32, 0]"), true, &[]);
    // Who waits where nobody is yet waits well.
    let waits = |at: &str| {
        with(&format!("\n- {{position: [40, 2]}}\n- {{position: [36, 2]}}\n- {{position: {at}, joins: 9}}\n"))
    };
    check(&waits("[32, 0]"), true, &[]);
    check(&waits("[36, 0]"), false, &["place 2 and the point where r3 waits until it joins are 0 m apart"]);
}
