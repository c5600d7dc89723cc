//! `trench stop` at a terminal: what keys do, and that it is heard.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helper functions too")]

#[path = "support/own_memory.rs"]
mod own_memory;
#[path = "support/programs.rs"]
mod programs;
#[path = "support/running.rs"]
mod running;

use own_memory::OwnMemory;
use running::Running;
use rustix::process::{Pid, Signal, kill_process};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{ChildStdin, Command, Stdio};
use std::time::{Duration, Instant};
use trench_bag::BagReader;
use trench_msgs::Message;
use trench_msgs::std_msgs::Bool;

const PATIENCE: Duration = Duration::from_secs(30);

/// `trench stop --wait` in a terminal of its own (script(1) makes it), and what it says.
struct Terminal {
    script: Running,
    keys: ChildStdin,
    said: std::sync::mpsc::Receiver<String>,
}

impl Terminal {
    fn open(command: &mut Command) -> Self {
        let trench = programs::trench();
        command.args(["-qec", &format!("{} stop --wait", trench.display()), "/dev/null"]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut script = Running::start(command);
        let (keys, output) = (script.0.stdin.take().unwrap(), script.0.stdout.take().unwrap());
        let (say, said) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            BufReader::new(output).lines().map_while(Result::ok).try_for_each(|line| say.send(line))
        });
        Self { script, keys, said }
    }

    fn wait_for(&self, text: &str) {
        let mut all = String::new();
        while !all.contains(text) {
            let line = self.said.recv_timeout(PATIENCE);
            assert!(line.is_ok(), "{text:?} not in:\n{all}");
            all += &line.unwrap();
        }
    }

    fn press(&mut self, key: &[u8]) {
        self.keys.write_all(key).unwrap();
        self.keys.flush().unwrap();
    }
}

/// What was said on /emergency_stop, in order, equal words once.
fn words(bag: &Path) -> Vec<bool> {
    let bag = BagReader::open(bag).unwrap();
    let topic = bag.topics().iter().position(|topic| topic.name == "/emergency_stop").unwrap();
    let messages = bag.messages().map(Result::unwrap).filter(|message| message.topic == topic);
    let mut words: Vec<bool> = messages.map(|message| Bool::decode(&message).unwrap().data).collect();
    words.dedup();
    words
}

#[test]
fn live_the_first_key_stops_and_q_ends_it() {
    let folder = tempfile::tempdir().unwrap();
    let number = std::process::id();
    let memory = OwnMemory(format!("stop{number}_"));
    let domain = (41 + number % 20).to_string();
    let environment = [("ROS_DOMAIN_ID", domain.as_str()), ("TRENCH_SHM_PREFIX", &memory.0)];
    let bag = folder.path().join("bag");
    let mut recorder = Running::start(
        Command::new(programs::trench().with_file_name("bag_recorder"))
            .args(["--ros-args", "-p", "topics:=[\"/emergency_stop:std_msgs/msg/Bool\"]", "-p"])
            .arg(format!("output:={}", bag.display()))
            .envs(environment)
            .stderr(Stdio::piped()),
    );
    let mut terminal = Terminal::open(Command::new("script").envs(environment));
    terminal.wait_for("any key stops");
    // Until the recorder knows it, nobody hears it.
    std::thread::sleep(Duration::from_secs(2));
    terminal.press(b"x");
    terminal.wait_for("[emergency_stop]: stop");
    std::thread::sleep(Duration::from_secs(1));
    terminal.press(b"q");
    let start = Instant::now();
    let ended = loop {
        if let Some(status) = terminal.script.0.try_wait().unwrap() {
            break status;
        }
        assert!(start.elapsed() < PATIENCE, "q does not end it");
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(ended.code(), Some(0));
    kill_process(Pid::from_child(&recorder.0), Signal::INT).unwrap();
    let mut said = String::new();
    recorder.0.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    recorder.0.wait().unwrap();
    assert_eq!(words(&bag), [false, true], "{said}");
}
