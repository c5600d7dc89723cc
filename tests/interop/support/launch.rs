//! The stack under `trench launch`.

use super::{Island, PATIENCE, programs};
use rustix::process::{Pid, Signal, kill_process};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A running `trench launch`. Its processes end with it, however it ends.
pub(crate) struct Launch {
    launcher: Child,
    output: PathBuf,
}

impl Launch {
    /// Launches a file, given from the root of the repository.
    pub(crate) fn start(island: &Island, file: &str, arguments: &[&str]) -> Self {
        let output = island.folder().join("output");
        let file_of_output = File::create(&output).unwrap();
        let launcher = island
            .command(programs::trench())
            .arg("launch")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join(file))
            .arg(format!("port:={}", island.folder().join("port").display()))
            .args(arguments)
            .arg("--run-dir")
            .arg(island.folder().join("run"))
            .stdin(Stdio::null())
            .stdout(file_of_output.try_clone().unwrap())
            .stderr(file_of_output)
            .spawn()
            .unwrap();
        Self { launcher, output }
    }

    /// What it and its processes said so far.
    pub(crate) fn said(&self) -> String {
        std::fs::read_to_string(&self.output).unwrap()
    }

    /// Interrupts it as Ctrl-C does; gives its exit code and all that was said.
    pub(crate) fn interrupt(mut self) -> (Option<i32>, String) {
        let code = self.end();
        (code, self.said())
    }

    fn end(&mut self) -> Option<i32> {
        let start = Instant::now();
        let _has_ended = kill_process(Pid::from_child(&self.launcher), Signal::INT);
        while start.elapsed() < PATIENCE {
            if let Some(status) = self.launcher.try_wait().unwrap() {
                return status.code();
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        None
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        if std::thread::panicking() {
            println!("what the launched processes said:\n{}", self.said());
        }
        self.end();
        let _has_ended = self.launcher.kill();
        let _has_ended = self.launcher.wait();
    }
}
