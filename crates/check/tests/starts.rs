//! Where robots of scenarios begin, and how fast.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helper functions too")]
use trench_check::{Verdict, scenario};

/// The verdicts of a check on a scenario file.
fn judged(text: &str, check: &str) -> Vec<Verdict> {
    let verdicts = scenario("it", &trench_scenario::parse("it.yaml", text).unwrap());
    verdicts.into_iter().filter(|verdict| verdict.check == check).collect()
}

/// A shipped scenario with parts of its text replaced.
fn shipped(name: &str, replaced: &[(&str, &str)]) -> String {
    let path = format!("{}/../../config/scenarios/{name}", env!("CARGO_MANIFEST_DIR"));
    replaced.iter().fold(std::fs::read_to_string(path).unwrap(), |text, (old, new)| {
        assert!(text.contains(old), "{old:?} must stand in {name}");
        text.replace(old, new)
    })
}

/// The one verdict of a check: whether it holds, whether it is a note, and parts of what was found.
fn check(text: &str, name: &str, (holds, note): (bool, bool), parts: &[&str]) {
    let [verdict] = &judged(text, name)[..] else { panic!("{:#?}", judged(text, name)) };
    assert_eq!((verdict.holds, verdict.note), (holds, note), "{verdict:#?}");
    for part in parts {
        assert!(verdict.finding.contains(part), "{part:?} in {verdict:#?}");
    }
}

/// r10 of Table 6.1, and where it is 15.27 m from its leader.
const NEAR: &str = "{position: [0.7206, -1.0582], velocity: [0.6721, -0.6983]}";
const FAR: &str = "{position: [-9.0, -8.0], velocity: [0, 0]}";
const FULL: &str = "full_acceleration: 1.0e+4";

/// As chains were run (docs/check.md): with full acceleration they whip, with forces like the trench's they do not.
#[test]
fn followers_that_zone_5_draws() {
    let begins = "r10 begins 15.27 m from its leader r9, beyond rho_check = 13 m";
    let remedies =
        "begin within 12.69 m, or make rho and rho_check 2.578 m larger, or make zoning.full_acceleration 66.3";
    assert_eq!(judged(&shipped("7.10.yaml", &[]), "starts"), []);
    check(
        &shipped("7.10.yaml", &[(NEAR, FAR)]),
        "starts",
        (false, false),
        &[begins, "makes it 216.2 m/s fast", remedies],
    );
    // Law (6.1).
    assert_eq!(judged(&shipped("6.5.yaml", &[]), "starts"), []);
    let beside = shipped("6.5.yaml", &[(NEAR, "{position: [-4.0, 16.0]}")]);
    check(&beside, "starts", (false, false), &["r10 begins 14.06 m from its leader r9"]);
    let bounded = |full: &str| {
        let full = format!("full_acceleration: {full}");
        shipped("7.10.yaml", &[(NEAR, FAR), (FULL, &full)])
    };
    // The trench pulls with 10 m/s^2.
    for full in ["10.1", "20.0", "50.0", "66.3"] {
        check(&bounded(full), "starts", (true, false), &["outside of zone 2"]);
    }
    check(&bounded("100.0"), "starts", (true, true), &["bounces", "in zone 2", "some whipped"]);
    check(&bounded("500.0"), "starts", (false, false), &["through zone 2"]);
}

