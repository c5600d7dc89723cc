//! One process of the plan through its lives.

use super::child::Running;
use super::ends::Ends;
use super::output::{Console, LastWords};
use super::{Event, Options};
use crate::plan::Process;
use crate::report::{Report, Severity};
use rustix::process::Signal;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

/// One process of the plan.
pub(super) struct Member<'a> {
    index: usize,
    process: &'a Process,
    state: State,
    /// How often it was started again.
    retries: u32,
    /// How its lives ended so far.
    ends: Ends,
    /// Whether its last life ended badly.
    failed: bool,
    /// What it said, if its configuration is what it refused.
    refusal: Option<LastWords>,
    /// Whether it is what calls for help.
    is_alarm: bool,
    /// How often it was started.
    starts: u32,
    /// How its last life ended, if it is to be started again.
    last_end: Option<String>,
    /// What is to be told of it.
    news: Option<Report>,
}

enum State {
    /// To be started.
    Waiting { at: Instant },
    /// Started and not reaped; `ending` once it was told to end.
    Running { running: Running, since: Instant, ending: Option<Ending> },
    /// Over for good.
    Ended,
}

/// How far the end has got: the last signal sent, and when the next is due.
struct Ending {
    sent: Signal,
    next: Option<Instant>,
}

/// What the end of a process means for the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// The run goes on.
    Continue,
    /// It is over, with this exit code.
    EndRun { code: u8 },
    /// It is over with this exit code: no life of this process could be any better.
    Refused { code: u8 },
}

impl<'a> Member<'a> {
    pub(super) fn new(index: usize, process: &'a Process, at: Instant) -> Self {
        let state = State::Waiting { at };
        Self {
            index,
            process,
            state,
            retries: 0,
            ends: Ends::default(),
            failed: false,
            refusal: None,
            is_alarm: false,
            starts: 0,
            last_end: None,
            news: None,
        }
    }

    /// What calls for help, which nobody needs yet.
    pub(super) fn asleep(index: usize, process: &'a Process) -> Self {
        Self { state: State::Ended, is_alarm: true, ..Self::new(index, process, Instant::now()) }
    }

    /// Has a process started that was asleep.
    pub(super) fn wake(&mut self, now: Instant) {
        if self.has_ended() {
            self.state = State::Waiting { at: now };
        }
    }

    pub(super) fn is_alarm(&self) -> bool {
        self.is_alarm
    }

    pub(super) fn label(&self) -> &str {
        &self.process.label
    }

    pub(super) fn ends_run(&self) -> bool {
        self.process.ends_run
    }

    pub(super) fn has_ended(&self) -> bool {
        matches!(self.state, State::Ended)
    }

    pub(super) fn failed(&self) -> bool {
        self.failed
    }

    /// What it said when it refused its configuration.
    pub(super) fn refusal(&self) -> Option<(&str, LastWords)> {
        self.refusal.as_ref().map(|words| (self.label(), words.clone()))
    }

    /// When [`Self::act`] has something to do.
    pub(super) fn next_deadline(&self) -> Option<Instant> {
        match &self.state {
            State::Waiting { at } => Some(*at),
            State::Running { ending, .. } => ending.as_ref().and_then(|ending| ending.next),
            State::Ended => None,
        }
    }

    /// Starts the process, or sends the next signal, if its time has come.
    pub(super) fn act(&mut self, now: Instant, console: &Console, events: &Sender<Event>, alive: &Sender<()>) {
        if self.next_deadline().is_none_or(|at| at > now) {
            return;
        }
        match &mut self.state {
            State::Waiting { .. } => match Running::start(self.process, self.index, console, events, alive) {
                Ok(running) => {
                    console.say("INFO", self.label(), &format!("process started with pid [{}]", running.pid()));
                    self.state = State::Running { running, since: now, ending: None };
                    self.starts += 1;
                    match self.last_end.take() {
                        _ if self.is_alarm => {
                            self.note(Severity::Error, "says stop: what all robots need was given up")
                        }
                        Some(end) => self.note_passing(&format!("{end} and was started again")),
                        None => self.note(Severity::Fine, "runs"),
                    }
                }
                Err(error) => {
                    console.say("ERROR", self.label(), &format!("cannot be started: {error}"));
                    self.failed = true;
                    self.state = State::Ended;
                    self.note(Severity::Error, &format!("cannot be started: {error}"));
                }
            },
            State::Running { running, ending: Some(ending), .. } => {
                let (signal, name, next) = match ending.sent {
                    Signal::INT => (Signal::TERM, "SIGTERM", Some(now + self.process.sigkill_timeout)),
                    _ => (Signal::KILL, "SIGKILL", None),
                };
                console.say("ERROR", &self.process.label, &format!("has not ended in time, sending {name}"));
                running.signal(signal);
                *ending = Ending { sent: signal, next };
            }
            State::Running { ending: None, .. } | State::Ended => {}
        }
    }

