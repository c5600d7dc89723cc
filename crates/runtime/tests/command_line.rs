//! What a user sees of a node: exit codes, error texts, help, signals.

#[cfg(test)]
mod common;

use common::Island;

#[expect(clippy::unwrap_used, reason = "a test helper")]
fn ends_with(number: u16, example: &str, arguments: &str, code: i32, expected: &[&str]) {
    let output = Island::new(number).command(example, arguments).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(code), "{arguments}: {text}");
    for part in expected {
        assert!(text.contains(part), "{arguments}: `{part}` is not in:\n{text}");
    }
}

#[test]
fn a_wrong_command_line_ends_with_2() {
    ends_with(30, "talker", "--frobnicate", 2, &["talker: unknown argument `--frobnicate`"]);
    ends_with(30, "talker", "--ros-args -p rate", 2, &["sets no parameter"]);
}

#[test]
fn wrong_parameters_end_with_3_and_say_what_would_be_right() {
    ends_with(30, "talker", "--ros-args -p rat:=1.0", 3, &["command line: rat = 1.0: unknown parameter", "rate"]);
    ends_with(30, "talker", "--ros-args -p rate:=1", 3, &["rate = 1", "is of type integer", "write 1.0"]);
    ends_with(30, "talker", "--ros-args -p rate:=-1.0", 3, &["out of range", "from 0.1 to"]);
    ends_with(30, "talker", "--ros-args -p local:=pigeon", 3, &["local = \"pigeon\"", "shared_memory_only"]);
    ends_with(30, "talker", "--ros-args --params-file /no/such", 3, &["/no/such", "cannot be read"]);
}

#[test]
fn a_parameter_file_is_read_and_its_errors_name_the_line() {
    let folder = std::env::temp_dir().join(format!("trench-parameters-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("talker.yaml");
    std::fs::write(&file, "/**:\n  ros__parameters:\n    rate: 500.0\n    count: 3\n").unwrap();
    ends_with(30, "talker", &format!("--ros-args --params-file {}", file.display()), 0, &["sent 3 messages"]);
    std::fs::write(&file, "talker:\n  ros__parameters:\n    rate: 1.0\n    coun: 3\n").unwrap();
    let expected = ["talker.yaml:4: coun = 3: unknown parameter", "count"];
    ends_with(30, "talker", &format!("--ros-args --params-file {}", file.display()), 3, &expected);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn help_describes_the_parameters() {
    let expected =
        ["Counts on /chatter.", "rate (double, from 0.1 to 100000) = 1.0", "messages a second", "Exit codes"];
    ends_with(30, "talker", "--help", 0, &expected);
}

#[test]
fn a_wrong_domain_ends_with_2() {
    let output = Island::new(30).command("talker", "").env("ROS_DOMAIN_ID", "233").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("ROS_DOMAIN_ID is `233`; write a whole number from 0 to"));
}

#[test]
fn signals_end_a_node_cleanly_after_its_last_words() {
    for (number, name) in ["INT", "TERM"].into_iter().enumerate() {
        let island = Island::new(31 + number as u16);
        let talker = island.start("talker", "--ros-args -p rate:=100.0 --log-level debug");
        talker.wait_for_log("said 5");
        talker.signal(name);
        let (code, _, errors) = talker.end();
        assert_eq!(code, 0, "{errors:?}");
        assert!(errors.iter().any(|line| line.contains("[INFO]") && line.contains("[talker]: sent ")), "{errors:?}");
    }
}

#[test]
fn nodes_are_renamed_and_their_topics_remapped() {
    let island = Island::new(34);
    let listener = island.start("listener", "--ros-args -r /chatter:=talk -r __ns:=/hall -r __node:=ear");
    let talker = island.start("talker", "--ros-args -r /chatter:=/hall/talk -p rate:=100.0");
    listener.line();
    drop(talker);
    listener.signal("INT");
    let (_, _, errors) = listener.end();
    assert!(errors.iter().any(|line| line.contains("[hall.ear]: heard")), "{errors:?}");
}

#[test]
fn simulated_time_stands_at_zero_until_a_clock_speaks() {
    let island = Island::new(36);
    let talker = island.start("talker", "--ros-args -p use_sim_time:=true -p count:=3 -p rate:=100.0");
    let (code, _, errors) = talker.end();
    assert_eq!(
        (code, errors.as_slice()),
        (0, ["[INFO] [0.000000000] [talker]: sent 3 messages".to_owned()].as_slice())
    );
}
