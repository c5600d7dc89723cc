//! Formations of linear queues and of directions of attraction, and the gaps of a field.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use trench_check::{Along, Passing, Standing, Start, Team, Verdict, formation, gaps};
use trench_config::{Origin, ParameterValue, Parameters};
use trench_formation::Vector2;

/// Robots of the bed, under a law without zones.
fn team(law: &str) -> Team {
    Team {
        robots: None,
        radius: 0.08,
        margin: 0.01,
        wheel_speed: 0.29,
        field: [[0.0, 4.0], [0.0, 2.8]],
        approach_gain: 1.0,
        feeds_forward: true,
        zones: None,
        chain_gains: Some((2.0, 3.0)),
        law: law.to_owned(),
        acceleration: 0.35,
        along: None,
        starts: Vec::new(),
    }
}

fn judged(check: &str, text: &str, team: &Team) -> Vec<Verdict> {
    let verdicts = formation("f", &trench_plan::parse("f.yaml", text).unwrap(), team);
    verdicts.into_iter().filter(|verdict| verdict.check == check).collect()
}

fn assert_says(verdict: &Verdict, (holds, note): (bool, bool), parts: &[&str]) {
    assert_eq!((verdict.holds, verdict.note), (holds, note), "{verdict:?}");
    assert!(parts.iter().all(|part| verdict.finding.contains(part)), "{parts:?}: {verdict:?}");
}

const LINE: &str = "\
name: line
queues:
- name: line
  segment: {kind: line, points: [[0.3, 0.5], [3.7, 0.5]]}
  vertices: [[3.5, 0.5]]
  chain: {robots: 4, spacing: 0.36}
  share: 1.0
  tolerance: 0.02
";

/// K = (2, 3) has the poles -1 and -2: ranks 1 to 4 are those of `chains_are_bounded_rank_by_rank`, bodies touch at 0.18 m.
#[test]
fn chains_under_the_queue_law_have_a_bound() {
    let one = |text: &str, team: &Team| judged("chain", text, team).pop().unwrap();
    let fits = one(LINE, &team("queue"));
    assert_says(
        &fits,
        (true, false),
        &["K = (2, 3)", "rank 4 stays within 0.18 (0.03932;", "0.02034, 0.02963, 0.0354, 0.03932"],
    );
    assert!(!fits.finding.contains("law queue"), "it is this law: {fits:?}");
    let near = one(&LINE.replace("spacing: 0.36", "spacing: 0.215"), &team("queue"));
    assert_says(
        &near,
        (false, false),
        &["rank 3 may leave 0.035 (0.0354;", "at most 2 robots in one chain stay within"],
    );
    let unstable = Team { chain_gains: Some((2.0, -1.0)), ..team("queue") };
    assert_says(&one(LINE, &unstable), (false, false), &["not Hurwitz"]);
}

