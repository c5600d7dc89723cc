use super::{Source, parse_value, resolve};
use crate::{ParameterDescriptor, ParameterValue, Parameters};

fn descriptors() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::double("gains.k1", 0.1, "1/s").range(0.0, 10.0),
        ParameterDescriptor::double("gains.k2", 1.0, "-"),
        ParameterDescriptor::integer("rank", 1, "-").range(1.0, 12.0),
        ParameterDescriptor::string("law", "robust", "-"),
        ParameterDescriptor::double_list("radii", &[0.2], "m"),
        ParameterDescriptor::string_list("robots", &[], "-"),
    ]
}

/// Resolves for /robot1/controller.
fn resolved(sources: &[Source<'_>]) -> Result<Parameters, Vec<String>> {
    resolve(sources, "/robot1", "controller", &descriptors())
        .map_err(|errors| errors.iter().map(ToString::to_string).collect())
}

fn file(text: &str) -> Source<'_> {
    Source::File { name: "p.yaml", text }
}

#[test]
fn defaults_hold_where_nothing_is_said() {
    let parameters = resolved(&[]).unwrap();
    assert_eq!(parameters.f64("gains.k1"), Ok(0.1));
    assert_eq!(parameters.str("law"), Ok("robust"));
    assert_eq!(parameters.bool("use_sim_time"), Ok(false));
    assert_eq!(parameters.get("rank").unwrap().1.to_string(), "default");
}

#[test]
fn nested_maps_become_dotted_names() {
    let parameters = resolved(&[file(
        "robot1:\n  controller:\n    ros__parameters:\n      gains: {k1: 0.2}\n      gains.k2: 2.0\n      use_sim_time: true\n",
    )])
    .unwrap();
    assert_eq!(parameters.f64("gains.k1"), Ok(0.2));
    assert_eq!(parameters.f64("gains.k2"), Ok(2.0));
    assert_eq!(parameters.bool("use_sim_time"), Ok(true));
    assert_eq!(parameters.get("gains.k1").unwrap().1.to_string(), "p.yaml:4");
}

#[test]
fn a_full_name_beats_a_wildcard_and_the_last_of_equals_wins() {
    let full = "/robot1/controller: {ros__parameters: {rank: 2}}";
    let wildcard = "/**: {ros__parameters: {rank: 3}}";
    let other = "/robot2/controller: {ros__parameters: {rank: 4, no_such: 1}}";
    let command_line = Source::Override { node: None, name: "rank", value: "5" };
    let named = Source::Override { node: Some("controller"), name: "rank", value: "6" };
    for (sources, expected) in [
        (vec![file(full), file(wildcard)], 2),
        (vec![file(wildcard), file(full), file(other)], 2),
        (vec![file(wildcard), command_line], 5),
        (vec![command_line, file(wildcard)], 5),
        (vec![file(full), command_line], 5),
        (vec![file(wildcard), file(full), command_line], 5),
        (vec![command_line, file(full)], 2),
        (vec![command_line, named], 6),
        (vec![file("/*/*: {ros__parameters: {rank: 7}}")], 7),
    ] {
        assert_eq!(resolved(&sources).unwrap().i64("rank"), Ok(expected), "{sources:?}");
    }
}

#[test]
fn an_empty_list_takes_the_declared_type() {
    let parameters = resolved(&[file("/**: {ros__parameters: {radii: [], robots: []}}")]).unwrap();
    assert_eq!(parameters.f64_list("radii"), Ok([].as_slice()));
    assert_eq!(parameters.str_list("robots"), Ok([].as_slice()));
}

#[test]
fn a_name_is_there_once() {
    let names = |list: &str| {
        let parameters = resolved(&[file(&format!("/**:\n  ros__parameters:\n    robots: {list}"))]).unwrap();
        let names = parameters.names("robots").map(<[String]>::to_vec);
        (names, parameters.some_names("robots").map(<[String]>::len).map_err(|error| error.to_string()))
    };
    assert_eq!(names("[b, a]"), (Ok(vec!["b".to_owned(), "a".to_owned()]), Ok(2)));
    let (none, refused) = names("[]");
    assert_eq!(none, Ok(Vec::new()));
    assert_eq!(refused.unwrap_err(), "p.yaml:3: robots = []: there is no robot; name them: robots: [robot1, robot2]");
    let (twice, refused) = names("[a, b, a]");
    let expected = "p.yaml:3: robots = [\"a\", \"b\", \"a\"]: a is there twice; name each robot once";
    assert_eq!((twice.unwrap_err().to_string(), refused.unwrap_err()), (expected.to_owned(), expected.to_owned()));
    let (empty, _) = names("[a, '']");
    assert_eq!(
        empty.unwrap_err().to_string(),
        "p.yaml:3: robots = [\"a\", \"\"]: has an empty name; give each robot a name"
    );
}

