//! Real processes for the tests: the talker and the listener of the examples.

use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Long enough for discovery on a loaded machine; tests end sooner.
pub(crate) const PATIENCE: Duration = Duration::from_secs(40);

/// Keeps the processes of one test apart from all others.
pub(crate) struct Island {
    domain: u16,
    name: String,
    /// A Zenoh router and where it listens, if the processes speak Zenoh.
    pub(crate) router: Option<(Running, String)>,
}

/// A node's process with its lines of output.
pub(crate) struct Running {
    pub(crate) child: Child,
    lines: Receiver<String>,
    errors: Receiver<String>,
}

impl Island {
    /// `number`, below 50, must differ between the tests of this package.
    pub(crate) fn new(number: u16) -> Self {
        // A second run at the same time on this host has domains of its own, most likely. Above 101 the ports of a domain
        // are among those that the kernel gives to anyone (/proc/sys/net/ipv4/ip_local_port_range).
        let domain = 1 + number + (std::process::id() % 2) as u16 * 50;
        Self { domain, name: format!("test{}n{number}", std::process::id()), router: None }
    }

    /// A command of an example with these arguments.
    pub(crate) fn command(&self, example: &str, arguments: &str) -> Command {
        let deps = std::env::current_exe().unwrap();
        let program: PathBuf = deps.parent().unwrap().parent().unwrap().join("examples").join(example);
        let mut command = Command::new(program);
        command.args(arguments.split_whitespace());
        command.env("ROS_DOMAIN_ID", self.domain.to_string()).env("TRENCH_SHM_PREFIX", &self.name);
        command.env("TRENCH_STATE_DIR", std::env::temp_dir().join(&self.name));
        match &self.router {
            Some((_, locator)) => command
                .env("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
                .env("ZENOH_CONFIG_OVERRIDE", format!("connect/endpoints=[\"{locator}\"]")),
            None => command.env("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp").env_remove("ZENOH_CONFIG_OVERRIDE"),
        };
        command.env_remove("ZENOH_SESSION_CONFIG_URI").env_remove("ZENOH_ROUTER_CONFIG_URI");
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Starts an example.
    pub(crate) fn start(&self, example: &str, arguments: &str) -> Running {
        Self::run(self.command(example, arguments))
    }

    /// Starts a command made by [`Island::command`].
    pub(crate) fn run(mut command: Command) -> Running {
        let mut child = command.spawn().unwrap();
        let lines = follow(child.stdout.take().unwrap());
        let errors = follow(child.stderr.take().unwrap());
        Running { child, lines, errors }
    }
}

impl Island {
    /// Takes away all files of shared memory, whoever uses them.
    pub(crate) fn remove_shared_memory(&self) {
        for prefix in [self.name.clone(), format!("{}_apart", self.name)] {
            trench_runtime::forget_shared_memory(&prefix).unwrap();
        }
    }
}

impl Drop for Island {
    /// A process that was killed leaves its shared memory to the next one of its island, and there is none.
    fn drop(&mut self) {
        self.remove_shared_memory();
    }
}

impl Running {
    /// The next line of output.
    pub(crate) fn line(&self) -> String {
        self.lines.recv_timeout(PATIENCE).expect("a line of output in time")
    }

    /// Waits until the log says `text`.
    pub(crate) fn wait_for_log(&self, text: &str) {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            match self.errors.recv_timeout(PATIENCE) {
                Ok(line) if line.contains(text) => return,
                Ok(_) => {}
                Err(error) => panic!("waiting for `{text}`: {error}"),
            }
        }
        panic!("`{text}` was never logged");
    }

    /// Sends a signal.
    pub(crate) fn signal(&self, name: &str) {
        let status = Command::new("kill").args(["-s", name, &self.child.id().to_string()]).status().unwrap();
        assert!(status.success());
    }

    /// Waits for the end and gives the exit code (128 + the signal that killed it) and all further output.
    pub(crate) fn end(mut self) -> (i32, Vec<String>, Vec<String>) {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                let code = status.code().unwrap_or_else(|| 128 + status.signal().unwrap_or(0));
                return (code, self.lines.iter().collect(), self.errors.iter().collect());
            }
            assert!(start.elapsed() < PATIENCE, "the process does not end");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Fails where the process has ended, as it should have.
        let _ended = self.child.kill();
        let _ended = self.child.wait();
    }
}

fn follow(output: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}
