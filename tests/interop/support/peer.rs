//! Programs in rclpy that ask our processes, listen to them and speak to them.

use super::{Island, PATIENCE};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

impl Island {
    /// Runs a program to its end and gives the document it prints. Arguments are split at blanks.
    pub(crate) fn ask(&self, program: &str, arguments: &str) -> Value {
        let patience = PATIENCE.as_secs().to_string();
        let mut command = self.python(program);
        let output = command.args(arguments.split_whitespace()).args(["--timeout", &patience]).output().unwrap();
        let problem = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{program} {arguments}: {problem}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// What a latched topic, given with its type, says to one that comes late. RustDDS clears a writer's history every few seconds:
    /// until then older messages come before the last.
    pub(crate) fn latched(&self, topic: &str) -> Value {
        let answer = self.ask("peer_echo.py", &format!("{topic} --qos reliable,transient_local,1 --settle 0.5"));
        answer["messages"][0].clone()
    }

    /// Listens to a topic, given with its type and, where it matters, `--qos`.
    pub(crate) fn follow(&self, topic: &str) -> Follower {
        Follower(Peer::start(self, "peer_echo.py", &format!("{topic} --follow")))
    }

    /// Waits for nodes, given as options. It is on the network when this returns.
    pub(crate) fn lookout(&self, nodes: &str) -> Lookout {
        let peer = Peer::start(self, "peer_nodes.py", &format!("--announce {nodes}"));
        assert_eq!(peer.line()["waits"], true);
        Lookout(peer)
    }

    /// Will publish on a topic, given with its type and how. Waits for a subscriber.
    pub(crate) fn publisher(&self, topic: &str) -> Publisher {
        Publisher(Peer::start(self, "peer_publish.py", topic))
    }
}

/// A subscriber in rclpy.
pub(crate) struct Follower(Peer);

impl Follower {
    /// The first message for which `condition` holds, of those that come.
    pub(crate) fn until(&self, what: &str, mut condition: impl FnMut(&Value) -> bool) -> Value {
        let start = Instant::now();
        let mut last = Value::Null;
        while start.elapsed() < PATIENCE {
            let message = self.0.line();
            if condition(&message) {
                return message;
            }
            last = message;
        }
        panic!("{what} did not come true; the last message: {last}");
    }

    /// The next message.
    pub(crate) fn next(&self) -> Value {
        self.0.line()
    }

    /// All messages of the next so many seconds, after those that wait already.
    pub(crate) fn during(&self, seconds: f64) -> Vec<Value> {
        while self.0.lines.try_recv().is_ok() {}
        let end = Instant::now() + Duration::from_secs_f64(seconds);
        let mut messages = Vec::new();
        loop {
            match self.0.lines.recv_timeout(end.saturating_duration_since(Instant::now())) {
                Ok(message) => messages.push(message),
                Err(RecvTimeoutError::Timeout) => return messages,
                Err(RecvTimeoutError::Disconnected) => panic!("{} has ended", self.0.name),
            }
        }
    }
}

/// A publisher in rclpy, alive until it is dropped.
pub(crate) struct Publisher(Peer);

impl Publisher {
    /// Publishes a message given in JSON and gives the ROS time, in seconds, just before.
    pub(crate) fn say(&mut self, message: &str) -> f64 {
        let input = self.0.input.as_mut().unwrap();
        writeln!(input, "{message}").unwrap();
        self.0.line()["published"].as_f64().unwrap() * 1e-9
    }
}

/// One in rclpy that waits for nodes.
pub(crate) struct Lookout(Peer);

impl Lookout {
    /// What each node has, when all are there.
    pub(crate) fn found(&self) -> Value {
        self.0.line()
    }
}

/// A running program with the documents it prints, one a line.
struct Peer {
    name: String,
    child: Child,
    input: Option<ChildStdin>,
    lines: Receiver<Value>,
}

impl Peer {
    fn start(island: &Island, program: &str, arguments: &str) -> Self {
        let mut child = island
            .python(program)
            .args(arguments.split_whitespace())
            .args(["--timeout", &PATIENCE.as_secs().to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let output = BufReader::new(child.stdout.take().unwrap());
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            for line in output.lines().map_while(Result::ok) {
                if sender.send(serde_json::from_str(&line).unwrap()).is_err() {
                    return;
                }
            }
        });
        Self { name: format!("{program} {arguments}"), input: child.stdin.take(), child, lines }
    }

    fn line(&self) -> Value {
        self.lines.recv_timeout(PATIENCE).unwrap_or_else(|problem| panic!("{}: {problem}", self.name))
    }
}

impl Drop for Peer {
    /// The end of its input lets a publisher leave the network in order; a subscriber needs no farewell.
    fn drop(&mut self) {
        let publishes = self.input.take().is_some() && self.name.starts_with("peer_publish");
        let start = Instant::now();
        while publishes && start.elapsed() < PATIENCE && matches!(self.child.try_wait(), Ok(None)) {
            std::thread::sleep(Duration::from_millis(10));
        }
        let _has_ended = self.child.kill();
        let _has_ended = self.child.wait();
    }
}
