//! `trench sim` on scenario files: the same bytes twice, bags that are runs, errors that name file and line.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helper functions too")]

use std::io::Read;
use std::path::Path;
use std::process::{Command, Output};
use trench_bag::BagReader;
use trench_bag::run::Run;

fn trench(arguments: &[&str]) -> Output {
    let root = env!("CARGO_MANIFEST_DIR");
    Command::new(env!("CARGO_BIN_EXE_trench")).args(arguments).current_dir(root).output().unwrap()
}

fn simulate(folder: &Path) -> (Vec<u8>, Vec<u8>, Vec<u8>) {
    // A bag says its own name: equal bytes need equal names.
    std::fs::create_dir(folder).unwrap();
    let (csv, bag) = (folder.join("run.csv"), folder.join("run"));
    let file = "config/scenarios/7.12.yaml";
    let output =
        trench(&["sim", file, "--quiet", "--json", "--csv", csv.to_str().unwrap(), "--bag", bag.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mcap = bag.join("run_0.mcap");
    (output.stdout, std::fs::read(csv).unwrap(), std::fs::read(mcap).unwrap())
}

#[test]
fn the_same_bytes_twice() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (simulate(&folder.path().join("first")), simulate(&folder.path().join("second")));
    assert!(first == second, "two runs differ");

    let summary: serde_json::Value = serde_json::from_slice(&first.0).unwrap();
    assert!(summary["cases"][0]["conforms_after"].as_f64().unwrap() < 60.0, "{summary}");
    let run = Run::from_bag(&BagReader::open(&folder.path().join("first/run")).unwrap()).unwrap();
    assert_eq!((run.robots.len(), run.undecodable), (1, 0));
    assert_eq!(run.formation.unwrap().queues[0].segment.points.len(), 2);
    let table = Run::from_csv(&String::from_utf8(first.1).unwrap()).unwrap();
    assert_eq!(table.robots["r1"].poses.len(), run.robots["r1"].poses.len());
}

#[test]
fn launch_scenarios_run_the_node_cores() {
    let output = trench(&["sim", "config/scenarios/4.6_square.yaml", "--quiet", "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["robots"].as_array().unwrap().len(), 4, "{summary}");
}

/// Scenarios of the thesis with obstacles and remedies: the same summary on one thread as on three.
#[test]
fn scenarios_of_the_thesis_are_the_same_on_any_number_of_threads() {
    for file in ["config/scenarios/7.10_obstacles.yaml", "config/scenarios/7.14.yaml"] {
        let [one, three] =
            ["1", "3"].map(|threads| trench(&["sim", file, "--threads", threads, "--quiet", "--json"]).stdout);
        assert!(!one.is_empty() && one == three, "{file}");
    }
}

/// Teams that cannot do it run all the same, and are said to be such: on standard error, and in the JSON.
#[test]
fn infeasible_teams_are_said_to_be() {
    let folder = tempfile::tempdir().unwrap();
    let check = |name: &str, old: &str, new: &str, kind: &str, expected: &str| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/scenarios");
        let text = std::fs::read_to_string(root.join(name)).unwrap();
        assert_eq!(text.matches(old).count(), 1, "{old} must stand once in {name}");
        let file = folder.path().join(name);
        let text = text.replace(old, new).replace("duration: 200.0", "duration: 1.0");
        std::fs::write(&file, text.replace("5.0, 20.0, 35.0, 60.0, 200.0]", "1.0]")).unwrap();
        let output = trench(&["sim", file.to_str().unwrap(), "--quiet", "--json"]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && told.contains(expected), "{told}");
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(summary["infeasible"][0]["check"], kind, "{summary}");
    };
    let away = "{position: [-500.0, 529.7]";
    check("6.5.yaml", "{position: [26.0026, 29.7094]", away, "connection", "connection: r2 begins");
    check(
        "7.10.yaml",
        "[100.0, 100.0]]}\nteam_goal: [100.0, 100.0]",
        "[5.0, 5.0]]}\nteam_goal: [5.0, 5.0]",
        "room",
        "4 places, 4 m from each other, but there are 10 robots",
    );
    let fine = trench(&["sim", "config/scenarios/7.12.yaml", "--quiet", "--json"]);
    assert!(fine.stderr.is_empty() && String::from_utf8(fine.stdout).unwrap().contains("\"infeasible\": []"));
}

#[test]
fn mistakes_are_told_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wrong.yaml");
    std::fs::write(&file, "name: a\nkind: regulation\nduration: 1.0\nstep: -1.0\n").unwrap();
    let output = trench(&["sim", file.to_str().unwrap()]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(told.contains("wrong.yaml:4: step = -1.0: is not positive; write a number above 0"), "{told}");
}

/// A shipped scenario, changed, run to its end: its summary as people are told it and as programs are, and standard error.
fn changed(name: &str, changes: &[(&str, &str)]) -> (String, serde_json::Value, String) {
    let (told, json, errors) = changed_with(name, changes, 0);
    (told, json, errors[0].clone())
}

/// The same of a run with this exit code; standard error as people are told it and beside the summary for programs.
fn changed_with(name: &str, changes: &[(&str, &str)], code: i32) -> (String, serde_json::Value, [String; 2]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/scenarios");
    let mut text = std::fs::read_to_string(root.join(name)).unwrap();
    for (old, new) in changes {
        assert_eq!(text.matches(old).count(), 1, "{old} must stand once in {name}");
        text = text.replace(old, new);
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    std::fs::write(&file, text).unwrap();
    let told = trench(&["sim", file.to_str().unwrap(), "--quiet"]);
    let json = trench(&["sim", file.to_str().unwrap(), "--quiet", "--json"]);
    let errors = [&told, &json].map(|output| String::from_utf8(output.stderr.clone()).unwrap());
    assert_eq!([told.status.code(), json.status.code()], [Some(code); 2], "{errors:?}");
    let json = serde_json::from_slice(&json.stdout).unwrap();
    (String::from_utf8(told.stdout).unwrap(), json, errors)
}

/// A wall that the trench outdoes: the robot goes through, and that is said as it is.
#[test]
fn who_was_inside_an_obstacle_is_told_so() {
    let weak = ("strength: 10.0, m: 2, edge: jump}", "strength: 10.0, m: 2, edge: jump, full_acceleration: 5.0}");
    let (told, json, errors) = changed_with("7.11.yaml", &[weak], 10);
    assert!(told.contains("obstacle 1: a robot was inside the obstacle, 1.0000 m from its edge"), "{told}");
    assert!(told.lines().any(|line| line.starts_with("collided: r1 went into obstacle 1 at ")), "{told}");
    let conforms = told.lines().find(|line| line.contains("all conform after ")).unwrap();
    assert!(conforms.ends_with(", but robots went through obstacles:"), "{told}");
    let collision = &json["cases"][0]["collisions"][0];
    assert_eq!([&collision["robot"], &collision["way"]], ["r1", "into"], "{collision}");
    // Who reads neither is told, too.
    assert!(errors[0].is_empty() && errors[1].contains(": collided: r1 went into obstacle 1 at "), "{errors:?}");
}

/// A thin wall that is crossed between two steps.
#[test]
fn who_went_through_a_wall_is_told_so() {
    let wall =
        ("- {polygon: [[-3.0, 2.0], [3.0, 2.0], [3.0, 4.0], [-3.0, 4.0]]}", "- {walls: [[-3.0, 2.0], [3.0, 2.0]]}");
    let weak = ("strength: 10.0, m: 2, edge: jump}", "strength: 10.0, m: 2, edge: jump, full_acceleration: 5.0}");
    let (told, json, _) = changed_with("7.11.yaml", &[wall, weak], 10);
    assert!(
        told.contains("\n  r1 went through obstacle 1 at ")
            && told.contains("\n  obstacle 1: a robot went through it\n"),
        "{told}"
    );
    assert_eq!(json["cases"][0]["collisions"][0]["way"], "through");
    assert_eq!(json["cases"][0]["obstacles"][0]["least_gap"], 0.0);
}

/// What a scenario does not have is not spoken of.
#[test]
fn zones_and_sections_are_told_where_there_are_some() {
    let (told, json, _) = changed("8.4_queue.yaml", &[("section: \"8.4\"\n", "")]);
    assert!(!told.contains("zone 1") && !told.contains("section"), "{told}");
    assert!(json["cases"][0]["in_zone_1"].is_null() && json["cases"][0]["closest_pair"].is_number());
    let (told, ..) = changed("7.10.yaml", &[]);
    assert!(told.contains(", 0.000 s in zone 1\n") && told.contains(" (section 7.10): "), "{told}");
}

/// A robot that an obstacle has left nowhere to go: said before the run, in the summary, and since when.
#[test]
fn who_has_no_fragment_is_told_so() {
    let obstacle = (
        "- {polygon: [[-3.0, 2.0], [3.0, 2.0], [3.0, 4.0], [-3.0, 4.0]]}",
        "- {polygon: [[-30.0, -15.0], [30.0, -15.0], [30.0, -12.0], [-30.0, -12.0]], velocity: [0.0, 0.2]}",
    );
    let (told, json, error) = changed("7.11.yaml", &[obstacle]);
    assert!(
        error.contains("room: obstacles that move leave no qualified fragment from 55.00 s on to the end"),
        "{error}"
    );
    assert!(told.contains("r1 has been drawn nowhere since 55.0"), "{told}");
    let since = json["cases"][0]["robots"][0]["no_fragment_since"].as_f64().unwrap();
    assert!((since - 55.0).abs() < 0.01, "{since}");
    assert_eq!(json["infeasible"][0]["check"], "room");
}

/// Leaders are in neutral zones, or it is said who is not, and why not.
#[test]
fn leaders_are_in_neutral_zones_or_it_is_said_why_not() {
    let (told, json, _) = changed("7.10.yaml", &[]);
    assert!(told.contains("leaders in neutral zones for good after ") && told.contains("V of the laws: "), "{told}");
    assert_eq!(json["cases"][0]["outside_neutral"], serde_json::json!([]));
    let (told, json, _) = changed("6.5_bounded.yaml", &[]);
    assert!(!told.contains("leaders in neutral zones for good"), "{told}");
    let outside = json["cases"][0]["outside_neutral"].as_array().unwrap();
    assert!(!outside.is_empty() && json["cases"][0]["neutral_after"].is_null());
    for one in outside {
        assert_eq!(one["zone"], 4, "{one}");
        assert!(one["why"].as_str().unwrap().contains("edge of the neutral zone from outside"), "{one}");
    }
    let (robot, leader) = (outside[0]["robot"].as_str().unwrap(), outside[0]["leader"].as_str().unwrap());
    assert!(told.contains(&format!("  {leader} is in zone 4 of {robot}, 10.0")), "{told}");
}

/// Options that would do nothing for a scenario are refused, each with the reason.
#[test]
fn options_of_launch_files_are_refused() {
    let file = "config/scenarios/7.12.yaml";
    for (given, part) in [
        (&["foo:=bar"][..], "foo:=bar would do nothing; leave it out: arguments are those of launch files"),
        (&["--journal", "none"], "--journal would do nothing; leave it out: journals are those of nodes"),
        (&["--seconds", "1"], "--seconds would do nothing; leave it out: the file says its `duration`"),
        (&["--seed", "7"], "--seed would do nothing; leave it out: nothing in it is random"),
    ] {
        let output = trench(&[&["sim", file], given].concat());
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(
            told.contains("config/scenarios/7.12.yaml: is a scenario without a launch file") && told.contains(part),
            "{told}"
        );
    }
}

/// A run that diverges ends there, and is told with the moment, the robot and the remedy.
#[test]
fn runs_that_diverge_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/scenarios/6.5.yaml");
    let text = std::fs::read_to_string(root).unwrap();
    let file = folder.path().join("large.yaml");
    // Damping that is too stiff for the step.
    let stiff = text.replace("step: 0.01 ", "step: 0.1 ").replace("damping: 2.0 ", "damping: 100.0 ");
    assert_ne!(stiff, text);
    std::fs::write(&file, stiff).unwrap();
    let output = trench(&["sim", file.to_str().unwrap(), "--quiet"]);
    let told = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(10), "{told}");
    let line = told.lines().find(|line| line.starts_with("diverged after ")).unwrap();
    assert!(line.contains(": r") && line.contains("make the step smaller, or the gains"), "{told}");
}

/// 300 robots in three rows, for a few steps.
fn crowd() -> String {
    let settings = "name: crowd\nkind: nearest_points\nduration: 0.4\nstep: 0.02\nmethod: semi_implicit_euler\n\
        segment: {kind: line, points: [[0.0, 0.0], [400.0, 0.0]]}\ntrench: {kind: hyperbolic, alpha: 0.5, a: 0.5}\n\
        damping: 2.0\nzoning: {rho_underbar: 0.4, rho_hat: 1.0, rho: 3.0, rho_check: 6.0, rho_bar: 10.0, alpha: 0.2, \
        beta: 0.05, m: 1}\nobstacle_potential: {pole: 0.2, cut: 0.5, strength: 0.1, m: 1}\nrobots:\n";
    let robot = |rank: u32| {
        let (column, row) = (rank / 3, f64::from(rank % 3));
        format!("- {{position: [{:?}, {:?}]}}\n", 390.0 - f64::from(column) - 0.1 * row, 0.7 * row - 0.5)
    };
    settings.to_owned() + &(0..300).map(robot).collect::<String>()
}

#[test]
fn any_number_of_threads_makes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("crowd.yaml");
    std::fs::write(&file, crowd()).unwrap();
    let simulated = |threads: &str| {
        let own = folder.path().join(threads);
        std::fs::create_dir(&own).unwrap();
        let (csv, bag) = (own.join("run.csv"), own.join("run"));
        let paths = [&file, &csv, &bag].map(|path| path.to_str().unwrap());
        let [file, csv, bag_text] = paths;
        let output = trench(&["sim", file, "--threads", threads, "--quiet", "--json", "--csv", csv, "--bag", bag_text]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (output.stdout, std::fs::read(csv).unwrap(), std::fs::read(bag.join("run_0.mcap")).unwrap())
    };
    let one = simulated("1");
    let summary: serde_json::Value = serde_json::from_slice(&one.0).unwrap();
    assert_eq!(summary["cases"][0]["robots"].as_array().unwrap().len(), 300);
    assert!(simulated("2") == one && simulated("3") == one, "threads change what comes out");
    assert_eq!(trench(&["sim", file.to_str().unwrap(), "--threads", "0"]).status.code(), Some(2));
}

/// What a command says on standard error where that is a terminal.
fn on_a_terminal(arguments: &[&str]) -> String {
    use rustix::pty;
    let flags = pty::OpenptFlags::RDWR | pty::OpenptFlags::NOCTTY;
    let ours = pty::openpt(flags).unwrap();
    pty::grantpt(&ours).unwrap();
    pty::unlockpt(&ours).unwrap();
    let name = pty::ptsname(&ours, Vec::new()).unwrap().into_string().unwrap();
    let theirs = std::fs::OpenOptions::new().read(true).write(true).open(name).unwrap();
    let reader = std::thread::spawn(move || {
        let (mut ours, mut said, mut piece) = (std::fs::File::from(ours), Vec::new(), [0; 4096]);
        // When the last other end is closed, reading fails.
        while let Ok(count @ 1..) = ours.read(&mut piece) {
            said.extend_from_slice(&piece[..count]);
        }
        String::from_utf8(said).unwrap()
    });
    let root = env!("CARGO_MANIFEST_DIR");
    let mut command = Command::new(env!("CARGO_BIN_EXE_trench"));
    command.args(arguments).current_dir(root).stdout(std::process::Stdio::null()).stderr(theirs);
    assert!(command.status().unwrap().success());
    drop(command);
    reader.join().unwrap()
}

#[test]
fn how_far_it_is_stands_on_terminals_alone() {
    let square = ["sim", "launch/square.launch.yaml", "render:=true", "duration:=12.0", "tolerance:=1.0"];
    let quiet = [&square[..], &["--quiet"]].concat();
    let said = on_a_terminal(&square);
    assert!(said.contains("\r\u{1b}[K") && said.contains(" s simulated\r"), "{said:?}");
    let said = on_a_terminal(&quiet);
    assert_eq!(said.lines().count(), 1, "{said:?}");
    assert!(said.contains("times real time") && !said.contains('\u{1b}'), "{said:?}");
    // Into a file goes what nodes say, and no line that is written over.
    let output = trench(&square);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("/operator: ") && !said.contains('\r') && !said.contains('\u{1b}'), "{said}");
}
