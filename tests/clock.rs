//! A process that follows /clock (use_sim_time): a controller in the system of a bag that is played.
#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "support/own_memory.rs"]
mod own_memory;
#[path = "support/programs.rs"]
mod programs;
#[path = "support/running.rs"]
mod running;

use own_memory::OwnMemory;
use running::Running;
use rustix::process::{Pid, Signal, kill_process};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};
use trench_bag::BagReader;
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::rosgraph_msgs::Clock;

/// What a controller of the square hears, but for obstacles' details.
const HEARD: [&str; 10] = [
    "/team_state",
    "/goals",
    "/formation",
    "/assignment",
    "/run_state",
    "/apparent_obstacles",
    "/robot1/link",
    "/robot2/leader_state",
    "/robot3/leader_state",
    "/robot4/leader_state",
];

/// No robot moves on information older than this, s; and what a busy machine may add until it is recorded.
const OLDEST: f64 = 0.25;
const BUSY: f64 = 0.25;

/// Seconds of the bag to which the first playing comes before it rests: robots drive from the second or third on.
const RESTS: f64 = 6.0;

struct Bench {
    folder: tempfile::TempDir,
    domain: String,
    memory: OwnMemory,
}

impl Bench {
    fn command(&self, program: &Path) -> Command {
        let mut command = Command::new(program);
        command.env("ROS_DOMAIN_ID", &self.domain).env("TRENCH_SHM_PREFIX", &self.memory.0);
        command.env("TRENCH_STATE_DIR", self.folder.path().join("state"));
        command.current_dir(env!("CARGO_MANIFEST_DIR")).stdin(Stdio::null());
        command
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    /// Plays the recorded square, after a moment in which readers find the player.
    fn play(&self) -> Running {
        let mut command = self.command(&programs::trench());
        command.args(["bag", "play", &self.path("square"), "--clock", "100", "--delay", "3", "--topics"]).args(HEARD);
        Running::start(&mut command)
    }
}

/// Command and recording time (s since the first): stamp, and whether the robot is to move.
struct Commanded {
    recorded: f64,
    stamp: RosTime,
    moves: bool,
}

fn seconds(nanoseconds: u64) -> f64 {
    nanoseconds as f64 * 1e-9
}

/// Recording times (s) of what a topic said, with what it said.
fn heard<M: Message>(bag: &BagReader, topic: &str) -> Vec<(f64, M)> {
    let index = bag.topic(topic);
    assert!(index.is_some(), "nobody wrote {topic}");
    let index = index.unwrap();
    let all = bag.messages().map(Result::unwrap).filter(|message| message.topic == index);
    all.map(|message| (seconds(message.log_time), M::decode(&message).unwrap())).collect()
}

fn signal(process: &Running, signal: Signal) {
    kill_process(Pid::from_child(&process.0), signal).unwrap();
}

#[test]
fn live_a_controller_goes_by_a_clock_that_is_published_rests_with_it_and_goes_back_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let domain = (40 + std::process::id() % 30).to_string();
    let bench = Bench { folder, domain, memory: OwnMemory(format!("clock{}_", std::process::id())) };
    let trench = programs::trench();
    let square = bench.path("square");
    let simulated = bench
        .command(&trench)
        .args(["sim", "launch/square.launch.yaml", "duration:=12.0", "tolerance:=5.0", "--quiet", "--bag", &square])
        .status()
        .unwrap();
    assert!(simulated.success());

    let said = std::fs::File::create(bench.path("said")).unwrap();
    let mut controller = bench.command(&trench.with_file_name("formation_controller"));
    controller.args(["--ros-args", "-r", "__ns:=/robot1", "-p", "use_sim_time:=true"]);
    controller.args(["-p", "team:=[robot1, robot2, robot3, robot4]"]);
    for file in ["robots/mrkit", "worlds/bed", "profiles/tuned"] {
        controller.args(["--params-file", &format!("config/{file}.yaml")]);
    }
    let controller = Running::start(controller.stderr(said));
    let copy = bench.path("copy");
    let topics = ["/robot1/cmd_vel", "/clock", "/diagnostics"];
    let mut recorder = bench.command(&trench);
    let recorder = Running::start(recorder.args(["bag", "record", &copy, "--topics"]).args(topics));

