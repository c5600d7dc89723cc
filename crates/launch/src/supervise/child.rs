//! One running process and its process group.

use super::Event;
use super::output::{Console, LastWords, Screen};
use crate::plan::{Output, Process};
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, getpid, getppid, kill_process_group};
use std::io;
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::Sender;

/// A started process, the leader of its own group.
#[derive(Debug)]
pub(super) struct Running {
    child: Child,
    pid: Pid,
    last_words: LastWords,
}

impl Running {
    /// Starts `process`, the `member`-th of the run.
    pub(super) fn start(
        process: &Process,
        member: usize,
        console: &Console,
        events: &Sender<Event>,
        alive: &Sender<()>,
    ) -> io::Result<Self> {
        let mut command = command(process);
        command.stdin(Stdio::null());
        die_with_parent(&mut command);
        Self::spawn(command, process, member, console, Screen::Error, events, alive)
    }

    /// As [`Self::start`], with a pipe to its standard input; what it says goes to log files alone. The end of the pipe tells it that
    /// the launcher has died: a signal could come before.
    pub(super) fn start_fed(
        process: &Process,
        member: usize,
        console: &Console,
        events: &Sender<Event>,
        alive: &Sender<()>,
    ) -> io::Result<(Self, ChildStdin)> {
        let mut command = command(process);
        command.stdin(Stdio::piped());
        let mut running = Self::spawn(command, process, member, console, Screen::None, events, alive)?;
        let pipe = running.child.stdin.take().ok_or(io::ErrorKind::BrokenPipe)?;
        Ok((running, pipe))
    }

    fn spawn(
        mut command: Command,
        process: &Process,
        member: usize,
        console: &Console,
        errors: Screen,
        events: &Sender<Event>,
        alive: &Sender<()>,
    ) -> io::Result<Self> {
        let mut child = command.spawn()?;
        let last_words = LastWords::default();
        let watched = forward_output(process, &mut child, &last_words, console, errors, alive).and_then(|()| {
            let (pid, label, events) = (Pid::from_child(&child), &process.label, events.clone());
            std::thread::Builder::new().name(format!("wait {label}")).spawn(move || tell_changes(pid, member, &events))
        });
        let running = Self { pid: Pid::from_child(&child), child, last_words };
        if let Err(error) = watched {
            // It runs, but nobody would notice its end.
            running.signal(Signal::KILL);
            running.reap()?;
            return Err(error);
        }
        Ok(running)
    }

    pub(super) fn pid(&self) -> Pid {
        self.pid
    }

    /// What it says on standard error; complete once its output has been read to the end.
    pub(super) fn last_words(&self) -> LastWords {
        self.last_words.clone()
    }

    /// Signals the whole group. Nothing happens where it has ended.
    pub(super) fn signal(&self, signal: Signal) {
        let _ = kill_process_group(self.pid, signal);
    }

    /// Takes the exit status of the ended process; what it left in its group is told to end.
    pub(super) fn reap(mut self) -> io::Result<ExitStatus> {
        self.signal(Signal::TERM);
        self.child.wait()
    }
}

fn forward_output(
    process: &Process,
    child: &mut Child,
    last_words: &LastWords,
    console: &Console,
    errors: Screen,
    alive: &Sender<()>,
) -> io::Result<()> {
    let log = console.log_of(&process.label);
    let screen = if process.output == Output::Screen { Screen::Out } else { Screen::None };
    if let Some(stream) = child.stdout.take() {
        console.forward(stream, &process.label, screen, log.clone(), None, alive.clone())?;
    }
    if let Some(stream) = child.stderr.take() {
        console.forward(stream, &process.label, errors, log, Some(last_words.clone()), alive.clone())?;
    }
    Ok(())
}

/// Tells of each stop (SIGSTOP) and continuation of `pid`, and of its end without reaping it: until the loop reaps it, its
/// id cannot become another process's.
fn tell_changes(pid: Pid, member: usize, events: &Sender<Event>) {
    let halts = WaitIdOptions::STOPPED | WaitIdOptions::CONTINUED;
    loop {
        match rustix::process::waitid(WaitId::Pid(pid), halts | WaitIdOptions::EXITED | WaitIdOptions::NOWAIT) {
            Err(rustix::io::Errno::INTR) => {}
            Ok(Some(status)) if status.stopped() || status.continued() => {
                // Taken, so that it is told once; an end that has come meanwhile is left.
                if let Ok(Some(taken)) = rustix::process::waitid(WaitId::Pid(pid), halts | WaitIdOptions::NOHANG) {
                    let _ = events.send(Event::Halted { member, halted: taken.stopped() });
                }
            }
            _ => break,
        }
    }
    // The loop may be gone already when the launcher itself ends.
    let _ = events.send(Event::Ended { member });
}

fn command(process: &Process) -> Command {
    let mut command = Command::new(&process.argv[0]);
    command.args(&process.argv[1..]).process_group(0);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    for (name, value) in &process.environment {
        match value {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    if let Some(folder) = &process.folder {
        command.current_dir(folder);
    }
    command
}

/// Has the process told to end (SIGINT) when the launcher dies, however it dies: robots must not drive on unwatched.
fn die_with_parent(command: &mut Command) {
    let launcher = getpid();
    let before_exec = move || {
        rustix::process::set_parent_process_death_signal(Some(Signal::INT))?;
        // The launcher may have died before the line above took effect.
        if getppid() == Some(launcher) { Ok(()) } else { Err(io::ErrorKind::NotConnected.into()) }
    };
    #[expect(unsafe_code, reason = "between fork and exec; the closure makes two system calls and allocates nothing")]
    // SAFETY: prctl and getppid are async-signal-safe, and an ErrorKind becomes an io::Error without allocation.
    unsafe {
        command.pre_exec(before_exec);
    }
}
