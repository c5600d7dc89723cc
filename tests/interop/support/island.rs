//! What keeps the processes of one test apart from all others, and the virtual environment of the rclpy ones.

use super::own_memory::OwnMemory;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// A domain, shared memory, a state folder and a serial port of one test's own.
pub(crate) struct Island {
    folder: TempDir,
    venv: PathBuf,
    domain: u32,
    memory: OwnMemory,
}

impl Island {
    /// `number` (0 to 3) differs between the tests of this file.
    pub(crate) fn new(number: u32) -> Self {
        // 1 to 39: other tests of the workspace use domains above.
        let domain = 1 + (std::process::id() % 9) * 4 + number;
        let memory = OwnMemory(format!("interop{}n{number}", std::process::id()));
        Self { folder: tempfile::tempdir().unwrap(), venv: venv(), domain, memory }
    }

    /// A folder that goes with the test.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// A command that lives on this island.
    pub(crate) fn command(&self, program: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(program);
        command
            .env("ROS_DOMAIN_ID", self.domain.to_string())
            .env("TRENCH_SHM_PREFIX", &self.memory.0)
            .env("TRENCH_STATE_DIR", self.folder().join("state"));
        command
    }

    /// The variables that `scripts/ros-venv --env` prints.
    pub(crate) fn in_venv(&self, mut command: Command) -> Command {
        let path = std::env::var("PATH").unwrap_or_default();
        command
            .env("PATH", format!("{}:{path}", self.venv.join("bin").display()))
            .env("LD_LIBRARY_PATH", self.venv.join("lib"))
            .env("AMENT_PREFIX_PATH", &self.venv)
            .env("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp")
            // Our processes speak UDP; Fast DDS's own shared memory would only leave files behind.
            .env("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4");
        command
    }

    /// A program of tests/interop.
    pub(crate) fn python(&self, program: &str) -> Command {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/interop").join(program);
        let mut command = self.in_venv(self.command(self.venv.join("bin/python3")));
        command.arg(script);
        command
    }
}

/// The virtual environment of `scripts/ros-venv`.
fn venv() -> PathBuf {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv");
    let venv = std::env::var_os("TRENCH_VENV").map_or(default, PathBuf::from);
    let built = venv.join(".messages").exists() && venv.join("bin/python3").exists();
    assert!(built, "{} is no virtual environment with rclpy and trench_msgs: run scripts/ros-venv", venv.display());
    venv
}
