//! What formation files say, and what they are told when they are wrong.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use trench_plan::{Frame, parse};

const GOOD: &str = "\
name: pair
frame: map
motion: {approach: 3.0, speed: 0.1}
queues:
- name: line
  segment: {kind: line, points: [[0.0, 0.5], [2.0, 0.5]]}
  starts: [[0.5, 0.5]]
  vertices: [[1.5, 0.5]]
  share: 1.0
  tolerance: 0.02
";

fn refused(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "the test replaces what is not there: {from}");
    parse("pair.yaml", &GOOD.replace(from, to)).unwrap_err().to_string()
}

#[test]
fn a_good_file_becomes_a_plan() {
    let plan = parse("pair.yaml", GOOD).unwrap();
    assert_eq!((plan.frame, plan.places()), (Frame::Map, 1));
    let place = plan.queues[0].places[0];
    assert!((place.start - 0.5).abs() < 1e-12 && (place.end - 1.5).abs() < 1e-12);
}

#[test]
fn the_hash_tells_formations_apart() {
    let hash = |text: &str| parse("pair.yaml", text).unwrap().message(Default::default()).hash;
    assert_eq!(hash(GOOD), hash(GOOD));
    assert_ne!(hash(GOOD), hash(&GOOD.replace("0.02", "0.03")));
}

#[test]
fn every_shipped_formation_is_good() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/formations");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        parse(&path.display().to_string(), &text).unwrap();
        read += 1;
    }
    assert!(read >= 2, "{read} formations");
}

#[test]
fn a_formation_without_segments() {
    let text = GOOD.split("queues:").next().unwrap().to_owned() + "queues: []\n";
    let error = parse("pair.yaml", &text).unwrap_err().to_string();
    assert_eq!(error, "pair.yaml:4: queues: a formation without segments; give at least one queue");
}

#[test]
fn shares_that_do_not_add_up() {
    let error = refused("share: 1.0", "share: 0.7");
    assert_eq!(error, "pair.yaml:5: queues: the shares add up to 0.7; make them add up to 1");
}

#[test]
fn a_share_that_is_no_fraction() {
    let error = refused("share: 1.0", "share: -1.0");
    assert_eq!(error, "pair.yaml:9: queues[0].share = -1.0: is no fraction; write a number from 0 to 1");
}

#[test]
fn a_segment_of_length_zero() {
    let error = refused("[[0.0, 0.5], [2.0, 0.5]]", "[[0.0, 0.5], [0.0, 0.5]]");
    assert_eq!(
        error,
        "pair.yaml:6: queues[0].segment.points: points 0 and 1 coincide, so the piece between them has length zero; remove one of them"
    );
}

#[test]
fn an_unknown_key_and_the_one_that_was_meant() {
    let error = refused("tolerance: 0.02", "tolerance: 0.02\n  tolerence: 0.02");
    assert!(error.starts_with("pair.yaml:11: queues[0].tolerence"), "{error}");
    assert!(error.contains("tolerance"), "{error}");
}

#[test]
fn a_vertex_off_the_segment() {
    let error = refused("vertices: [[1.5, 0.5]]", "vertices: [[1.5, 0.6]]");
    let expected = "pair.yaml:8: queues[0].vertices[0]: is 0.1000 m away from the segment; \
                    the nearest point of the segment is [1.5000, 0.5000]";
    assert_eq!(error, expected);
}

#[test]
fn starts_without_their_vertices() {
    let error = refused("starts: [[0.5, 0.5]]", "starts: [[0.5, 0.5], [0.6, 0.5]]");
    assert!(error.contains("2 starts for 1 vertices"), "{error}");
}

#[test]
fn a_queue_without_a_vertex() {
    let error = refused("starts: [[0.5, 0.5]]\n  vertices: [[1.5, 0.5]]", "vertices: []");
    let expected = "pair.yaml:7: queues[0].vertices: a queue without a vertex (Definition 2.1.1 has one or two): the first is the \
                    team goal, to which its leader goes and from which the others are ranked; give one or two points of the segment";
    assert_eq!(error, expected);
}

#[test]
fn a_chain_has_one_vertex_for_others_would_mean_nothing() {
    let text = "vertices: [[1.5, 0.5], [0.5, 0.5]]\n  chain: {robots: 2, spacing: 0.3}";
    let error = refused("starts: [[0.5, 0.5]]\n  vertices: [[1.5, 0.5]]", text);
    let expected = "pair.yaml:7: queues[0].vertices: 2 vertices, but a chain has one vertex, the team goal: its places follow from \
                    that one and its spacing; leave out the others, or leave out chain to have a place at each";
    assert_eq!(error, expected);
}

