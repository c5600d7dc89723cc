//! What the experiments share: starts, lock-step runs, verdicts.

pub(crate) mod conformity;
mod hindrance;
pub(crate) mod pursued;

use conformity::Conformity;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trench_bag::run::{Run, RunBuilder};
use trench_core::{Advertise, Level, Source, Times};
use trench_harness::{Ending, Lockstep, Observer, load, plan};
use trench_journal::Disk;
use trench_msgs::Message;
use trench_msgs::msg::{LinkStatus, Stability};
use trench_sim::Random;
use xxhash_rust::xxh3::xxh3_64_with_seed;

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// How many random starts `TRENCH_SEEDS` asks for, if it does.
pub(crate) fn named_seeds() -> Option<u64> {
    std::env::var("TRENCH_SEEDS").ok().and_then(|text| text.parse().ok())
}

/// Start poses as the launch argument `poses` wants them: x, y, heading of `robots` robots anywhere on the bed, bodies
/// 0.1 m apart from each other and from the edges.
pub(crate) fn random_poses(robots: usize, seed: u64) -> String {
    let mut random = Random::new(seed, 99);
    let mut poses: Vec<[f64; 3]> = Vec::new();
    while poses.len() < robots {
        // The discs must be in view: at pad height 2.40 m x 1.77 m of the bed's 2.48 m x 1.83 m.
        let pose = [random.between(0.2, 2.28), random.between(0.2, 1.63), random.between(-3.1, 3.1)];
        let apart = |other: &[f64; 3]| libm::hypot(pose[0] - other[0], pose[1] - other[1]) > 0.26;
        if poses.iter().all(apart) {
            poses.push(pose);
        }
    }
    let numbers: Vec<String> = poses.iter().flatten().map(|number| format!("{number:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

/// The argument `poses` of the pursuit: eight robots anywhere in the left third of the field, bodies 0.12 m apart.
pub(crate) fn starts(seed: u64) -> String {
    let mut random = Random::new(seed, 96);
    let mut poses: Vec<[f64; 3]> = Vec::new();
    while poses.len() < 8 {
        let pose = [random.between(0.2, 1.3), random.between(0.2, 2.2), random.between(-3.1, 3.1)];
        if poses.iter().all(|other| libm::hypot(pose[0] - other[0], pose[1] - other[1]) > 0.28) {
            poses.push(pose);
        }
    }
    let numbers: Vec<String> = poses.iter().flatten().map(|number| format!("{number:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

/// Arguments of the pursuit whose robots are told of no obstacle, and see them: of those of its field that stand, from a file in `folder`.
pub(crate) fn by_lasers(folder: &Path) -> [(&'static str, String); 3] {
    let whole = std::fs::read_to_string(root().join("config/obstacles/pursuit.yaml")).unwrap();
    // A list item ends where the next one begins.
    let (moving, standing): (Vec<&str>, Vec<&str>) = whole.split("\n- ").partition(|item| item.contains("path:"));
    assert_eq!(moving.len(), 2, "{whole}");
    let file = folder.join("standing.yaml");
    std::fs::write(&file, standing.join("\n- ")).unwrap();
    [
        ("lasers", "[robot1, robot2, robot3, robot4, robot5, robot6, robot7, robot8]".to_owned()),
        ("publish_obstacles", "false".to_owned()),
        ("obstacles", file.display().to_string()),
    ]
}

/// A finished lock-step run.
pub(crate) struct Finished {
    pub(crate) run: Run,
    pub(crate) conformity: Conformity,
    pub(crate) ending: Ending,
    /// Warnings and errors that nodes logged.
    pub(crate) complaints: Vec<String>,
    /// When (s of the steady clock) whose firmware told of motors that missed steps.
    pub(crate) missed_steps: Vec<(f64, String)>,
    /// When (s of the steady clock) which run-time monitor said that something does not hold, and how many words all of them said.
    pub(crate) violations: Vec<(f64, String)>,
    pub(crate) words: usize,
    /// FNV-1a over everything published, in order.
    pub(crate) digest: u64,
}

struct Watch {
    builder: RunBuilder,
    conformity: Conformity,
    complaints: Vec<String>,
    missed_steps: Vec<(f64, String)>,
    violations: Vec<(f64, String)>,
    words: usize,
    digest: u64,
}

impl Observer for Watch {
    fn published(&mut self, at: Times, topic: &str, advertise: &Advertise, _: Source, cdr: &[u8]) {
        self.builder.take(topic, advertise.type_info.name, cdr);
        self.conformity.take(topic, cdr);
        if topic.ends_with("/link") {
            let link = LinkStatus::decode(cdr).unwrap();
            if link.fault & LinkStatus::FAULT_MISSED_STEPS != 0 {
                self.missed_steps.push((at.steady.0 as f64 * 1e-9, link.robot));
            }
        }
        if topic.ends_with("/stability") {
            let word = Stability::decode(cdr).unwrap();
            self.words += 1;
            if !word.holds {
                self.violations.push((at.steady.0 as f64 * 1e-9, word.violation));
            }
        }
        self.digest = xxh3_64_with_seed(cdr, xxh3_64_with_seed(topic.as_bytes(), self.digest));
    }

    fn logged(&mut self, at: Times, node: &str, level: Level, text: &str) {
        if level >= Level::Warn {
            self.complaints.push(format!("[{:.3}] {node}: {text}", at.steady.0 as f64 * 1e-9));
        }
    }
}

/// Drives one of the launch files of this repository in lock-step to its end.
pub(crate) fn drive(file: &str, arguments: &[(&str, &str)]) -> Finished {
    drive_file(&root().join("launch").join(file), arguments)
}

/// Drives a launch file in lock-step to its end.
pub(crate) fn drive_file(path: &Path, arguments: &[(&str, &str)]) -> Finished {
    let mut watch = Watch {
        builder: RunBuilder::default(),
        conformity: Conformity::default(),
        complaints: Vec::new(),
        missed_steps: Vec::new(),
        violations: Vec::new(),
        words: 0,
        digest: 0,
    };
    let ending = watched(path, arguments, &mut watch);
    let Watch { builder, conformity, complaints, missed_steps, violations, words, digest } = watch;
    Finished { run: builder.finish(), conformity, ending, complaints, missed_steps, violations, words, digest }
}

/// Drives a launch file in lock-step to its end, for someone who looks at all that is published.
pub(crate) fn watched(path: &Path, arguments: &[(&str, &str)], observer: &mut dyn Observer) -> Ending {
    let arguments: BTreeMap<String, String> =
        arguments.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let loaded = load(&plan(path, &arguments).unwrap(), &Disk, 1).unwrap();
    Lockstep::new(loaded.instances).unwrap().run(600.0, observer)
}