#[test]
fn mistakes_are_named_with_their_remedy() {
    for (text, expected) in [
        (
            "/**:\n  ros__parameters:\n    gains: {k1: 1}",
            "p.yaml:3: gains.k1 = 1: is of type integer, declared as double; write 1.0",
        ),
        (
            "/**:\n  ros__parameters:\n    rank: 2.0",
            "p.yaml:3: rank = 2.0: is of type double, declared as integer; write 2",
        ),
        ("/**: {ros__parameters: {rank: 13}}", "p.yaml:1: rank = 13: is out of range; write a value from 1 to 12"),
        (
            "/**: {ros__parameters: {gains: {k1: .nan}}}",
            "p.yaml:1: gains.k1 = NaN: is not a finite number; write a finite one",
        ),
        (
            "/**: {ros__parameters: {law: 3}}",
            "p.yaml:1: law = 3: is of type integer, declared as string; write \"3\" in quotes",
        ),
        (
            "/**: {ros__parameters: {rank: \"3\"}}",
            "p.yaml:1: rank = \"3\": is of type string, declared as integer; write an integer, for example 1",
        ),
        (
            "/**: {ros__parameters: {rank: []}}",
            "p.yaml:1: rank = []: is a list, declared as integer; write an integer, for example 1",
        ),
        (
            "/**: {ros__parameters: {gain: {k1: 1.0}}}",
            "p.yaml:1: gain.k1 = 1.0: unknown parameter; did you mean `gains.k1`?",
        ),
        (
            "/**: {ros__parameters: {radii: [1, 2]}}",
            "p.yaml:1: radii = [1, 2]: is of type integer array, declared as double array; write [1.0, 2.0]",
        ),
        (
            "/**: {ros__parameters: {radii: [1.0, 2]}}",
            "p.yaml:1: radii: mixes integers and doubles; write a decimal point in each element",
        ),
        (
            "/**: {ros__parameters: {radii: [[1.0], 2]}}",
            "p.yaml:1: radii: is a list; write a single value: ROS 2 knows no lists of lists",
        ),
        ("/**: {ros__parameters: {rank: }}", "p.yaml:1: rank: has no value; write a value"),
        (
            "ros__parameters: {rank: 3}",
            "p.yaml:1: ros__parameters: `ros__parameters` stands without a node name; write `/**:` above it",
        ),
        ("/**: {rank: 3}", "p.yaml:1: /**.rank = 3: is an integer; write a node name with `ros__parameters:` below it"),
        ("/**:\n  ros__parameters: [1]", "p.yaml:2: /**.ros__parameters: is a list; write a map of parameters"),
    ] {
        assert_eq!(resolved(&[file(text)]), Err(vec![expected.to_owned()]), "{text}");
    }
}

#[test]
fn all_mistakes_are_reported_at_once() {
    let text = "/**:\n  ros__parameters:\n    rank: x\n    no_such_thing: 1\n";
    let command_line = Source::Override { node: None, name: "law", value: "{a: 1}" };
    assert_eq!(
        resolved(&[file(text), command_line]).unwrap_err(),
        [
            "p.yaml:3: rank = \"x\": is of type string, declared as integer; write an integer, for example 1",
            "p.yaml:4: no_such_thing = 1: unknown parameter; known are: gains.k1, gains.k2, law, radii, rank, robots, use_sim_time",
            "command line: law: is a map; write a value or a list of values",
        ]
    );
}

#[test]
fn values_on_the_command_line_are_yaml() {
    for (text, expected) in [
        ("1", Some(ParameterValue::Integer(1))),
        ("1.0", Some(ParameterValue::Double(1.0))),
        ("'1'", Some(ParameterValue::String("1".to_owned()))),
        ("[a, b]", Some(ParameterValue::StringArray(vec!["a".to_owned(), "b".to_owned()]))),
        ("[]", None),
    ] {
        assert_eq!(parse_value("x", text), Ok(expected), "{text}");
    }
    assert_eq!(parse_value("x", "").unwrap_err().to_string(), "command line: x: has no value; write a value");
}

#[test]
fn getters_tell_what_a_node_did_not_declare() {
    let parameters = resolved(&[]).unwrap();
    assert_eq!(
        parameters.i64("gains.k1").unwrap_err().to_string(),
        "default: gains.k1 = 0.1: is of type double; the node wants an integer"
    );
    assert_eq!(
        parameters.f64("gains.k9").unwrap_err().to_string(),
        "gains.k9: is not declared; the node must declare it"
    );
    assert_eq!(
        parameters.f64_array::<2>("radii").unwrap_err().to_string(),
        "default: radii = [0.2]: has 1 elements; write 2"
    );
}
