//! Running a plan: start, watch, start again, forward output, end all in ROS's order.
//!
//! One loop owns all processes and reaps them itself; threads only wait for a signal, for a process to end (without
//! reaping it) or for a line of output. So a process id that the loop signals is always still that of its own child.

mod child;
mod ends;
mod member;
mod outcome;
mod output;
mod reporter;

pub use outcome::Outcome;
pub use reporter::Reporter;

use crate::package::which;
use crate::plan::{Plan, Process};
use member::{Member, Step};
use output::{Console, LastWords};
use reporter::{REPORTER, Reports};
use signal_hook::consts::{SIGINT, SIGTERM};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};
use trench_config::ConfigError;

/// How long the last lines of output may take to arrive once all processes have ended.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// How to run a plan.
#[derive(Debug, Clone)]
pub struct Options {
    /// Where log files go: `launch.log` and one file a process.
    pub log_folder: PathBuf,
    /// A process that lives shorter than this counts as crashing on start.
    pub short_life: Duration,
    /// After so many short lives in a row a process is not started again.
    pub most_short_lives: u32,
    /// Nor is one that has ended so many times, however long it lived, ...
    pub most_ends: usize,
    /// ... within this time.
    pub ends_within: Duration,
    /// The exit codes by which a node says that it refuses its command line or configuration: it is not started again, and
    /// the run ends with that code.
    pub refusals: Vec<u8>,
    /// What is started when a process that matters dies and is not started again.
    pub alarm: Option<Alarm>,
    /// Who tells others what happens to the processes.
    pub reporter: Option<Reporter>,
}

/// What calls for help.
#[derive(Debug, Clone)]
pub struct Alarm {
    /// The process. It runs until all others have ended, or the run ends.
    pub process: Process,
    /// Labels of the processes that matter.
    pub matters: BTreeSet<String>,
}

impl Options {
    /// The usual limits: five lives in a row of less than a second, or ten ends within a minute. No exit code is a refusal,
    /// there is no alarm, and nobody is told.
    #[must_use]
    pub fn new(log_folder: &Path) -> Self {
        Self {
            log_folder: log_folder.to_owned(),
            short_life: Duration::from_secs(1),
            most_short_lives: 5,
            most_ends: 10,
            ends_within: Duration::from_secs(60),
            refusals: Vec::new(),
            alarm: None,
            reporter: None,
        }
    }
}

/// Why a plan cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum SuperviseError {
    /// Programs that do not exist.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    MissingPrograms(Vec<ConfigError>),
    /// A log or parameter file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Signals cannot be caught.
    #[error("cannot catch signals: {0}")]
    Signals(std::io::Error),
}

/// What the loop waits for.
enum Event {
    /// SIGINT or SIGTERM came.
    Signal,
    /// A process ended; it is not reaped yet.
    Ended { member: usize },
    /// A process was stopped (SIGSTOP), or goes on.
    Halted { member: usize, halted: bool },
}

/// Runs `plan` to its end. SIGINT and SIGTERM to this process end it: all get SIGINT, then SIGTERM, then SIGKILL,
/// each when its time for the step before is over; a second signal does not wait for that.
///
/// # Errors
/// When nothing was started because a program is missing or a file cannot be written.
pub fn supervise(plan: &Plan, options: &Options) -> Result<Outcome, SuperviseError> {
    check_programs(plan)?;
    write_parameter_files(plan)?;
    let console = Console::open(&options.log_folder)?;
    let (sender, events) = mpsc::channel();
    watch_signals(sender.clone()).map_err(SuperviseError::Signals)?;
    let (alive, all_read) = mpsc::channel();
    let start = Instant::now();
    let members = plan
        .processes
        .iter()
        .enumerate()
        .map(|(index, process)| Member::new(index, process, start + process.start_after))
        .chain(options.alarm.iter().map(|alarm| Member::asleep(plan.processes.len(), &alarm.process)))
        .collect();
    let mut run = Run {
        members,
        reports: Reports::new(options, start),
        options,
        console: console.clone(),
        sender,
        alive,
        ending: false,
        interrupted: false,
        goal: None,
        refused: None,
        given_up: None,
    };
    run.until_all_ended(&events);
    let outcome = run.outcome();
    let refusals = run.refusals();
    let given_up = run.given_up.take();
    run.reports.close(&events);
    drop((run.sender, run.alive));
    // Readers hold the other ends: the channel closes when the last line of output is written.
    let _ = all_read.recv_timeout(LAST_WORDS);
    repeat(&refusals, &console);
    if let Some(label) = given_up {
        console.say("ERROR", &label, "was given up, so that the robots were stopped: see above why it died");
    }
    Ok(outcome)
}

/// Says once more, below all that others said while they ended, what must be mended: robots of one team refuse the same.
fn repeat(refusals: &[(String, LastWords)], console: &Console) {
    let mut said = Vec::new();
    for (label, words) in refusals {
        let text = words.text();
        if !said.contains(&text) {
            console.say("ERROR", label, &format!("refused what it was started with:\n{text}"));
            said.push(text);
        }
    }
}

/// Names all programs that do not exist, before any is started.
fn check_programs(plan: &Plan) -> Result<(), SuperviseError> {
    let own_path = std::env::var("PATH").unwrap_or_default();
    let missing: Vec<ConfigError> = plan
        .processes
        .iter()
        .filter(|process| which(&process.argv[0], path_of(process, &own_path)).is_none())
        .map(|process| ConfigError {
            origin: process.origin.clone(),
            key: process.label.clone(),
            value: process.argv[0].clone(),
            problem: "there is no such program".to_owned(),
            remedy: "check its name, or put its folder on PATH".to_owned(),
        })
        .collect();
    if missing.is_empty() { Ok(()) } else { Err(SuperviseError::MissingPrograms(missing)) }
}