/// Beside the pole zone 4 draws as hard; limits bound what it makes of a robot.
#[test]
fn followers_beside_the_pole_and_within_limits() {
    let at = |x: f64, besides: &str| {
        format!(
            "\
name: two
kind: nearest_points
duration: 1.0
step: 0.001
method: semi_implicit_euler
segment: {{kind: line, points: [[0, 0], [40, 0]]}}
trench: {{kind: hyperbolic, alpha: 10.0, a: 1.0}}
damping: 5.0
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2}}
obstacle_potential: {{pole: 1.0, cut: 2.0, strength: 10.0, m: 2}}
{besides}robots:
- {{position: [3, 4]}}
- {{position: [{x}, 4]}}
"
        )
    };
    assert_eq!(judged(&at(15.5, ""), "starts"), []);
    check(&at(15.99, ""), "starts", (true, true), &["r2 begins 12.99 m from its leader r1, close to the pole"]);
    check(&at(17.0, ""), "starts", (false, false), &["r2 begins 14 m"]);
    let limits = "limits: {speed: 4.0, acceleration: 20.0}\n";
    check(&at(17.0, limits), "starts", (true, false), &["limits.acceleration = 20 m/s^2", "makes it 4 m/s fast"]);
}

/// Chapter 7 on 40 m, with what a test adds.
fn on_40_m(besides: &str) -> String {
    format!(
        "\
name: it
kind: nearest_points
duration: 20.0
step: 0.001
method: semi_implicit_euler
segment: {{kind: line, points: [[0, 0], [40, 0]]}}
trench: {{kind: hyperbolic, alpha: 0.5, a: 1.0}}
damping: 2.0
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 1.0, beta: 1.0, m: 2, full_acceleration: 1.0}}
clearance: 4.0
encroaching: obstacles
obstacle_potential: {{pole: 1.0, cut: 2.0, strength: 10.0, m: 2, full_acceleration: 8.0}}
{besides}"
    )
}

/// Who begins faster than the limit comes at walls with its own speed, not with the limit's.
#[test]
fn who_begins_faster_than_the_limit() {
    let with = |velocities: [f64; 2], obstacle: &str| {
        let [one, other] = velocities;
        on_40_m(&format!(
            "\
obstacles:
- {{disc: [60, 4], radius: 2{obstacle}}}
limits: {{speed: 1.2, acceleration: 10.0}}
robots:
- {{position: [9, 4], velocity: [{one}, 0]}}
- {{position: [3, 4], velocity: [{other}, 0]}}
"
        ))
    };
    let at_obstacles = |text: &str, told: &str| check(text, "walls", (true, true), &[told, "limits.speed = 1.2"]);
    at_obstacles(&with([0.0, 50.0], ""), "Who comes at obstacles at 50 m/s (with which r2 begins, above");
    at_obstacles(&with([50.0, 3.0], ""), "Who comes at obstacles at 50 m/s (with which r1 begins, above");
    at_obstacles(&with([50.0, 0.0], ", velocity: [-1, 0]"), "at obstacles at 51 m/s (with which r1 begins");
    // Below the pull over damping, 0.25 m/s, nothing has changed, and below the limit it is no excess.
    check(&with([0.1, 0.2], ""), "walls", (true, true), &["at zones at 0.25 m/s (pull over damping) has"]);
    check(&with([0.1, 0.6], ""), "walls", (true, true), &["at zones at 0.6 m/s (with which r2 begins) has"]);
}