/// What a controller is told, and K that the chain bound takes from it: of trenches of any shape, also those that a person wrote.
#[test]
fn stiffness_of_trenches_of_any_shape() {
    let gains = |shape: &str, formula: &str, rows: &[f64]| {
        let mut parameters = Parameters::default();
        let mut put = |name: &str, value| parameters.insert(name, value, Origin::new("p.yaml", 1));
        let numbers = [
            ("body.radius", 0.08),
            ("safety.margin", 0.01),
            ("wheels.max_speed", 0.29),
            ("gains.k1", 1.0),
            ("motion.acceleration", 0.35),
            ("trench.alpha", 0.5),
            ("trench.a", 0.25),
            ("damping", 3.0),
            ("leader_damping", 1.0),
        ];
        for (name, number) in numbers {
            put(name, ParameterValue::Double(number));
        }
        for (name, text) in [("law", "chain"), ("trench.shape", shape), ("trench.formula", formula)] {
            put(name, ParameterValue::String(text.to_owned()));
        }
        put("trench.table", ParameterValue::DoubleArray(rows.to_vec()));
        put("field", ParameterValue::DoubleArray(vec![0.0, 0.0, 4.0, 2.8]));
        put("zones.radii", ParameterValue::DoubleArray(vec![0.20, 0.26, 0.34, 0.45, 1.2]));
        trench_check::team(&parameters, None).unwrap().chain_gains
    };
    let check = |shape, formula, rows: &[f64], expected: Option<f64>| {
        let found = gains(shape, formula, rows);
        let near = found
            .zip(expected)
            .map(|((stiffness, damping), expected)| damping == 4.0 && (stiffness - expected).abs() < 1e-6);
        assert!(near.unwrap_or(found.is_none() && expected.is_none()), "{shape}: {found:?}, not {expected:?}");
    };
    check("hyperbolic", "", &[], Some(2.0));
    check("quadratic", "", &[], Some(2.0));
    check("saturated", "", &[], Some(2.0));
    check("square_root", "", &[], Some(2.0));
    check("critical", "", &[], Some(2.25));
    check("conic", "", &[], None);
    check("slope", "3*x/(1 + x^2)", &[], Some(3.0));
    check("potential", "0.7*x^2", &[], Some(1.4));
    check("potential", "x^4", &[], None);
    check("table", "", &[0.0, 0.0, 0.5, 0.4, 2.0, 0.4], Some(0.8));
}

/// Goal points that set out at once leave the first robot behind by their speed; what K asks for beyond the motors is said.
#[test]
fn goal_points_that_set_out_are_in_the_bound() {
    let text = "\
name: pair
motion: {approach: 3.0, speed: 0.05}
queues:
- name: pair
  segment: {kind: line, points: [[0.3, 0.5], [3.7, 0.5]]}
  starts: [[1.0, 0.5], [0.6, 0.5]]
  vertices: [[3.5, 0.5], [3.1, 0.5]]
  share: 1.0
  tolerance: 0.02
";
    let one = |text: &str, team: &Team| judged("chain", text, team).pop().unwrap();
    let verdict = one(text, &team("queue"));
    assert_says(
        &verdict,
        (true, false),
        &["of 0.02 (0.05385 of the first, whose goal point sets out at 0.05 m/s)", "stays within 0.22"],
    );
    let still = one(&text.replace("speed: 0.05", "speed: 0.0"), &team("queue"));
    assert!(!still.finding.contains("sets out"), "{still:?}");
    let weak = Team { acceleration: 0.1, ..team("queue") };
    assert_says(&one(text, &weak), (true, true), &["|K e| may ask for", "robots have 0.1 (motion.acceleration)"]);
}

/// Who is drawn to the segment goes to no vertex but the leader's.
#[test]
fn vertices_that_draw_nobody_are_noted() {
    let several =
        LINE.replace("[[3.5, 0.5]]", "[[3.5, 0.5], [3.0, 0.5]]").replace("  chain: {robots: 4, spacing: 0.36}\n", "");
    for law in ["zoned", "chain", "nearest"] {
        let noted = judged("vertices", &several, &team(law));
        assert_eq!(noted.len(), 1);
        assert_says(
            &noted[0],
            (true, true),
            &["queue line has 2 vertices, but under law", "chain: {robots: 2, spacing: ...}"],
        );
        assert_eq!(judged("vertices", LINE, &team(law)), []);
    }
    assert_eq!(judged("vertices", &several, &team("robust")), []);
}

fn start(rank: usize, x: f64, y: f64) -> Start {
    Start { robot: format!("robot{rank}"), queue: 0, rank, position: Vector2::new(x, y) }
}

/// Robots 2 and 3 stand beside the line; k = 2 and 0.2 m/s make a drift of 0.1 m.
fn along(direction: Option<[f64; 2]>, starts: Vec<Start>) -> Team {
    let along = Along { direction: direction.map(Vector2::from), damping: 2.0, speed: 0.2 };
    Team { along: Some(along), starts, zones: Some([0.20, 0.26, 0.34, 0.45, 1.2]), ..team("zoned") }
}

