//! Launches in real time, judged from the bags that they record.

#[path = "../support/own_memory.rs"]
mod own_memory;
#[path = "../support/programs.rs"]
pub(crate) mod programs;

use own_memory::OwnMemory;
use std::path::PathBuf;
use std::process::{Command, ExitStatus};
use trench_bag::BagReader;
use trench_bag::run::{Run, RunSummary, SummaryOptions, summary};

/// A launch with a domain, shared memory, a state folder and a serial port of its own.
pub(crate) struct Launch {
    pub(crate) folder: tempfile::TempDir,
    pub(crate) domain: u32,
    /// Variables of the processes.
    pub(crate) variables: Vec<(&'static str, String)>,
    /// Where the folders `launch` and `config` are.
    pub(crate) root: PathBuf,
}

impl Launch {
    pub(crate) fn new(domain: u32) -> Self {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        Self { folder: tempfile::tempdir().unwrap(), domain, variables: Vec::new(), root }
    }

    fn bag(&self) -> PathBuf {
        self.folder.path().join("bag")
    }

    /// The bag that a run left.
    pub(crate) fn recorded(&self) -> BagReader {
        let bag = BagReader::open(&self.bag()).unwrap();
        assert_eq!(bag.damage().len(), 0, "{:?}", bag.damage());
        bag
    }

    /// The launch of a file that records a bag.
    pub(crate) fn recording(&self, file: &str, arguments: &[&str]) -> Command {
        let mut command = self.command(file, "");
        command.arg("record:=true").arg(format!("bag:={}", self.bag().display()));
        command.arg(format!("port:={}", self.folder.path().join("port").display())).args(arguments);
        command
    }

    /// The launch of a file, with run folder, state and shared memory of its own; with a `host`, those of that host.
    pub(crate) fn command(&self, file: &str, host: &str) -> Command {
        let own = |name: &str| self.folder.path().join(format!("{name}{host}"));
        let mut command = Command::new(programs::trench());
        command.arg("launch").arg(self.root.join("launch").join(file)).arg("--run-dir").arg(own("run"));
        command.env("ROS_DOMAIN_ID", self.domain.to_string());
        command.env("TRENCH_SHM_PREFIX", self.shared_memory(host)).env("TRENCH_STATE_DIR", own("state"));
        command.envs(self.variables.iter().map(|(name, value)| (name, value)));
        command
    }

    /// Waits for a launch to end; gives what it said.
    pub(crate) fn finish(&self, mut command: Command) -> (ExitStatus, String) {
        let output = command.output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        self.left_nothing_behind();
        (output.status, worst_first(&text))
    }

    /// What a launch has used is free again once it has ended: the serial port's link and shared memory, but for the few
    /// bytes in which iceoryx2 counts the nodes of a prefix.
    pub(crate) fn left_nothing_behind(&self) {
        let port = self.folder.path().join("port");
        assert!(port.symlink_metadata().is_err(), "{} is still there", port.display());
        let names =
            std::fs::read_dir("/dev/shm").unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let ours = format!("_{}_", self.shared_memory(""));
        let is_left =
            |name: &String| name.contains(&ours) && !name.ends_with(".global_mgmt") && !name.ends_with("_dir");
        let ours = names.filter(is_left);
        assert_eq!(ours.collect::<Vec<_>>(), Vec::<String>::new(), "shared memory is left");
    }

    pub(crate) fn judge(&self, shape_times: &[f64]) -> RunSummary {
        let bag = self.recorded();
        let run = Run::from_bag(&bag).unwrap();
        let options = SummaryOptions { shape_times: shape_times.to_vec(), ..SummaryOptions::default() };
        let summary = summary(&run, &options);
        assert!(summary.ground_truth && summary.undecodable == 0);
        println!("{summary}");
        summary
    }

    /// The prefix of its shared memory on a host.
    fn shared_memory(&self, host: &str) -> String {
        format!("l{}x{}{host}", self.domain, std::process::id())
    }

    /// Removes what is left of the shared memory on a host whose processes have ended.
    pub(crate) fn forget(&self, host: &str) {
        drop(OwnMemory(self.shared_memory(host)));
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        self.forget("");
    }
}

/// What was said, errors before warnings before the rest: of a failed test often the first lines alone are shown.
fn worst_first(text: &str) -> String {
    let rank = |line: &&str| {
        if ["ERROR", "panicked"].iter().any(|word| line.contains(word)) {
            0
        } else {
            2 - u8::from(line.contains("WARN"))
        }
    };
    let mut lines: Vec<&str> = text.lines().collect();
    lines.sort_by_key(rank);
    lines.join("\n")
}

/// A domain no other test of this run uses at the same time: real-time tests run alone. Domains above 101 would have
/// their ports among those that the kernel gives to anyone (/proc/sys/net/ipv4/ip_local_port_range).
pub(crate) fn domain(offset: u32) -> u32 {
    71 + (std::process::id() % 7) * 4 + offset
}