/// A filter keeps those apart whose ways to stop are: bodies that have no room to begin with overlap, and stand so for good.
#[test]
fn bodies_begin_with_room_to_stop() {
    let with = |obstacles: &str, robots: &str| {
        let besides = "limits: {speed: 1.2, acceleration: 2.0}\nsafety: {body_radius: 0.5}";
        on_40_m(&format!("{obstacles}{besides}\nrobots:\n{robots}"))
    };
    let pair = |x: f64, speed: f64| {
        let (one, other) = ("[3, 4], velocity: [1.2, 0]", format!("[{x}, 4], velocity: [{speed}, 0]"));
        with("", &format!("- {{position: {one}}}\n- {{position: {other}}}\n"))
    };
    let parts = [
        "r1 and r2: 0.3 m are between them, they close at 2.4 m/s, and need 0.36 and 0.36 m to stop with 2 m/s^2",
        "0.42 m are missing",
        "so much farther apart, or slower",
    ];
    check(&pair(4.3, -1.2), "stopping", (false, false), &parts);
    check(&pair(4.71, -1.2), "stopping", (false, false), &["0.01 m are missing"]);
    check(&pair(4.73, -1.2), "stopping", (true, false), &["all 2 begin with room to stop"]);
    // Who goes the same way leaves room; the ways are too near each other all the same.
    check(&pair(4.3, 1.2), "stopping", (true, true), &["Braking at once they do not touch"]);
    check(&pair(4.4, 1.2), "stopping", (true, false), &[]);
    let disc = "obstacles:\n- {disc: [6, 4], radius: 2}\n";
    let robot = |x: f64, velocity: &str| format!("- {{position: [{x}, 4], velocity: {velocity}}}\n");
    let before =
        ["r1 and obstacle 1: 0.2 m are between them, they close at 1.2 m/s, and need 0.36 m", "0.16 m are missing"];
    check(&with(disc, &robot(3.3, "[1.2, 0]")), "stopping", (false, false), &before);
    check(&with(disc, &robot(3.1, "[1.2, 0]")), "stopping", (true, false), &[]);
    check(&with(disc, &robot(3.3, "[-1.2, 0]")), "stopping", (true, false), &[]);
    // Faster than they are allowed: ways are those of the start.
    check(&with(disc, &robot(-5.0, "[6.0, 0]")), "stopping", (false, false), &["need 9 m to stop"]);
    // Ways that cross.
    let crossing = "- {position: [10, 4], velocity: [4, 0]}\n- {position: [12, 2.5], velocity: [0, 4]}\n";
    check(&with("", crossing), "stopping", (false, false), &["r1 and r2"]);
    // Without a filter nobody promises anything.
    assert_eq!(judged(&on_40_m(&format!("robots:\n{}", robot(3.3, "[1.2, 0]"))), "stopping"), []);
}

/// Nobody stands in an obstacle: a team goal there keeps r1 off for good, one that an obstacle passes over for a while.
#[test]
fn team_goals_among_obstacles() {
    let at = |goal: &str, obstacles: &str| {
        let robots = "robots:\n- {position: [3, 9]}\n- {position: [9, 9]}\n";
        on_40_m(&format!("team_goal: {goal}\nobstacles:\n{obstacles}{robots}"))
    };
    let disc = "- {disc: [20, 0], radius: 2}\n";
    let inside = ["team_goal lies 2 m inside obstacle 1", "r1 is kept off", "move team_goal or the obstacle 4 m apart"];
    check(&at("[20, 0]", disc), "goal", (false, false), &inside);
    check(
        &at("[22.5, 0]", disc),
        "goal",
        (false, false),
        &["0.5 m from obstacle 1", "within 1 m of it", "1.5 m apart"],
    );
    check(&at("[23.5, 0]", disc), "goal", (true, true), &["1.5 m from obstacle 1, which pushes", "beside the goal"]);
    assert_eq!(judged(&at("[24.5, 0]", disc), "goal"), []);
    // Between two that are one hull.
    let two = "- {disc: [18, 0], radius: 0.5}\n- {disc: [22, 0], radius: 0.5}\n";
    check(&at("[20, 0]", two), "goal", (false, false), &["0.5 m inside the hull of obstacles 1, 2"]);
    // Down from y = 10 at 1 m/s: nobody stands at the goal while the outline is within a metre.
    let passing = "- {disc: [20, 10], radius: 2, velocity: [0, -1]}\n";
    check(
        &at("[20, 0]", passing),
        "goal",
        (true, true),
        &["2 m inside obstacle 1", "at 10.0 s", "from about 7.1 s to 12.9 s"],
    );
    let staying = "- {disc: [20, 10], radius: 2, velocity: [0, -0.5]}\n";
    check(&at("[20, 0]", staying), "goal", (true, true), &["at 20.0 s", "from about 14.1 s to the end"]);
    assert_eq!(judged(&at("[35, 0]", passing), "goal"), []);
}