#[test]
fn directions_of_followers_at_their_starts() {
    let beside = vec![start(1, 9.0, 9.0), start(2, 2.0, 1.0), start(3, 0.5, 0.2)];
    let verdicts = judged("direction", LINE, &along(None, beside.clone()));
    assert_eq!(verdicts.len(), 1, "{verdicts:?}");
    assert_says(
        &verdicts[0],
        (true, false),
        &["all 2 followers", "robot3 is nearest to missing it, by 0.2 m: enough for the 0.1 m"],
    );
    let edge = vec![start(1, 9.0, 9.0), start(2, 0.35, 1.0)];
    assert_says(&judged("direction", LINE, &along(None, edge))[0], (true, true), &["by 0.05 m: too little"]);
    // 45 degrees to the line, from 0.3 m below it: robot3 meets it at x = 0.5 + 0.3, and the other way at 0.2, before its beginning.
    let slanted = |x: f64| judged("direction", LINE, &along(Some([x, 1.0]), beside.clone()));
    assert_says(&slanted(1.0)[0], (true, false), &["all 2 followers"]);
    let missed = slanted(-1.0);
    assert_eq!(missed.len(), 1, "{missed:?}");
    assert_says(&missed[0], (false, false), &["turn the direction, or make the segment", "longer there"]);
    assert_eq!(missed[0].subjects, ["f, queue line, robot3"]);
    let beyond = vec![start(1, 9.0, 9.0), start(2, 0.1, 1.0)];
    assert_says(&judged("direction", LINE, &along(None, beyond))[0], (true, true), &["begins 0.2 m beyond the end"]);
}

#[test]
fn directions_where_nobody_knows_the_starts() {
    let one = |text: &str, direction| judged("direction", text, &along(direction, Vec::new())).pop().unwrap();
    // 3.4 m of line less 0.1 m of drift at either end.
    assert_says(&one(LINE, None), (true, false), &["across the segment", "beside the inner 3.2 m of the 3.4 m"]);
    assert_says(&one(LINE, Some([1.0, 0.0])), (false, false), &["along [1, 0] the segment spans 0 m", "0.2 m longer"]);
    // A semicircle seen along its diameter turns away at its top: two points of attraction before it, none beyond.
    let arc = LINE.replace(
        "{kind: line, points: [[0.3, 0.5], [3.7, 0.5]]}",
        "{kind: arc, centre: [2.0, 0.5], radius: 1.5, start_angle: 0.0, sweep: 3.141592653589793}",
    );
    let folded = one(&arc, Some([1.0, 0.0]));
    assert_says(&folded, (true, true), &["turns away along the direction, at 2.35"]);
    assert_says(&one(&arc, Some([0.0, 1.0])), (true, false), &["beside the inner 2.8 m of the 3 m"]);
    let met = vec![start(1, 9.0, 9.0), start(2, 0.0, 1.95)];
    let met = judged("direction", &arc, &along(Some([1.0, 0.0]), met));
    assert_says(&met[0], (false, false), &["turns away along the direction at 2.35"]);
}

#[test]
fn laws_without_directions_get_no_verdict() {
    assert!(judged("direction", LINE, &team("queue")).is_empty());
}

const PASSING: Passing = Passing { clearance: 0.2, width: 0.18, pole: 0.0, field: [[0.0, 4.0], [0.0, 2.8]] };

fn disc(number: u32, x: f64, y: f64) -> Standing {
    Standing::new(number, &[Vector2::new(x, y)], 0.1, &[]).unwrap()
}

/// What is said of gaps, by the first words of the finding.
fn said(standing: &[Standing], passing: &Passing, begins: &str) -> Option<Verdict> {
    gaps("o", standing, passing).into_iter().find(|verdict| verdict.finding.starts_with(begins))
}

/// Two discs in the middle of the field, so far apart; nothing else is near.
fn pair(gap: f64) -> [Standing; 2] {
    [disc(1, 1.5, 1.4), disc(2, 1.7 + gap, 1.4)]
}

