//! The recorder as a process: killed, on a full disk, and beside a bag of others that is played into the stack.
#![expect(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail as tests do")]

#[path = "record/full_disk.rs"]
mod full_disk;
#[path = "record/killed.rs"]
mod killed;
#[path = "support/running.rs"]
mod running;
#[path = "record/stack.rs"]
mod stack;

use running::Running;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trench_bag::{BagWriter, Stamp, WriteOptions};
use trench_core::Qos;
use trench_msgs::{Encode, Message, std_msgs};
use trench_sim::Random;

/// A folder, and processes that see each other and nobody else.
struct Island {
    folder: tempfile::TempDir,
    domain: u32,
}

impl Island {
    /// Each test has its own number.
    fn new(number: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        Self { folder, domain: 50 + (std::process::id() % 10) * 4 + number }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A program beside `trench`, started on this island.
    fn command(&self, program: impl AsRef<Path>) -> Command {
        let trench = Path::new(env!("CARGO_BIN_EXE_trench"));
        let mut command = Command::new(trench.with_file_name(program.as_ref()));
        command.stdin(Stdio::null());
        command.env("ROS_DOMAIN_ID", self.domain.to_string()).env("TRENCH_SHM_PREFIX", self.prefix());
        command.env("TRENCH_STATE_DIR", self.path("state"));
        command
    }

    /// `trench bag ...`, started on this island.
    fn bag(&self, arguments: &[&str]) -> Command {
        let mut command = self.command("trench");
        command.arg("bag").args(arguments);
        command
    }

    fn prefix(&self) -> String {
        format!("record{}_{}_", self.domain, std::process::id())
    }
}

impl Drop for Island {
    fn drop(&mut self) {
        // What killed processes left. Nobody is told where that fails: the prefix is never used again.
        let _leftover = trench_runtime::forget_shared_memory(&self.prefix());
    }
}

impl Running {
    fn interrupt(mut self) -> bool {
        let process = rustix::process::Pid::from_child(&self.0);
        rustix::process::kill_process(process, rustix::process::Signal::INT).unwrap();
        self.0.wait().unwrap().success()
    }
}

/// Waits until something holds; fails after half a minute.
fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
    let deadline = Instant::now() + Duration::from_secs(30);
    while !holds() {
        assert!(Instant::now() < deadline, "waited for 30 s: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Writes a bag with ten seconds of a hundred texts of `length` characters a second on /text.
fn write_texts(path: &Path, length: usize) {
    let mut writer = BagWriter::create(path, WriteOptions::default()).unwrap();
    let topic = writer.add_topic("/text", std_msgs::String::TYPE.into(), Qos::RELIABLE).unwrap();
    let mut random = Random::new(7, 1);
    for index in 0..1000_u64 {
        let letter = |_| char::from(random.between(32.0, 127.0) as u8);
        let data: String = (0..length).map(letter).collect();
        let log_time = 1_700_000_000_000_000_000 + index * 10_000_000;
        let stamp = Stamp { log_time, publish_time: log_time, sequence: index as u32 };
        writer.write(topic, stamp, &std_msgs::String { data }.to_cdr()).unwrap();
    }
    writer.finish().unwrap();
}

/// The size of the first file of a bag, 0 before it is there.
fn recorded(bag: &Path) -> u64 {
    let name = format!("{}_0.mcap", bag.file_name().unwrap().to_string_lossy());
    bag.join(name).metadata().map_or(0, |file| file.len())
}
