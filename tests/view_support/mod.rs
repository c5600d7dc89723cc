//! The pages that `trench` serves, and browsers that look at them.

mod browser;

pub(crate) use browser::Browser;
use rustix::process::{Pid, getpriority_process};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// How long anything may take on a busy machine.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// A running server of a page. It ends with this.
pub(crate) struct Viewer {
    process: Child,
    /// Host and port.
    pub(crate) host: String,
}

impl Viewer {
    /// Starts `trench view` with these arguments on a free port.
    pub(crate) fn start(arguments: &[&str], variables: &[(&str, &str)]) -> Self {
        Self::serve(&["view"], arguments, variables)
    }

    /// Starts this subcommand of `trench` with these arguments on a free port.
    pub(crate) fn serve(subcommand: &[&str], arguments: &[&str], variables: &[(&str, &str)]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trench"));
        command.args(subcommand).args(["--port", "0"]).args(arguments).envs(variables.iter().copied());
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let host = line.trim().strip_prefix("http://").and_then(|rest| rest.strip_suffix('/'));
        let host = host.unwrap_or_else(|| panic!("no address: {line:?}")).to_owned();
        Self { process, host }
    }

    /// The address of its page.
    pub(crate) fn page(&self) -> String {
        format!("http://{}/", self.host)
    }

    /// How far it lets others go first: those who watch 4, the control loop 0 and 1.
    pub(crate) fn niceness(&self) -> i32 {
        getpriority_process(Some(Pid::from_child(&self.process))).unwrap()
    }

    /// Sends these bytes as a request and gives the answer's first line and all of it.
    pub(crate) fn send(&self, request: &str) -> (String, String) {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        // A connection that is upgraded stays open: what came until then is the answer.
        let _open = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        (answer.lines().next().unwrap_or_default().to_owned(), answer)
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _has_ended = self.process.kill();
        let _has_ended = self.process.wait();
    }
}

/// Records a launch file in lock-step into a bag.
pub(crate) fn record(file: &str, arguments: &[&str], bag: &Path) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_trench"));
    command.arg("sim").arg(root.join("launch").join(file)).args(arguments).arg("--quiet").arg("--bag").arg(bag);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
