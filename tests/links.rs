//! Links that break and robots that quit and join, in lock-step with the radio medium: the column keeps its formation
//! (8.4, Remarks 6.2.1 and 8.4.1, A.22).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use trench_bag::run::{Run, RunBuilder};
use trench_core::{Advertise, Level, Source, Times};
use trench_harness::{Ending, Lockstep, Observer, load, plan};
use trench_journal::Disk;
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::Assignment;

/// What a run showed.
#[derive(Default)]
struct Watch {
    builder: RunBuilder,
    /// Each assignment, with its time (s).
    assignments: Vec<(f64, Assignment)>,
    /// Times (s) at which a node said something of the team link that is no good news, by node.
    lost: BTreeMap<String, Vec<f64>>,
    complaints: Vec<String>,
}

impl Observer for Watch {
    fn published(&mut self, at: Times, topic: &str, advertise: &Advertise, _: Source, cdr: &[u8]) {
        let seconds = at.steady.0 as f64 * 1e-9;
        self.builder.take(topic, advertise.type_info.name, cdr);
        if topic == "/assignment" {
            self.assignments.push((seconds, Assignment::decode(cdr).unwrap()));
        }
        if topic == "/diagnostics" {
            for status in DiagnosticArray::decode(cdr).unwrap().status {
                if status.message.contains("hears nobody") {
                    self.lost.entry(status.name).or_default().push(seconds);
                }
            }
        }
    }

    fn logged(&mut self, at: Times, node: &str, level: Level, text: &str) {
        if level >= Level::Info {
            self.complaints.push(format!("[{:.3}] {node}: {text}", at.steady.0 as f64 * 1e-9));
        }
    }
}

struct Seen {
    run: Run,
    assignments: Vec<(f64, Assignment)>,
    lost: BTreeMap<String, Vec<f64>>,
    said: String,
}

/// The column with what goes wrong; it must stand in the end, and nobody may have touched anybody.
fn column(faults: &str, arguments: &[(&str, &str)]) -> Seen {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    let faults = if faults.is_empty() { "[]\n".to_owned() } else { format!("\n{faults}") };
    write!(file, "faults: {faults}").unwrap();
    let faults = ("faults", file.path().to_str().unwrap());
    let all = arguments.iter().chain([&faults]).map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("launch/column.launch.yaml");
    let loaded = load(&plan(&path, &all.collect()).unwrap(), &Disk, 1).unwrap();
    let mut watch = Watch::default();
    let ending = Lockstep::new(loaded.instances).unwrap().run(600.0, &mut watch);
    let said = watch.complaints.join("\n");
    let run = watch.builder.finish();
    assert_eq!(ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{said}");
    assert!(run.contacts.is_empty(), "{:?}\n{said}", run.contacts);
    Seen { run, assignments: watch.assignments, lost: watch.lost, said }
}

/// Whom `robot` follows from when on.
fn leaders(seen: &Seen, robot: &str) -> Vec<(f64, String)> {
    let leader = |assignment: &Assignment| {
        assignment.members.iter().find(|member| member.robot == robot).map_or("gone".to_owned(), |m| m.leader.clone())
    };
    let mut all: Vec<(f64, String)> = seen.assignments.iter().map(|(at, made)| (*at, leader(made))).collect();
    all.dedup_by(|later, earlier| later.1 == earlier.1);
    all
}

#[test]
fn who_does_not_hear_its_leader_follows_the_target_until_it_does() {
    let seen = column("- {kind: parted, from: 25.0, to: 33.0, robots: [robot1, robot4]}\n", &[]);
    let followed = leaders(&seen, "robot4");
    let [(_, first), (broken, nobody), (resumed, again)] = &followed[..] else { panic!("{followed:?}\n{}", seen.said) };
    assert_eq!((first.as_str(), nobody.as_str(), again.as_str()), ("robot1", "", "robot1"));
    assert!((26.0..28.5).contains(broken), "{broken}");
    assert!((35.5..37.5).contains(resumed), "after the dwell time: {resumed}");
    assert!(seen.lost.is_empty(), "it still hears others: {:?}", seen.lost);
}

#[test]
fn a_link_that_breaks_again_and_again_changes_the_structure_ever_more_rarely() {
    let faults: String = (0..20)
        .map(|turn| {
            let from = 20.0 + 4.0 * f64::from(turn);
            format!("- {{kind: parted, from: {from:?}, to: {:?}, robots: [robot1, robot4]}}\n", from + 1.5)
        })
        .collect();
    let seen = column(&faults, &[("duration", "120.0"), ("waypoints", "[1.6, 1.4, 3.4, 1.4]")]);
    let changes = leaders(&seen, "robot4").len() - 1;
    assert!((2..10).contains(&changes), "{changes} changes with twenty breaks\n{}", seen.said);
}

#[test]
fn a_robot_out_of_everybody_s_reach_finds_its_team() {
    let poses = "[0.5, 0.5, 0.3, 0.5, 2.2, -0.5, 1.1, 0.7, 1.2, 0.6, 1.0, 0.0]";
    let seen = column("", &[("robot_reach", "0.9"), ("duration", "80.0"), ("poses", poses)]);
    assert_eq!(seen.lost.len(), 1, "{:?}\n{}", seen.lost, seen.said);
    let (node, times) = seen.lost.iter().next().unwrap();
    assert!(node.starts_with("/robot2/"), "{node}");
    assert!(times.last().unwrap() - times[0] > 2.0, "it was on its way for a while: {times:?}");
    assert_eq!(leaders(&seen, "robot2").last().unwrap().1, "robot1", "{}", seen.said);
    assert!(seen.run.robots.contains_key("robot2"));
}

#[test]
fn a_robot_that_dies_is_passed_and_joins_again() {
    let seen = column("- {kind: silent, from: 20.0, to: 45.0, robots: [robot1]}\n", &[("duration", "90.0")]);
    let followed = leaders(&seen, "robot1");
    let told: Vec<&str> = followed.iter().map(|(_, leader)| leader.as_str()).collect();
    assert!(told.contains(&"gone"), "{told:?}\n{}", seen.said);
    assert!(!["gone", ""].contains(told.last().unwrap()), "it is back in the chain: {told:?}\n{}", seen.said);
    let gone = followed.iter().find(|(_, leader)| leader == "gone").unwrap().0;
    assert!((22.0..24.5).contains(&gone), "{gone}");
    let behind = leaders(&seen, "robot4");
    assert!(behind.iter().any(|(_, leader)| leader == "robot3"), "those behind close up: {behind:?}");
}
