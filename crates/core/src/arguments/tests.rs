use super::remap::{NameKind, Names};
use super::*;

fn parse(line: &str) -> Result<Arguments, UsageError> {
    Arguments::parse(line.split_whitespace().map(str::to_owned))
}

#[test]
fn a_bare_command_line_is_the_default() {
    assert_eq!(parse("").unwrap(), Arguments::default());
    assert_eq!(parse("--ros-args").unwrap(), Arguments::default());
    assert_eq!(parse("--ros-args -- --ros-args --").unwrap(), Arguments::default());
}

#[test]
fn sections_add_up_in_order() {
    let parsed = parse("--ros-args --params-file a.yaml -p k:=1 -- --ros-args -p node:k:=[1, --params-file b").unwrap();
    assert_eq!(
        parsed.parameters,
        [
            ParameterSource::File("a.yaml".to_owned()),
            ParameterSource::Override { node: None, name: "k".to_owned(), value: "1".to_owned() },
            ParameterSource::Override { node: Some("node".to_owned()), name: "k".to_owned(), value: "[1,".to_owned() },
            ParameterSource::File("b".to_owned()),
        ]
    );
}

#[test]
fn log_levels() {
    let parsed = parse("--ros-args --log-level warn --log-level a:=DEBUG --disable-rosout-logs").unwrap();
    assert_eq!((parsed.level_of("a"), parsed.level_of("b")), (Level::Debug, Level::Warn));
    assert!(!parsed.rosout && parsed.console);
}

#[test]
fn what_is_wrong_is_named() {
    let check = |line, expected: &str| assert_eq!(parse(line).unwrap_err().to_string(), expected, "{line}");
    check("--frobnicate", "unknown argument `--frobnicate`; ROS arguments stand behind --ros-args, see --help");
    check("-r a:=b", "unknown argument `-r`; ROS arguments stand behind --ros-args, see --help");
    check("--ros-args --x", "unknown argument `--x`; ROS arguments stand behind --ros-args, see --help");
    check("--ros-args -r", "-r wants a value behind it");
    let remap = "is no remapping; write -r from:=to, -r __node:=name or -r __ns:=/namespace";
    check("--ros-args -r a", &format!("`-r a` {remap}"));
    check("--ros-args -r a:=", &format!("`-r a:=` {remap}"));
    check("--ros-args -r :=a", &format!("`-r :=a` {remap}"));
    check("--ros-args -r __ns:=a", &format!("`-r __ns:=a` {remap}"));
    check("--ros-args -p k=1", "`-p k=1` sets no parameter; write -p name:=value or -p node:name:=value");
    check(
        "--ros-args --log-level loud",
        "`--log-level loud` names no level; write debug, info, warn, error or fatal, or logger:=level",
    );
}

#[test]
fn names_follow_the_first_rule_that_fits() {
    let parsed = parse(
        "--ros-args -r __ns:=/robot1 -r __node:=pilot -r cmd_vel:=drive -r cmd_vel:=never -r /tf:=/other/tf \
         -r ~/state:=/state -r rosservice://arm:=/arm -r ghost:tf2:=/no",
    )
    .unwrap();
    let names = Names::new(&parsed.remaps, "formation_controller");
    assert_eq!((names.node.as_str(), names.namespace.as_str()), ("pilot", "/robot1"));
    let check = |name, kind, expected: &str| assert_eq!(names.resolve(name, kind), expected);
    check("cmd_vel", NameKind::Topic, "/robot1/drive");
    check("/robot1/cmd_vel", NameKind::Topic, "/robot1/drive");
    check("/tf", NameKind::Topic, "/other/tf");
    check("~/state", NameKind::Topic, "/state");
    check("arm", NameKind::Topic, "/robot1/arm");
    check("arm", NameKind::Service, "/arm");
    check("tf2", NameKind::Topic, "/robot1/tf2");
    check("/team_state", NameKind::Topic, "/team_state");
}

#[test]
fn a_rule_for_another_node_does_not_rename_this_one() {
    let parsed = parse("--ros-args -r other:__node:=x -r this:__ns:=/a/").unwrap();
    let names = Names::new(&parsed.remaps, "this");
    assert_eq!((names.node.as_str(), names.namespace.as_str()), ("this", "/a"));
}

#[test]
fn a_process_has_a_node_in_each_namespace() {
    let check = |line: &[&str], expected: &[(&str, &str)]| {
        let parsed = Arguments::parse(line.iter().map(|word| (*word).to_owned())).unwrap();
        let nodes = parsed.of_each_node("pilot");
        let names = nodes.iter().map(|node| Names::new(&node.remaps, "pilot"));
        let found: Vec<(String, String)> = names.map(|names| (names.namespace, names.node)).collect();
        let expected: Vec<_> = expected.iter().map(|(space, node)| ((*space).to_owned(), (*node).to_owned())).collect();
        assert_eq!(found, expected, "{line:?}");
    };
    check(&[], &[("/", "pilot")]);
    check(&["--namespaces", "[robot1, /lab/robot2]"], &[("/robot1", "pilot"), ("/lab/robot2", "pilot")]);
    check(&["--namespaces", "robot1/"], &[("/robot1", "pilot")]);
    let below = ["--namespaces", "[a, /b]", "--ros-args", "-r", "__ns:=/lab", "-r", "__node:=driver"];
    check(&below, &[("/lab/a", "driver"), ("/b", "driver")]);
}

#[test]
fn namespaces_that_are_none_are_refused() {
    for list in ["[]", "[robot1, robot1]", "[robot1, /robot1]", "[1, 2]", "[/]", "[robot1"] {
        let refused = Arguments::parse(["--namespaces".to_owned(), list.to_owned()]).unwrap_err();
        assert_eq!(refused, UsageError::Namespaces(list.to_owned()));
    }
}
