//! What is wrong with a scenario file is said with file, line, key, problem and remedy.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helper functions too")]

use trench_scenario::{is_scenario, parse};

fn file(name: &str) -> String {
    std::fs::read_to_string(format!("{}/../../config/scenarios/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Replaces `old` in a scenario file and checks that the error names file and line of `new`, says what would be right, and has the texts
/// expected.
fn check(name: &str, old: &str, new: &str, expected: &[&str]) {
    let text = file(name).replace(old, new);
    let line = told(name, old, new, expected);
    // That of the mistake, or of the list or mapping that it is in.
    let first = text[..text.find(new).unwrap()].lines().count().max(1);
    assert!((first - 1..=first + 1 + new.lines().count()).contains(&line), "line {line}, not about {first}");
}

/// The line that is named, wherever that is.
fn told(name: &str, old: &str, new: &str, expected: &[&str]) -> usize {
    let text = file(name);
    assert_eq!(text.matches(old).count(), 1, "{old:?} must stand once in {name}");
    let text = text.replace(old, new);
    let error = match parse(name, &text) {
        Err(error) => error,
        Ok(_) => panic!("{new:?} was accepted"),
    };
    let told = error.to_string();
    let line = error.origin.line as usize;
    assert!(line > 0 && told.starts_with(&format!("{name}:{line}:")), "{told}");
    assert!(!error.remedy.is_empty() || error.problem.contains(": move"), "{told:?} has no remedy");
    for part in expected {
        assert!(told.contains(part), "{told:?} lacks {part:?}");
    }
    line
}

/// What is said of a mistake.
fn check_told(name: &str, old: &str, new: &str) -> String {
    parse(name, &file(name).replace(old, new)).unwrap_err().to_string()
}

const SEGMENT: &str = "{kind: line, points: [[-20.0, 0.0], [20.0, 0.0]]}";
const TRENCH: &str = "{kind: hyperbolic, alpha: 10.0, a: 1.0}";

#[test]
fn segments() {
    let graph = "{kind: graph, expression: \"sin(x\", from: -9.0, to: 9.0}";
    check("7.11.yaml", SEGMENT, graph, &["7.11.yaml:9:", "segment.expression", "sin(x"]);
    let unknown = "{kind: graph, expression: \"sni(x)\", from: -9.0, to: 9.0}";
    check("7.11.yaml", SEGMENT, unknown, &["did you mean `sin`?"]);
    let rough = "{kind: graph, expression: \"abs(x)\", from: -9.0, to: 9.0}";
    check("7.11.yaml", SEGMENT, rough, &["segment.expression", "x ="]);
    let crossing = "{kind: polyline, points: [[0, 0], [4, 0], [4, 4], [2, -4]]}";
    check("7.11.yaml", SEGMENT, crossing, &["segment", "meets itself"]);
    let empty = "{kind: arc, centre: [0, 0], radius: -1.0, start_angle: 0.0, sweep: 1.0}";
    check("7.11.yaml", SEGMENT, empty, &["radius is -1"]);
}

#[test]
fn zones() {
    check("6.5.yaml", "rho_underbar: 1.0", "rho_underbar: -1.0", &["zoning.rho_underbar", "positive"]);
    check(
        "6.5.yaml",
        "rho_hat: 4.0",
        "rho_hat: 12.0",
        &["zoning.rho = 10.0", "out of order", "rho_underbar < rho_hat"],
    );
    check("6.5.yaml", "m: 2", "m: 3", &["zoning.m = 3", "1 or 2"]);
}

#[test]
fn robots() {
    let first = "- {position: [26.0026, 29.7094], velocity: [0.0153, 0.0056]}";
    check("6.5.yaml", first, "- {position: [.nan, 29.7], velocity: [0, 0]}", &["robots[0].position[0]", "not finite"]);
    check("6.5.yaml", first, "- {position: [27.8, 19.9]}", &["robots[1]", "zone 1", "move one of them"]);
    check("7.10.yaml", first, "- {position: [27.8, 19.9]}", &["robots[1]", "r1 and r2", "zone 1"]);
    check("7.10_obstacles.yaml", first, "- {position: [30.2, 25.0]}", &["robots[0]", "inside obstacle 1"]);
    check("6.5.yaml", first, "- {position: [26.0, 29.7], velocty: [0, 0]}", &["velocty", "did you mean `velocity`?"]);
    // Bodies of 0.5 m: one reaches into a disc of 1 m whose middle is 1.2 m away, though its own middle is outside; two of 2 m overlap.
    check(
        "9.2_bounded.yaml",
        "- {position: [26.0026, 29.7094], velocity: [0.0153, 0.0056]}",
        "- {position: [31.2, 25.0]}",
        &["robots[0]", "reaches 0.3", "into obstacle 1"],
    );
    told("9.2_bounded.yaml", "body_radius: 0.5", "body_radius: 2.0", &["robots[2]", "two bodies need 4 m"]);
    // A body is one whoever names it.
    told("7.10_fragments.yaml", "body_radius: 0.5 ", "body_radius: 2.0 ", &["robots[2]", "two bodies need 4 m"]);
    let one = "- {position: [1.0, 9.0]}";
    check("7.11.yaml", &format!("robots:\n{one}"), "robots: []", &["robots", "is empty", "at least one"]);
    // r9 and r10 are lowest on the diagonal: a segment that begins farther up has no point of attraction for them.
    told(
        "6.5.yaml",
        "[[-5.0, -5.0], [100.0, 100.0]]",
        "[[5.0, 5.0], [100.0, 100.0]]",
        &["no point of attraction", "(6.3)"],
    );
}

#[test]
fn obstacles() {
    let rectangle = "- {polygon: [[-3.0, 2.0], [3.0, 2.0], [3.0, 4.0], [-3.0, 4.0]]}";
    let covering = "- {polygon: [[-30.0, -2.0], [30.0, -2.0], [30.0, 2.0], [-30.0, 2.0]]}";
    check("7.11.yaml", rectangle, covering, &["obstacles", "no qualified fragment"]);
    check("7.11.yaml", rectangle, "- {disc: [0.0, 2.0], radius: 0.0}", &["obstacles[0].radius", "not positive"]);
    check("7.11.yaml", rectangle, "- {disc: [.inf, 2.0], radius: 1.0}", &["obstacles[0].disc[0]", "not finite"]);
    check("7.11.yaml", "{pole: 0.0, cut: 1.0", "{pole: 2.0, cut: 1.0", &["obstacle_potential.cut", "farther out"]);
    let euler = "method: semi_implicit_euler";
    check("7.11.yaml", euler, &format!("{euler}\nsafety: {{body_radius: 0.1}}"), &["safety", "give limits"]);
    check("7.11.yaml", euler, &format!("{euler}\nsight: {{range: 0.0, piece: 0.5}}"), &["sight.range", "not positive"]);
    let fine = "sight: {range: 4.0, piece: 1.0e-9}";
    check("7.11.yaml", euler, &format!("{euler}\n{fine}"), &["sight", "more than 10000", "longer `piece`"]);
    let short = "sight: {range: 1.5, piece: 10.0}";
    check("7.11.yaml", euler, &format!("{euler}\n{short}"), &["sight", "not before they repel it", "see farther"]);
    let sight = "sight: {range: 4.0, piece: 0.5}";
    check(
        "9.1_bent_corridor.yaml",
        euler,
        &format!("{euler}\n{sight}"),
        &["sight", "pieces of a wall", "take `apart`"],
    );
    check(
        "7.10_obstacles.yaml",
        "25.0], radius: 1.0",
        "25.0], radius: 1.0, apart: true",
        &["apart", "pieces of walls"],
    );
    check("7.14.yaml", euler, &format!("{euler}\n{sight}"), &["sight", "obstacles that move", "take the velocities"]);
    check(
        "7.11.yaml",
        euler,
        &format!("{euler}\nlimits: {{speed: 0.0, acceleration: 1.0}}"),
        &["limits.speed", "not positive"],
    );
}

#[test]
fn potentials() {
    check("7.11.yaml", TRENCH, "{kind: table, slope: [[0, 0], [1, .nan]]}", &["trench.slope[1][1]", "not finite"]);
    check("7.11.yaml", TRENCH, "{kind: table, slope: [[0, 0], [1, 2], [0.5, 3]]}", &["trench.slope", "row 3"]);
    check("7.11.yaml", TRENCH, "{kind: expression, potential: \"x^2 +\"}", &["trench.potential"]);
    check("7.11.yaml", TRENCH, "{kind: expression, potential: \"2*abs(x) + 3*(1 - cos(x))\"}", &["trench", "trapped"]);
    // Its kinks, at irrational places, point upward.
    let irregular = "{kind: expression, potential: \"min(x^2, 4 + abs(x)/10)\"}";
    check("7.11.yaml", TRENCH, irregular, &["trench", "not regular at x = ", "a kink that points upward"]);
    let range = "{kind: expression, potential: \"x^2\", range: -3}";
    check("7.11.yaml", TRENCH, range, &["trench.range = -3: is not positive; write a number above 0"]);
    let not_even = "{kind: expression, slope: \"1 + x\"}";
    let error = check_told("7.11.yaml", TRENCH, not_even);
    assert!(error.contains("Definition 5.2.1") && !error.contains("trench check"), "{error}");
    check("7.11.yaml", TRENCH, "{kind: hyperbolic, alpha: -1.0, a: 1.0}", &["trench.alpha", "not positive"]);
}

/// The numbers that were once accepted, and told as infinite gaps and steps that are too long.
#[test]
fn numbers_beyond_everything() {
    let far = "is beyond all that robots have to do with; write metres, seconds, m/s: at most 1000000";
    let rectangle = "- {polygon: [[-3.0, 2.0], [3.0, 2.0], [3.0, 4.0], [-3.0, 4.0]]}";
    let disc = "- {disc: [0.0, 1.0e+308], radius: 1.0}";
    check("7.11.yaml", rectangle, disc, &["obstacles[0].disc[1] = 1.0e+308", far]);
    let fast = "- {polygon: [[-3.0, 2.0], [3.0, 2.0], [3.0, 4.0], [-3.0, 4.0]], velocity: [1.0e+308, 0.0]}";
    check("7.11.yaml", rectangle, fast, &["obstacles[0].velocity[0] = 1.0e+308", far]);
    check("7.11.yaml", "[1.0, 9.0]", "[1.0e+308, 9.0]", &["robots[0].position[0] = 1.0e+308", far]);
    check("7.11.yaml", SEGMENT, "{kind: line, points: [[-2.0e+6, 0.0], [20.0, 0.0]]}", &["segment.points[0][0]", far]);
}

#[test]
fn timing() {
    check(
        "7.11.yaml",
        "record_every: 0.05 ",
        "record_every: 100.0 ",
        &["record_every", "longer than the duration", "60"],
    );
    let every = "step: 0.001";
    check(
        "7.11.yaml",
        every,
        &format!("{every}\nsteps_per_tick: 0"),
        &["steps_per_tick = 0: leaves robots without a tick; write 1 or more steps a tick"],
    );
    check("7.11.yaml", "step: 0.001", "step: 0.0", &["step", "not positive"]);
    check("7.11.yaml", "record_every: 0.05", "record_every: 0.0015", &["record_every", "multiple"]);
    check("7.11.yaml", "method: semi_implicit_euler", "method: rk4", &["method", "semi_implicit_euler"]);
    check("7.15.yaml", "method: semi_implicit_euler", "method: exact", &["method", "the others are driven"]);
    let safe = "method: exact\nlimits: {speed: 1.0, acceleration: 1.0}\nsafety: {body_radius: 0.1}";
    check("7.11.yaml", "method: semi_implicit_euler", safe, &["method", "safety filter", "write semi_implicit_euler"]);
    let held = ["method", "does not go with `limits` and `safety`", "write semi_implicit_euler"];
    check("5.6_bounded.yaml", "method: semi_implicit_euler", "method: rk4", &held);
    let room = ["method", "does not go with `safety`", "write semi_implicit_euler"];
    check("5.6_bounded.yaml", "method: semi_implicit_euler", "method: exact", &room);
    check("7.11.yaml", "kind: nearest_points", "kind: nearest_point", &["did you mean `nearest_points`?"]);
    check("7.11.yaml", "draws: trajectories", "draws: trajectory", &["figures[0].draws"]);
}

/// What is told fits on a screen, whatever the file says.
#[test]
fn messages_are_short() {
    let told = |segment: &str| {
        let error = parse("7.11.yaml", &file("7.11.yaml").replace(SEGMENT, segment)).unwrap_err().to_string();
        assert!(error.len() < 500, "{} characters: {error}", error.len());
        error
    };
    let long = format!("{}y", "x + ".repeat(2000));
    let whole = told(&format!("{{kind: graph, expression: \"{long}\", from: 0.0, to: 1.0}}"));
    assert!(whole.contains("segment.expression = \"x + x") && whole.contains("too long"), "{whole}");
    let wave = |wavelength: &str, amplitude: &str| {
        told(&format!(
            "{{kind: sinusoid, origin: [0.0, 0.0], length: 10.0, wavelength: {wavelength}, amplitude: {amplitude}}}"
        ))
    };
    let said = wave("1.0e+308", "1.0");
    assert!(said.contains("wavelength = 1.0e+308"), "{said}");
    let said = wave("-1.0e+308", "1.0");
    assert!(said.contains("wavelength = -1.0e+308"), "{said}");
    let said = wave("1.0", "1.0e+200");
    assert!(said.contains("amplitude = 1.0e+200"), "{said}");
    assert!(wave("1.0e-4", "1.0").contains("fewer and longer waves"));
}

#[test]
fn directions_and_angles() {
    let direction = "direction: 2.356194490192345";
    check(
        "6.5.yaml",
        direction,
        "direction: 135.0",
        &["direction = 135.0", "more than a turn", "135 degrees are 2.356194"],
    );
    check(
        "6.5.yaml",
        direction,
        "direction: 0.7853981633974483",
        &["direction", "is parallel to the segment", "for example 2.3562 rad"],
    );
    check(
        "6.5_bounded.yaml",
        "compensates: true}",
        "compensates: true, direction: 90.0}",
        &["directed.direction", "degrees"],
    );
    for key in ["heading", "misalignment"] {
        let degrees = format!("{key}: 90.0");
        check("4.4.4.yaml", "misalignment: 1.0", &degrees, &[&format!("robots[0].{key} = 90.0"), "more than a turn"]);
    }
    check("4.4.4.yaml", "misalignment: 1.0", "misalignment: 1.0, heading: 1.0", &["heading", "unknown key"]);
    let arc = "{kind: arc, centre: [0, 0], radius: 1.0, start_angle: 90.0, sweep: 1.0}";
    check("7.11.yaml", SEGMENT, arc, &["segment.start_angle = 90.0", "90 degrees are 1.570796"]);
}

#[test]
fn lengths_of_segments_are_blamed_themselves() {
    let arc = "\n  kind: arc\n  centre: [0, 0]\n  start_angle: 0.0\n  sweep: 1.0\n  radius: 0.0";
    let line = told("7.11.yaml", SEGMENT, arc, &["segment.radius = 0.0", "above 0"]);
    assert_eq!(line, 14);
    check("7.11.yaml", SEGMENT, "{kind: line, points: [[1, 1], [1, 1]]}", &["segment.points", "coincide"]);
    check(
        "7.11.yaml",
        "edge: jump                 # as",
        "edge: jump\n  full_acceleration: 0.0 # as",
        &["zoning.full_acceleration"],
    );
}

#[test]
fn numbers_of_potentials_and_seeking_are_blamed_themselves() {
    check(
        "6.5.yaml",
        "full_acceleration: 1.0e+4",
        "full_acceleration: -5.0",
        &["zoning.full_acceleration = -5.0", "above 0"],
    );
    let potential = "strength: 10.0, m: 2, edge: jump}";
    let weak = "strength: 10.0, m: 2, edge: jump, full_acceleration: 0.0}";
    check("7.11.yaml", potential, weak, &["obstacle_potential.full_acceleration = 0.0", "above 0"]);
    let euler = "method: semi_implicit_euler";
    check("7.11.yaml", euler, &format!("{euler}\nseeking: {{room: -1.0}}"), &["seeking.room = -1.0", "zero or more"]);
}

#[test]
fn figures_are_of_the_run() {
    let caught = "draws: trajectories}";
    check("7.11.yaml", caught, "draws: snapshots, at: [-5.0, 0.0]}", &["figures[0].at", "before the run", "from 0 on"]);
    check("7.11.yaml", caught, "draws: snapshots, at: [900.0]}", &["figures[0].at", "after the run", "its end, 60"]);
}

/// What does nothing is not accepted, nor what would be done otherwise than it is written.
#[test]
fn keys_that_would_do_nothing() {
    check(
        "4.4.4.yaml",
        "kind: regulation",
        "kind: regulation\ncompared: {nonsense: true}",
        &["compared", "unknown key"],
    );
    check("4.6_square.yaml", "kind: launch", "kind: launch\ntolerance: 0.1", &["tolerance", "unknown key"]);
    let moving = "kind: nearest_points\nsegment_motion: {velocity: [0.1, 0.0]}";
    check("7.15.yaml", "kind: nearest_points", moving, &["segment_motion", "moves", "or compared"]);
    let wall = "- {walls: [[0.6, 6.0], [0.6, 3.0], [4.0, 3.0], [4.0, 6.0]]}";
    let moving = "- {walls: [[0.6, 6.0], [0.6, 3.0]], velocity: [0.5, 0.0]}";
    check("7.15.yaml", wall, moving, &["obstacles[1].velocity", "methods are compared", "they rest"]);
    // Walls that close, or go on straight, are compared as they are.
    for wall_that_is_no_polygon in ["[[1, 3], [4, 3], [4, 5], [1, 5], [1, 3]]", "[[1, 3], [2, 3], [4, 3]]"] {
        let text = file("7.15.yaml").replace(wall, &format!("- {{walls: {wall_that_is_no_polygon}}}"));
        let scenario = parse("7.15.yaml", &text).unwrap_or_else(|error| panic!("{error}"));
        trench_scenario::Simulation::new(&scenario).unwrap();
    }
    // On an outline is in collision.
    check("7.15.yaml", "[-2.0, 12.0]", "[-2.0, 3.0]", &["robots[0]", "touches it"]);
    let text = file("7.15.yaml");
    let exponent = text.lines().find_map(|line| line.split("goal_exponent: ").nth(1)).unwrap();
    let exponent = exponent.split([',', '}']).next().unwrap();
    let text = text.replacen(&format!("goal_exponent: {exponent}"), "goal_exponent: 1.7", 1);
    let told = parse("7.15.yaml", &text).unwrap_err().to_string();
    assert!(told.contains("goal_exponent = 1.7"), "{told}");
}

/// What repels at obstacles is asked for where there are any.
#[test]
fn potentials_of_obstacles_are_for_obstacles() {
    let text = file("7.11.yaml");
    let (obstacles, potential) = (text.find("obstacles:").unwrap(), text.find("obstacle_potential:").unwrap());
    let after = potential + text[potential..].find('\n').unwrap() + 1;
    let without = [&text[..potential], &text[after..]].concat();
    let told = parse("7.11.yaml", &without).unwrap_err().to_string();
    assert!(told.contains("obstacle_potential"), "{told}");
    parse("7.11.yaml", &[&text[..obstacles], &text[after..]].concat()).unwrap();
}

/// A file that is a scenario by all but its kind is one whose kind was forgotten, not a launch file.
#[test]
fn kinds_are_asked_for() {
    let text = file("7.11.yaml").replace("kind: nearest_points\n", "");
    assert!(
        is_scenario(&text) && !is_scenario("launch:\n- node: {exec: a}\n") && !is_scenario("name: a\nqueues: []\n")
    );
    let told = parse("7.11.yaml", &text).unwrap_err().to_string();
    assert!(
        told.starts_with("7.11.yaml:") && told.contains(": kind: is missing; write kind: and one of regulation, "),
        "{told}"
    );
}

/// What would never happen is not accepted without a word.
#[test]
fn events_are_of_the_run() {
    let r6 = "- {position: [19.0, -0.5]}";
    let after = ["after the run", "up to its end, 80"];
    check("A.22_quit_and_join.yaml", "joins: 30.0", "joins: 400.0", &["robots[6].joins = 400.0", after[0], after[1]]);
    check("A.22_quit_and_join.yaml", "joins: 30.0", "joins: -1.0", &["robots[6].joins = -1.0", "above 0"]);
    check("A.22_quit_and_join.yaml", "at: 45.0", "at: 999.0", &["quits.at = 999.0", after[0], after[1]]);
    check("A.22_quit_and_join.yaml", "at: 45.0", "at: -45.0", &["quits.at = -45.0", "above 0"]);
    check("A.22_quit_and_join.yaml", r6, "- {position: [19.0, -0.5], quits: {at: 80.1, to: [0, 0]}}", &[after[0]]);
    let (name, link) = ("8.4.1_broken_links.yaml", "{robot: r4, from: 1.0, to: 4.0}");
    check(name, link, "{robot: r4, from: 100.0, to: 200.0}", &["broken_links[0].from = 100.0", after[0]]);
    // At its end nothing would be seen of it.
    check(
        name,
        link,
        "{robot: r4, from: 40.0, to: 200.0}",
        &["broken_links[0].from = 40.0", "no link would break in it", "before it, 40"],
    );
    check(
        name,
        link,
        "{robot: r4, from: -1.0, to: 4.0}",
        &["broken_links[0].from = -1.0", "before the run", "from 0 on"],
    );
    check(
        name,
        link,
        "{robot: r1, from: 1.0, to: 4.0}",
        &["broken_links[0].robot = r1", "leads", "name a robot behind it"],
    );
    // To the end of the run, whatever that is.
    parse(name, &file(name).replace(link, "{robot: r4, from: 1.0, to: 4000.0}")).unwrap();
    // Chains have links, too.
    let (name, link) = ("6.2.1_lost_chain.yaml", "{robot: r4, from: 50.0, to: 60.0}");
    check(name, link, "{robot: r1, from: 1.0, to: 4.0}", &["leads"]);
    check(name, link, "{robot: r2, from: 900.0, to: 901.0}", &[after[0], "its end, 90"]);
}

/// In kinds without zones, and without bodies.
#[test]
fn robots_begin_in_places_of_their_own() {
    let told = |name: &str, first: &str, second: &str| {
        let text = file(name);
        let robots = text.split("\nrobots:").nth(1).unwrap();
        let lines: Vec<&str> = robots.lines().filter(|line| line.starts_with("- {")).collect();
        let other = text.replacen(lines[0], first, 1).replacen(lines[1], second, 1);
        parse(name, &other).map_err(|error| (error.origin.line, error.to_string(), other))
    };
    for (name, first, second, tolerance) in [
        ("8.4_queue.yaml", "- {position: [35.0, 6.0]}", "- {position: [35.0, 6.04]}", "0.05"),
        ("5.6.yaml", "- {position: [40.0, 6.0]}", "- {position: [40.0, 6.0], velocity: [1.0, 0.0]}", "0.1"),
    ] {
        let (line, text, file) = told(name, first, second).unwrap_err();
        assert!(file.lines().nth(line - 1).unwrap() == second, "{text}");
        assert!(
            text.contains("r2 begin") && text.contains(&format!("nearer than `tolerance`, {tolerance} m")),
            "{text}"
        );
        assert!(text.contains("move one of them"), "{text}");
    }
    assert!(told("8.4_queue.yaml", "- {position: [35.0, 6.0]}", "- {position: [35.0, 6.06]}").is_ok());
}

/// Pictures of one name would be one file, and the last would stay.
#[test]
fn pictures_of_headings_are_of_robots_that_have_them() {
    for drawing in ["misalignments", "curvatures"] {
        let (drawn, value) = (format!("draws: {drawing}}}"), format!("figures[0].draws = {drawing}: "));
        let parts = [&*value, "points, which have none; draw errors, speeds or trajectories"];
        check("7.11.yaml", "draws: trajectories}", &drawn, &parts);
    }
    // Of three cases two have bodies.
    let drawn = |cases: &str| {
        let first = format!("figures:\n- {{figure: \"a\", title: a, draws: curvatures{cases}}}\n");
        parse("a", &file("3.1_hilare.yaml").replacen("figures:\n", &first, 1)).map_err(|error| error.to_string())
    };
    for cases in ["", ", cases: [point, offset]"] {
        assert!(
            drawn(cases).is_err_and(|error| error.contains("draws = curvatures") && error.contains("with a `plant`")),
            "{cases}"
        );
    }
    assert!(drawn(", cases: [printed, offset]").is_ok());
}

#[test]
fn figures_have_names_of_their_own() {
    let (name, old) = ("6.5_k_5.yaml", "figures:\n");
    let twice = |first: &str, second: &str| {
        format!(
            "figures:\n- {{figure: \"{first}\", title: a, draws: errors}}\n- {{figure: \"{second}\", title: b, draws: trajectories}}\n"
        )
    };
    let parts = ["figures[1].figure = \"1\"", "figures[0]", "the file figure-1,", "a name of its own"];
    told(name, old, &twice("1", "1"), &parts);
    told(name, old, &twice("1 (a)", "1 [a]"), &["figures[1].figure = \"1 [a]\"", "the file figure-1-a,"]);
    parse(name, &file(name).replace(old, &twice("1", "1.a"))).unwrap();
}
