//! The process that tells others what happens to the processes of the run: fed line by line, and nobody waits for it.

use super::child::Running;
use super::output::Console;
use super::{Event, Options};
use crate::plan::Process;
use crate::report::Report;
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::process::Signal;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::process::ChildStdin;
use std::sync::mpsc::{Receiver, Sender};
use std::time::{Duration, Instant};

/// Its number among the members, of which it is none.
pub(super) const REPORTER: usize = usize::MAX;

/// Before it is started again for the first time; twice as long each time, up to the longest.
const RETRY: Duration = Duration::from_secs(1);
const LONGEST_RETRY: Duration = Duration::from_secs(30);
/// Between two tries to say what its pipe did not take.
const AGAIN: Duration = Duration::from_millis(200);
/// How long after it was told something it is told to end: readers lose what they have not read yet when its writer goes.
const LINGER: Duration = Duration::from_millis(150);
/// How long the end of the run waits for it once all others have ended: it was told to end when they were.
const LEAVE: Duration = Duration::from_secs(1);

/// Who tells others what happens to the processes of a run.
#[derive(Debug, Clone)]
pub struct Reporter {
    /// The process. It gets a [`Report`] a line on its standard input, all that holds at its start and each change, and
    /// should end when that ends.
    pub process: Process,
    /// Names of processes for everybody, by label; the label is the name of others.
    pub names: BTreeMap<String, String>,
}

/// The reporter of a run, if it has one.
pub(super) struct Reports<'a> {
    options: &'a Options,
    /// The last word on each process, by label.
    known: BTreeMap<String, Report>,
    /// Labels of those whose last word it was not told.
    untold: BTreeSet<String>,
    child: Option<(Running, ChildStdin)>,
    /// When it is to be started, or to be told the rest.
    next: Option<Instant>,
    retry: Duration,
    /// When it was told something last.
    told: Instant,
    /// Whether it is to end, and was told to.
    is_ending: bool,
    is_told_to_end: bool,
}

impl<'a> Reports<'a> {
    pub(super) fn new(options: &'a Options, now: Instant) -> Self {
        let next = options.reporter.is_some().then_some(now);
        Self {
            options,
            known: BTreeMap::new(),
            untold: BTreeSet::new(),
            child: None,
            next,
            retry: RETRY,
            told: now,
            is_ending: false,
            is_told_to_end: false,
        }
    }

    /// When [`Self::act`] has something to do.
    pub(super) fn next_deadline(&self) -> Option<Instant> {
        self.next
    }

    /// Starts it, or tells it what it does not know yet, if it is time.
    pub(super) fn act(&mut self, now: Instant, console: &Console, events: &Sender<Event>, alive: &Sender<()>) {
        if self.next.take_if(|at| *at <= now).is_none() {
            return;
        }
        if self.is_ending {
            return self.tell_to_end();
        }
        if self.child.is_some() {
            return self.tell_rest(now);
        }
        let Some(reporter) = &self.options.reporter else { return };
        match start(&reporter.process, console, events, alive) {
            Ok(child) => {
                self.child = Some(child);
                self.untold = self.known.keys().cloned().collect();
                self.tell_rest(now);
            }
            Err(error) => self.try_later(now, console, &format!("cannot be started: {error}")),
        }
    }

    /// Says what has become of a process.
    pub(super) fn tell(&mut self, now: Instant, mut report: Report) {
        let Some(reporter) = &self.options.reporter else { return };
        if let Some(name) = reporter.names.get(&report.label) {
            report.name.clone_from(name);
        }
        self.untold.insert(report.label.clone());
        self.known.insert(report.label.clone(), report);
        if self.child.is_some() {
            self.tell_rest(now);
        }
    }

    /// Says what it was not told yet, as far as its pipe takes it.
    fn tell_rest(&mut self, now: Instant) {
        let Some((_, pipe)) = &mut self.child else { return };
        let known = &self.known;
        let mut is_full = false;
        self.untold.retain(|label| {
            let Some(line) = known.get(label).map(Report::line).filter(|line| Report::fits(line)) else { return false };
            // A pipe takes a line whole or not at all. One that nobody reads any more is closed with its process.
            is_full = is_full || pipe.write_all(line.as_bytes()).is_err();
            is_full
        });
        self.told = now;
        self.next = is_full.then_some(now + AGAIN);
    }

    /// Takes its end.
    pub(super) fn reap(&mut self, now: Instant, console: &Console) {
        let Some((running, _)) = self.child.take() else { return };
        self.next = None;
        let status = running.reap();
        if self.is_ending {
            return;
        }
        let code = status.as_ref().ok().and_then(std::process::ExitStatus::code);
        let end = status.map_or_else(|error| error.to_string(), |status| status.to_string());
        match code.and_then(|code| u8::try_from(code).ok()).is_some_and(|code| self.options.refusals.contains(&code)) {
            true => console.say("WARN", "launch", &format!("/diagnostics hears nothing of its processes ({end})")),
            false => self.try_later(now, console, &format!("has ended ({end})")),
        }
    }

    fn try_later(&mut self, now: Instant, console: &Console, what: &str) {
        let seconds = self.retry.as_secs();
        console.say("WARN", "launch", &format!("who tells /diagnostics {what}: again in {seconds} s"));
        self.next = Some(now + self.retry);
        self.retry = (2 * self.retry).min(LONGEST_RETRY);
    }

    /// Has it end, once it has said what it was told before.
    pub(super) fn end(&mut self) {
        if !std::mem::replace(&mut self.is_ending, true) {
            self.next = self.child.is_some().then(|| self.told + LINGER);
        }
    }

    fn tell_to_end(&mut self) {
        if !std::mem::replace(&mut self.is_told_to_end, true)
            && let Some((running, _)) = &self.child
        {
            running.signal(Signal::INT);
        }
    }

    /// Sees to its end, once all others have ended.
    pub(super) fn close(mut self, events: &Receiver<Event>) {
        self.end();
        if let Some(at) = self.next {
            std::thread::sleep(at.saturating_duration_since(Instant::now()));
        }
        self.tell_to_end();
        let Some((running, _)) = &self.child else { return };
        let deadline = Instant::now() + LEAVE;
        loop {
            match events.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(Event::Ended { member: REPORTER }) => break,
                Ok(_) => {}
                Err(_) => {
                    running.signal(Signal::KILL);
                    break;
                }
            }
        }
        if let Some((running, _)) = self.child.take() {
            let _nobody_asks = running.reap();
        }
    }
}

fn start(
    process: &Process,
    console: &Console,
    events: &Sender<Event>,
    alive: &Sender<()>,
) -> io::Result<(Running, ChildStdin)> {
    let (running, pipe) = Running::start_fed(process, REPORTER, console, events, alive)?;
    let set = fcntl_getfl(&pipe).and_then(|flags| fcntl_setfl(&pipe, flags | OFlags::NONBLOCK));
    if let Err(error) = set {
        // A pipe that is full would hold up the launcher.
        running.signal(Signal::KILL);
        running.reap()?;
        return Err(error.into());
    }
    Ok((running, pipe))
}