#[test]
fn gaps_are_passable_closed_or_too_narrow() {
    let open = said(&pair(0.3), &PASSING, "passable").unwrap();
    assert_says(
        &open,
        (true, false),
        &["disc 1 at [1.5, 1.4] and disc 2 at [2, 1.4], 0.3 m", "and the left edge, 1.4 m"],
    );
    assert!(said(&pair(0.3), &PASSING, "closed").is_none());
    assert_says(
        &said(&pair(0.15), &PASSING, "closed by hulls").unwrap(),
        (true, false),
        &["disc 2 at [1.85, 1.4], 0.15 m"],
    );
    // Hulls that combine too late leave a gap in which a robot would be stuck.
    let late = Passing { clearance: 0.1, ..PASSING };
    assert_says(
        &said(&pair(0.15), &late, "too narrow").unwrap(),
        (false, false),
        &["0.15 m", "make the mapper's clearance 0.18 m"],
    );
    assert!(said(&pair(0.18), &late, "too narrow").is_none());
    let poles = Passing { pole: 0.14, ..PASSING };
    assert_says(
        &said(&pair(0.25), &poles, "open and wide enough").unwrap(),
        (true, true),
        &["0.25 m", "both poles, 0.28 m"],
    );
    assert!(said(&pair(0.29), &poles, "open and wide").is_none());
    let low = [disc(1, 1.5, 0.2)];
    assert_says(
        &said(&low, &PASSING, "too narrow").unwrap(),
        (true, true),
        &["the lower edge, 0.1 m", "safety filter"],
    );
}

/// Three discs in a row: the outer two are no neighbours. The hull of the first two closes what is between them and the third.
#[test]
fn gaps_are_between_neighbours_and_closed_together() {
    let row = [disc(1, 1.0, 1.4), disc(2, 1.5, 1.4), disc(3, 2.0, 1.4)];
    let open = said(&row, &PASSING, "passable").unwrap();
    assert!(!open.finding.contains("disc 1 at [1, 1.4] and disc 3"), "{open:?}");
    // Each of the two below is 0.1 m from the next; the first and the last are one hull, though 0.4 m apart.
    let near = [disc(1, 1.0, 1.4), disc(2, 1.3, 1.5), disc(3, 1.6, 1.4)];
    let closed = said(&near, &PASSING, "closed").unwrap();
    assert_says(&closed, (true, false), &["disc 1 at [1, 1.4] and disc 2", "disc 2 at [1.3, 1.5] and disc 3"]);
}

#[test]
fn gaps_change_while_obstacles_move() {
    let passes = |x: f64| Standing::new(2, &[Vector2::new(2.0, 1.4)], 0.1, &[Vector2::new(x, 0.0)]).unwrap();
    // From 0.3 m down to 0.1 m.
    let verdict = said(&[disc(1, 1.5, 1.4), passes(-0.2)], &PASSING, "passable").unwrap();
    assert_says(&verdict, (true, false), &["0.1 to 0.3 m as they move, closed while below 0.2 m"]);
    let late = Passing { clearance: 0.1, ..PASSING };
    assert!(said(&[disc(1, 1.5, 1.4), passes(-0.2)], &late, "too narrow").is_some_and(|verdict| !verdict.holds));
    assert!(said(&[disc(1, 1.5, 1.4), passes(-0.1)], &late, "too narrow").is_none());
}

#[test]
fn mouths_of_concave_obstacles_are_closed_by_their_hulls() {
    let corners = [[1.0, 1.0], [1.6, 1.0], [1.6, 1.1], [1.1, 1.1], [1.1, 1.4], [1.6, 1.4], [1.6, 1.5], [1.0, 1.5]];
    let trap = Standing::new(1, &corners.map(Vector2::from), 0.0, &[]).unwrap();
    let closed = said(&[trap], &PASSING, "closed").unwrap();
    assert_says(&closed, (true, false), &["the mouth of polygon 1 at [1.325, 1.25], 0.3 m, by its own hull"]);
    let square = [[1.0, 1.0], [1.5, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]].map(Vector2::from);
    assert!(said(&[Standing::new(1, &square, 0.0, &[]).unwrap()], &PASSING, "closed").is_none());
}
