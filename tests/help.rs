//! What `--help` says of every program and subcommand: enough for somebody who has never seen them.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;

const NODES: [&str; 10] = [
    "bag_player",
    "bag_recorder",
    "formation_controller",
    "leader_assignment",
    "obstacle_mapper",
    "operator",
    "overhead_camera",
    "overhead_localizer",
    "rf_bridge",
    "testbed",
];

/// What a program says to these arguments, which must be understood.
fn said(program: &Path, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    assert!(output.status.success(), "{} {arguments:?}: {output:?}", program.display());
    assert!(output.stderr.is_empty(), "{} {arguments:?}: {output:?}", program.display());
    String::from_utf8(output.stdout).unwrap()
}

/// Commands listed below the line `Commands:`.
fn commands(help: &str) -> Vec<String> {
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    // A description that goes on in the next line is indented further.
    let named = listed.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    named.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help").map(str::to_owned).collect()
}

#[test]
fn every_node_tells_its_purpose_exit_codes_and_parameters() {
    for node in NODES {
        let help = said(&Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name(node), &["--help"]);
        let about = help.lines().next().unwrap();
        assert!(about.len() > 20, "{node}: {about}");
        for part in ["Usage: ", "ROS arguments", "Environment:", "ROS_DOMAIN_ID", "Exit codes:", "Parameters:"] {
            assert!(help.contains(part), "{node} says nothing of {part}: {help}");
        }
        let parameters: Vec<&str> = help.lines().skip_while(|line| *line != "Parameters:").skip(1).collect();
        let pairs = parameters.chunks(2);
        assert!(pairs.len() > 2, "{node}: {help}");
        for pair in pairs {
            let is_told = pair.len() == 2 && pair[0].starts_with("  ") && pair[1].trim().len() > 5;
            assert!(is_told && (pair[0].contains(") = ") || pair[0].ends_with(')')), "{node}: {pair:?}");
        }
    }
}

#[test]
fn every_command_of_trench_tells_what_it_does_and_takes() {
    let trench = Path::new(env!("CARGO_BIN_EXE_trench"));
    let mut asked = vec![Vec::new()];
    let mut seen = 0;
    while let Some(path) = asked.pop() {
        let words: Vec<&str> = path.iter().map(String::as_str).chain(["--help"]).collect();
        let help = said(trench, &words);
        assert!(help.lines().next().unwrap().len() > 15, "{path:?}: {help}");
        assert!(help.contains("Usage: trench") && help.contains("--help"), "{path:?}: {help}");
        let mut listed = help.lines().skip_while(|line| *line != "Arguments:").skip(1).peekable();
        while let Some(line) = listed.next_if(|line| !line.is_empty()) {
            // What an argument is stands beside it or below.
            let is_name = line.starts_with("  [") || line.starts_with("  <");
            let below = listed.peek().is_some_and(|next| next.starts_with("      "));
            assert!(!is_name || below || line.split_whitespace().count() > 2, "{path:?}: no word on {line}");
        }
        asked.extend(commands(&help).into_iter().map(|command| [&path[..], &[command]].concat()));
        seen += 1;
    }
    assert!(seen > 12, "{seen} commands");
}
