//! Who goes first where processors are scarce: the control loop, from the camera frame to the wheels.

use rustix::process::{Pid, setpriority_process};
use std::fs;

/// Where a process stands when several could run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// Behind the robots' controllers: it needs what they say.
    Next,
    /// Behind the whole control loop, which it watches or plans for.
    Last,
}

impl Turn {
    /// Every step takes a fifth of the share of a busy processor; one is enough to yield to whom wakes at the same time.
    const fn niceness(self) -> i32 {
        match self {
            Self::Next => 1,
            Self::Last => 4,
        }
    }
}

/// Has this process, and whatever threads it starts afterwards, wait for its turn. A system that does not allow it runs as
/// before.
pub fn wait_turn(turn: Turn) {
    let _best_effort = setpriority_process(None, turn.niceness());
}

/// Has all threads but the calling one wait until the control loop has had its turn: those of the network, which copy and
/// acknowledge what nodes of this host already have.
pub(crate) fn threads_wait_turn() {
    let own = rustix::thread::gettid();
    let tasks = fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let numbers = tasks.filter_map(|task| task.file_name().to_str()?.parse().ok());
    for thread in numbers.filter_map(Pid::from_raw).filter(|thread| *thread != own) {
        let _best_effort = setpriority_process(Some(thread), Turn::Last.niceness());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::process::getpriority_process;
    use std::sync::mpsc::channel;

    #[test]
    fn other_threads_wait_and_the_calling_one_does_not() {
        let before = getpriority_process(Some(rustix::thread::gettid())).unwrap();
        let (say, hear) = channel();
        let (end, wait) = channel::<()>();
        let other = std::thread::spawn(move || {
            say.send(rustix::thread::gettid()).unwrap();
            wait.recv().unwrap_err();
        });
        let thread = hear.recv().unwrap();
        threads_wait_turn();
        assert_eq!(getpriority_process(Some(thread)).unwrap(), Turn::Last.niceness());
        assert_eq!(getpriority_process(Some(rustix::thread::gettid())).unwrap(), before);
        drop(end);
        other.join().unwrap();
    }
}