fn path_of<'a>(process: &'a Process, own_path: &'a str) -> &'a str {
    match process.environment.get("PATH") {
        Some(Some(path)) => path,
        Some(None) => "",
        None => own_path,
    }
}

fn write_parameter_files(plan: &Plan) -> Result<(), SuperviseError> {
    for file in plan.processes.iter().flat_map(|process| &process.parameter_files) {
        let folder = file.path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&file.path, &file.text))
            .map_err(|source| SuperviseError::Write { path: file.path.clone(), source })?;
    }
    Ok(())
}

fn watch_signals(sender: Sender<Event>) -> std::io::Result<()> {
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM])?;
    std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        for _ in signals.forever() {
            if sender.send(Event::Signal).is_err() {
                return;
            }
        }
    })?;
    Ok(())
}

struct Run<'a> {
    members: Vec<Member<'a>>,
    reports: Reports<'a>,
    options: &'a Options,
    console: Console,
    sender: Sender<Event>,
    /// Held by every reader of output; never sent on.
    alive: Sender<()>,
    /// Whether all are to end.
    ending: bool,
    /// Whether a signal is the reason.
    interrupted: bool,
    /// The exit code of the process whose end was to end the run.
    goal: Option<u8>,
    /// The exit code of the node that refused its configuration first.
    refused: Option<u8>,
    /// The first process that matters and is not started again.
    given_up: Option<String>,
}

impl Run<'_> {
    fn until_all_ended(&mut self, events: &Receiver<Event>) {
        loop {
            for member in &mut self.members {
                member.act(Instant::now(), &self.console, &self.sender, &self.alive);
            }
            self.call_for_help();
            self.tell();
            self.reports.act(Instant::now(), &self.console, &self.sender, &self.alive);
            if self.members.iter().all(Member::has_ended) {
                return;
            }
            if !self.ending && self.members.iter().all(|member| member.has_ended() || member.is_alarm()) {
                self.end_all();
            }
            let deadlines = self.members.iter().filter_map(Member::next_deadline);
            let next = deadlines.chain(self.reports.next_deadline()).min();
            let wait = next.map_or(Duration::from_secs(3600), |at| at.saturating_duration_since(Instant::now()));
            match events.recv_timeout(wait) {
                Ok(Event::Signal) => self.interrupt(),
                Ok(Event::Ended { member: REPORTER }) => self.reports.reap(Instant::now(), &self.console),
                Ok(Event::Halted { member: REPORTER, .. }) => {}
                Ok(Event::Ended { member }) => self.reap(member),
                Ok(Event::Halted { member, halted }) => self.members[member].tell_halt(halted, &self.console),
                // The loop itself holds a sender, so the channel cannot be closed.
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
            }
        }
    }

    /// Tells others what has become of processes.
    fn tell(&mut self) {
        for news in self.members.iter_mut().filter_map(Member::take_news) {
            self.reports.tell(Instant::now(), news);
        }
    }

    fn interrupt(&mut self) {
        if self.ending {
            self.console.say("WARN", "launch", "signal again: not waiting any longer");
            self.members.iter_mut().for_each(Member::hurry);
        } else {
            self.console.say("INFO", "launch", "signal: ending all processes");
            self.interrupted = true;
            self.end_all();
        }
    }

    fn end_all(&mut self) {
        self.ending = true;
        let now = Instant::now();
        for member in &mut self.members {
            member.end(now, &self.console);
        }
        // Whose end is the run's is named first.
        self.tell();
        self.reports.end();
    }

    fn reap(&mut self, index: usize) {
        let step = self.members[index].reap(&self.console, self.options, self.ending);
        let label = self.members[index].label().to_owned();
        match step {
            Step::EndRun { code } => {
                self.goal = Some(code);
                self.console.say("INFO", &label, "its end ends the run");
                self.end_all();
            }
            Step::Refused { code } => {
                self.refused = Some(code);
                self.console.say("ERROR", &label, "refuses what it was started with: that ends the run");
                self.end_all();
            }
            Step::Continue => {}
        }
    }

    /// Starts the alarm once a process that matters has died for good. One that ends with 0 was asked to by somebody.
    fn call_for_help(&mut self) {
        let Some(alarm) = self.options.alarm.as_ref().filter(|_| !self.ending && self.given_up.is_none()) else {
            return;
        };
        let is_lost =
            |member: &&Member| member.has_ended() && member.failed() && alarm.matters.contains(member.label());
        let Some(label) = self.members.iter().find(is_lost).map(|member| member.label().to_owned()) else { return };
        self.console.say("ERROR", &label, "all robots need it, and it is not started again: stopping them");
        self.given_up = Some(label);
        let now = Instant::now();
        for member in self.members.iter_mut().filter(|member| member.is_alarm()) {
            member.wake(now);
            member.act(now, &self.console, &self.sender, &self.alive);
        }
    }

    fn refusals(&self) -> Vec<(String, LastWords)> {
        let refusals = self.members.iter().filter_map(Member::refusal);
        refusals.map(|(label, words)| (label.to_owned(), words)).collect()
    }

    fn outcome(&self) -> Outcome {
        let has_goal = self.members.iter().any(Member::ends_run);
        match (self.refused, self.goal) {
            (Some(code), _) => Outcome::Refused { code },
            _ if self.given_up.is_some() => Outcome::Stopped,
            (None, Some(code)) => Outcome::Goal { code },
            _ if self.interrupted && has_goal => Outcome::Interrupted,
            _ if self.members.iter().any(Member::failed) => Outcome::Failed,
            _ => Outcome::Clean,
        }
    }
}