    /// Tells it to end, for good.
    pub(super) fn end(&mut self, now: Instant, console: &Console) {
        match &mut self.state {
            State::Waiting { .. } => self.state = State::Ended,
            State::Running { running, ending: ending @ None, .. } => {
                console.say("INFO", &self.process.label, "sending signal 'SIGINT'");
                running.signal(Signal::INT);
                *ending = Some(Ending { sent: Signal::INT, next: Some(now + self.process.sigterm_timeout) });
            }
            State::Running { .. } | State::Ended => {}
        }
    }

    /// Makes the next signal due at once.
    pub(super) fn hurry(&mut self) {
        if let State::Running { ending: Some(Ending { next: Some(next), .. }), .. } = &mut self.state {
            *next = Instant::now();
        }
    }

    /// What is to be told of it, once.
    pub(super) fn take_news(&mut self) -> Option<Report> {
        self.news.take()
    }

    /// What has become of it, until something else does.
    fn note(&mut self, severity: Severity, text: &str) {
        let pid = match &self.state {
            State::Running { running, .. } => Some(running.pid().as_raw_pid().unsigned_abs()),
            State::Waiting { .. } | State::Ended => None,
        };
        let [name, label] = [self.label(), self.label()].map(str::to_owned);
        let news = Report { name, label, severity, lasts: true, starts: self.starts, pid, text: text.to_owned() };
        self.news = Some(news);
    }

    /// What happened to it, though it runs.
    fn note_passing(&mut self, text: &str) {
        self.note(Severity::Warning, text);
        self.news.iter_mut().for_each(|news| news.lasts = false);
    }

    /// Names a process that somebody has stopped: it lives and does nothing.
    pub(super) fn tell_halt(&mut self, halted: bool, console: &Console) {
        if halted {
            let text = "was stopped by a signal and does nothing until SIGCONT";
            console.say("ERROR", self.label(), &format!("process {text}"));
            self.note(Severity::Error, text);
        } else {
            console.say("INFO", self.label(), "process goes on");
            self.note_passing("was stopped by a signal and goes on");
        }
    }

    /// Takes the exit status of the process, which has ended, and decides whether it lives again.
    pub(super) fn reap(&mut self, console: &Console, options: &Options, run_is_ending: bool) -> Step {
        let State::Running { running, since, ending } = std::mem::replace(&mut self.state, State::Ended) else {
            return Step::Continue;
        };
        let (pid, last_words) = (running.pid(), running.last_words());
        let status = match running.reap() {
            Ok(status) => status,
            Err(error) => {
                console.say("ERROR", self.label(), &format!("its exit code is lost: {error}"));
                self.failed = true;
                self.note(Severity::Error, &format!("has ended, its exit code is lost: {error}"));
                return Step::Continue;
            }
        };
        let ended_by_us =
            ending.is_some_and(|ending| ending.sent == Signal::INT) && status.signal() == Some(Signal::INT.as_raw());
        self.failed = !status.success() && !ended_by_us;
        match self.failed {
            true => console.say("ERROR", self.label(), &format!("process has died [pid {pid}, {status}]")),
            false => console.say("INFO", self.label(), &format!("process has finished cleanly [pid {pid}]")),
        }
        let end = if self.failed { format!("has died ({status})") } else { "has finished".to_owned() };
        let severity = if self.failed { Severity::Error } else { Severity::Fine };
        let code = exit_code(status);
        let refused = self.process.is_node && options.refusals.contains(&code);
        self.refusal = refused.then_some(last_words);
        if run_is_ending {
            return Step::Continue;
        }
        if refused {
            self.note(severity, &format!("{end}: it refuses what it was started with, which ends the run"));
            return Step::Refused { code };
        }
        if self.process.ends_run {
            self.note(severity, &format!("{end}, which ends the run"));
            return Step::EndRun { code };
        }
        self.start_again(since.elapsed(), &end, console, options);
        Step::Continue
    }

    fn start_again(&mut self, life: Duration, end: &str, console: &Console, options: &Options) {
        let Some(respawn) = self.process.respawn else {
            let (severity, rest) =
                if self.failed { (Severity::Error, ", not started again") } else { (Severity::Fine, "") };
            return self.note(severity, &format!("{end}{rest}"));
        };
        let crashes = self.ends.add(Instant::now(), life, options);
        let given_up = if respawn.max_retries.is_some_and(|most| self.retries >= most) {
            Some(format!("was started again {} times: no more", self.retries))
        } else if let Some(crashes) = crashes {
            self.failed = true;
            Some(format!("{crashes}: not starting it again"))
        } else {
            None
        };
        if let Some(reason) = given_up {
            console.say("ERROR", self.label(), &reason);
            return self.note(Severity::Error, &format!("given up: {end}; {reason}"));
        }
        self.retries += 1;
        self.state = State::Waiting { at: Instant::now() + respawn.delay };
        self.note(Severity::Warning, &format!("{end} and is to be started again"));
        self.last_end = Some(end.to_owned());
    }
}

/// As a shell gives it: 128 + n for signal n.
fn exit_code(status: ExitStatus) -> u8 {
    let code = status.code().or_else(|| status.signal().map(|signal| 128 + signal)).unwrap_or(1);
    u8::try_from(code).unwrap_or(1)
}