    // Three seconds until it begins, and those of the bag.
    let wait = |seconds: f64| std::thread::sleep(Duration::from_secs_f64(seconds));
    let first = bench.play();
    wait(3.0 + RESTS + 1.0);
    signal(&first, Signal::STOP);
    wait(2.0);
    // What comes from here on was published with a clock that goes on.
    let goes_on = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs_f64();
    signal(&first, Signal::CONT);
    signal(&first, Signal::INT);
    wait(1.0);
    drop(first);
    let second = bench.play();
    wait(3.0 + RESTS + 1.0);
    signal(&second, Signal::INT);
    drop(second);
    signal(&controller, Signal::INT);
    signal(&recorder, Signal::INT);
    for mut process in [controller, recorder] {
        let deadline = Instant::now() + Duration::from_secs(20);
        while process.0.try_wait().unwrap().is_none() {
            assert!(Instant::now() < deadline, "a process does not end");
            wait(0.05);
        }
    }

    let said = std::fs::read_to_string(bench.path("said")).unwrap();
    let bag = BagReader::open(Path::new(&copy)).unwrap();
    let clock: Vec<(f64, i64)> = heard::<Clock>(&bag, "/clock")
        .into_iter()
        .map(|(recorded, message)| (recorded, RosTime::from(&message.clock).0))
        .collect();
    // Where it rests, and where it goes back.
    let rest = clock.windows(2).find(|pair| pair[1].0 - pair[0].0 > 1.5).expect("the clock rests");
    let rests = rest[0].0;
    assert!(goes_on - rests > 1.5, "for {} s", goes_on - rests);
    let back = clock.windows(2).find(|pair| pair[1].1 < pair[0].1).expect("the clock goes back");
    let (went_back, (began, latest)) = (back[1].0, (clock[0].1, back[0].1));
    assert!(back[0].1 - back[1].1 > 3_000_000_000, "by seconds");

    let commands: Vec<Commanded> = heard::<TwistStamped>(&bag, "/robot1/cmd_vel")
        .into_iter()
        .map(|(recorded, command)| Commanded {
            recorded,
            stamp: RosTime::from(&command.header.stamp),
            moves: command.twist.linear.x != 0.0 || command.twist.angular.z != 0.0,
        })
        .collect();
    let moving = |from: f64, to: f64| -> Vec<&Commanded> {
        commands.iter().filter(|command| command.moves && (from..to).contains(&command.recorded)).collect()
    };
    // It drives, and by the bag's time: exposures are at most 0.25 s before what the clock said then.
    let driven = moving(0.0, rests);
    assert!(driven.len() > 30, "{} commands\n{said}", driven.len());
    let told = |recorded: f64| clock[clock.partition_point(|(at, _)| *at <= recorded).saturating_sub(1)].1;
    for command in &driven {
        let age = 1e-9 * (told(command.recorded) - command.stamp.0) as f64;
        assert!((-BUSY..OLDEST + BUSY).contains(&age), "a command {age} s old by the clock\n{said}");
        assert!((began - 1_000_000_000..=latest).contains(&command.stamp.0), "a stamp of another clock");
    }
    // While /clock rests, nothing gets older by it: the monotonic clock has the robot stop.
    let still = moving(rests + OLDEST + BUSY, goes_on);
    assert!(still.is_empty(), "{} commands move the robot while the clock rests\n{said}", still.len());
    assert!(commands.iter().any(|command| (rests..goes_on).contains(&command.recorded)), "and says so");
    // Once the clock has gone back, all begins anew.
    let again = moving(went_back, f64::INFINITY);
    assert!(again.len() > 30, "{} commands after the clock went back\n{said}", again.len());
    assert!(again[0].stamp.0 < driven.last().unwrap().stamp.0, "by the clock as it is now");
    // What the node says of itself is of that clock too.
    let said: Vec<i64> = heard::<DiagnosticArray>(&bag, "/diagnostics")
        .into_iter()
        .filter(|(recorded, _)| (clock[0].0 + BUSY..rests).contains(recorded))
        .map(|(_, array)| RosTime::from(&array.header.stamp).0)
        .collect();
    assert!(!said.is_empty() && said.iter().all(|stamp| (began..=latest).contains(stamp)), "{said:?}");
}