#[test]
fn two_queues_of_one_name() {
    let queue = GOOD.split("queues:\n").nth(1).unwrap();
    let text = (GOOD.to_owned() + queue).replace("share: 1.0", "share: 0.5");
    let error = parse("pair.yaml", &text).unwrap_err().to_string();
    assert_eq!(
        error,
        "pair.yaml:11: queues[1].name = line: is the name of an earlier queue too; give each queue its own name"
    );
}

#[test]
fn a_tolerance_that_no_robot_keeps() {
    for tolerance in ["0.0", "-0.02", "0.0009"] {
        let error = refused("tolerance: 0.02", &format!("tolerance: {tolerance}"));
        let expected = format!(
            "pair.yaml:10: queues[0].tolerance = {tolerance}: is nearer to its segment than any robot can know that it is; write \
             0.001 m or more; 0.02 suits the test bed"
        );
        assert_eq!(error, expected);
    }
}

/// A circle of 3.77 m, the vertex opposite the seam.
#[test]
fn a_chain_goes_round_a_closed_segment() {
    let line = "{kind: line, points: [[0.0, 0.5], [2.0, 0.5]]}\n  starts: [[0.5, 0.5]]\n  vertices: [[1.5, 0.5]]";
    let circle = |robots: u32| {
        format!(
            "{{kind: ellipse, centre: [1.2, 0.9], semi_axes: [0.6, 0.6]}}\n  vertices: [[0.6, 0.9]]\n  \
             chain: {{robots: {robots}, spacing: 0.36}}"
        )
    };
    let plan = parse("pair.yaml", &GOOD.replace(line, &circle(10))).unwrap();
    let queue = &plan.queues[0];
    let at = |place: usize| queue.curve.at(queue.places[place].end).point;
    let nearest = (0..10).flat_map(|one| (0..one).map(move |other| (at(one) - at(other)).norm())).fold(9.0, f64::min);
    assert_eq!((queue.places.len(), (nearest * 1e4).round()), (10, 3546.0));
    let error = parse("pair.yaml", &GOOD.replace(line, &circle(11))).unwrap_err().to_string();
    let expected = "pair.yaml:8: queues[0].chain: the chain does not fit: round the closed segment it needs 3.960 m, and that is \
                    3.770 m long; take fewer robots, a smaller spacing or a longer segment";
    assert_eq!(error, expected);
}

#[test]
fn wrong_types_and_kinds() {
    let error = refused("speed: 0.1", "speed: fast");
    assert!(error.starts_with("pair.yaml:3: motion.speed = fast"), "{error}");
    let error = refused("kind: line", "kind: zigzag");
    assert!(error.starts_with("pair.yaml:6: queues[0].segment.kind = zigzag: is no kind of segment"), "{error}");
    let error = refused("approach: 3.0", "approach: .nan");
    assert!(error.contains("not finite"), "{error}");
    let error = refused("approach: 3.0", "approach: -3.0");
    assert!(error.contains("is negative"), "{error}");
}

#[test]
fn a_graph_is_a_segment() {
    let graph = "{kind: graph, expression: \"0.5 + 0.1*(x - 1)^2\", from: 0.0, to: 2.0}";
    let line = "{kind: line, points: [[0.0, 0.5], [2.0, 0.5]]}";
    let text =
        GOOD.replace(line, graph).replace("[0.5, 0.5]]", "[0.5, 0.525]]").replace("[1.5, 0.5]]", "[1.5, 0.525]]");
    let plan = parse("pair.yaml", &text).unwrap();
    let message = plan.message(Default::default());
    let segment = &message.queues[0].segment;
    assert_eq!(segment.expression, "0.5 + 0.1*(x - 1)^2");
    assert_eq!(trench_plan::curve_from_message(segment).unwrap(), plan.queues[0].curve);
    let refused = |from: &str, to: &str| parse("pair.yaml", &text.replace(from, to)).unwrap_err().to_string();
    let check = |from: &str, to: &str, expected: &str| assert_eq!(refused(from, to), expected);
    check(
        "0.1*(x - 1)^2",
        "0.1 (x",
        "pair.yaml:6: queues[0].segment.expression = \"0.5 + 0.1 (x\": does not parse at column 11: found `(`, expected \
         an operator or the end; write it like 0.5*sin(2*pi*x/3)",
    );
    check(
        "(x - 1)^2",
        "sinn(x)",
        "pair.yaml:6: queues[0].segment.expression = \"0.5 + 0.1*sinn(x)\": `sinn` at column 11 is unknown; did you mean \
         `sin`?",
    );
    check(
        "(x - 1)^2",
        "abs(x - 1)",
        "pair.yaml:6: queues[0].segment.expression = \"0.5 + 0.1*abs(x - 1)\": is not twice differentiable at x = 1 \
         (`abs` at column 11); end the segment there and begin another, or round the corner off",
    );
    check(
        "(x - 1)^2",
        "/(x - 1)",
        "pair.yaml:6: queues[0].segment.expression = \"0.5 + 0.1*/(x - 1)\": does not parse at column 11: found `/`, \
         expected `(`, a name or a number; write it like 0.5*sin(2*pi*x/3)",
    );
    check(
        "to: 2.0",
        "to: 0.0",
        "pair.yaml:6: queues[0].segment.to = 0.0: the graph goes from x = 0 to x = 0, but must \
                                go to a greater x; write a greater one",
    );
}

/// A whole turn has no end to go on from, and needs no digits of 2 pi.
#[test]
fn a_circle_is_closed() {
    let line = "{kind: line, points: [[0.0, 0.5], [2.0, 0.5]]}";
    let with = |segment: &str| GOOD.replace(line, segment);
    let circle = "{kind: circle, centre: [1.5, 1.0], radius: 0.5, start_angle: 1.0}";
    let text = with(circle).replace("  starts: [[0.5, 0.5]]\n", "");
    assert!(parse("pair.yaml", &text).unwrap().queues[0].curve.is_closed());
    let open = parse("pair.yaml", &text.replace("radius: 0.5", "radius: 0.5, open_end: true")).unwrap_err().to_string();
    assert!(open.contains("a closed curve has no end"), "{open}");
    let none = parse("pair.yaml", &text.replace("radius: 0.5", "radius: 0.0")).unwrap_err().to_string();
    assert!(none.contains("the radius is 0, but must be greater than zero"), "{none}");
    let arc = "{kind: arc, centre: [1.5, 1.0], radius: 0.5, start_angle: 0.0, sweep: 6.2832}";
    let far = parse("pair.yaml", &with(arc)).unwrap_err().to_string();
    assert!(far.contains("sweep = 6.2832") && far.contains("write kind: circle for a whole turn"), "{far}");
}

/// Each kind as it stands in a file, with the length that its closed form has and where it is half of that on.
#[test]
fn every_kind_of_segment_is_read_and_told_to_others() {
    use std::f64::consts::{FRAC_1_SQRT_2, PI};
    let quarter = PI / 2.0;
    let kinds = [
        ("{kind: line, points: [[0.0, 0.5], [2.0, 0.5]]}", 2.0, [1.0, 0.5]),
        ("{kind: polyline, points: [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]]}", 7.0, [3.0, 0.5]),
        ("{kind: spline, points: [[0.0, 0.0], [0.5, 0.5], [1.5, 1.5], [2.0, 2.0]]}", 8f64.sqrt(), [1.0, 1.0]),
        ("{kind: bezier, points: [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0]]}", 3.0, [1.5, 1.0]),
        (
            "{kind: arc, centre: [1.0, 1.0], radius: 1.0, start_angle: 0.0, sweep: 1.570796326794897}",
            quarter,
            [1.0 + FRAC_1_SQRT_2, 1.0 + FRAC_1_SQRT_2],
        ),
        ("{kind: circle, centre: [1.0, 1.0], radius: 0.5}", PI, [0.5, 1.0]),
        ("{kind: ellipse, centre: [1.0, 1.0], semi_axes: [0.5, 0.5], rotation: 0.0}", PI, [0.5, 1.0]),
        (
            "{kind: sinusoid, origin: [0.0, 1.0], direction: 1.570796326794897, length: 2.0, amplitude: 0.0, wavelength: 1.0}",
            2.0,
            [0.0, 2.0],
        ),
        ("{kind: graph, expression: \"0.75*x\", from: 0.0, to: 4.0}", 5.0, [2.0, 1.5]),
    ];
    for (text, length, half_way) in kinds {
        let line = "{kind: line, points: [[0.0, 0.5], [2.0, 0.5]]}";
        let file = GOOD.replace(line, text).replace("  starts: [[0.5, 0.5]]\n", "");
        let file = file.replace("[[1.5, 0.5]]", &format!("[{half_way:?}]"));
        let plan = parse("pair.yaml", &file).unwrap();
        let curve = &plan.queues[0].curve;
        assert!((curve.length() - length).abs() < 1e-9, "{text}: {} m long", curve.length());
        let point = curve.at(0.5 * length).point;
        assert!((point.x - half_way[0]).hypot(point.y - half_way[1]) < 1e-9, "{text}: half way at {point}");
        let told = plan.message(Default::default());
        assert_eq!(trench_plan::curve_from_message(&told.queues[0].segment).unwrap(), *curve, "{text}");
    }
}
