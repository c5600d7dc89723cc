//! Who goes first where processors are scarce: the control loop, from the camera frame to the wheels.

use rustix::process::{Pid, setpriority_process};
use std::fs;
use std::sync::OnceLock;
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Where a process stands when several could run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// The localizer: every robot waits for it.
    Localizer,
    /// A robot's controller.
    Controller,
    /// The bridge, which needs what all controllers say.
    Bridge,
    /// The world that the test bed plays: behind the loop that it tests.
    World,
    /// Whoever watches the control loop, or plans for it.
    Watcher,
}

/// What this process has taken.
static TURN: OnceLock<Turn> = OnceLock::new();

impl Turn {
    /// Every step takes a fifth of the share of a busy processor; one is enough to yield to whom wakes at the same time.
    const fn niceness(self) -> i32 {
        match self {
            Self::Localizer | Self::Controller => 0,
            Self::Bridge | Self::World => 1,
            Self::Watcher => 4,
        }
    }

    /// Of the control loop: above everything that is not in it, so that a build on the same host does not hold up robots; and of
    /// those that one frame wakes each lets the one before it end. Without, the first controller that the localizer wakes takes
    /// the processor from it, and the others wake late.
    const fn realtime(self) -> Option<u8> {
        match self {
            Self::Localizer => Some(12),
            Self::Controller => Some(11),
            Self::Bridge => Some(10),
            Self::World | Self::Watcher => None,
        }
    }
}

/// Has this process, and whatever threads it starts afterwards, wait for its turn; its event loop takes it before it begins. A
/// system that does not allow it runs as before.
pub fn wait_turn(turn: Turn) {
    let _first = TURN.set(turn);
    let _best_effort = setpriority_process(None, turn.niceness());
}

/// Gives the calling thread, the event loop, the real-time priority of its process's turn (`SCHED_FIFO`), where it has one and
/// the system allows it: to root, with `CAP_SYS_NICE`, or within `ulimit -r`. Threads started afterwards would have it too.
/// True if it has.
pub(crate) fn take_turn() -> bool {
    let Some(value) = TURN.get().and_then(|turn| turn.realtime()) else { return false };
    let Ok(value) = ThreadPriorityValue::try_from(value) else { return false };
    let fifo = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), fifo).is_ok()
}

/// Has all threads but the calling one wait until the control loop has had its turn: those of the network, which copy and
/// acknowledge what nodes of this host already have.
pub(crate) fn threads_wait_turn() {
    let own = rustix::thread::gettid();
    let tasks = fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let numbers = tasks.filter_map(|task| task.file_name().to_str()?.parse().ok());
    for thread in numbers.filter_map(Pid::from_raw).filter(|thread| *thread != own) {
        let _best_effort = setpriority_process(Some(thread), Turn::Watcher.niceness());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::process::getpriority_process;
    use std::sync::mpsc::channel;
    use thread_priority::thread_schedule_policy;

    #[test]
    fn each_that_a_frame_wakes_lets_the_one_before_it_end() {
        assert!(Turn::Localizer.realtime() > Turn::Controller.realtime());
        assert!(Turn::Controller.realtime() > Turn::Bridge.realtime());
        assert!(Turn::Bridge.realtime() > Turn::World.realtime());
    }

    #[test]
    fn the_event_loop_takes_its_turn_where_it_may_and_other_threads_do_not() {
        wait_turn(Turn::Bridge);
        let (say, hear) = channel::<()>();
        let other = std::thread::spawn(move || {
            hear.recv().unwrap_err();
            thread_schedule_policy().unwrap()
        });
        let taken = take_turn();
        let fifo = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        assert_eq!(thread_schedule_policy().unwrap() == fifo, taken);
        drop(say);
        assert_ne!(other.join().unwrap(), fifo);
    }

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
        assert_eq!(getpriority_process(Some(thread)).unwrap(), Turn::Watcher.niceness());
        assert_eq!(getpriority_process(Some(rustix::thread::gettid())).unwrap(), before);
        drop(end);
        other.join().unwrap();
    }
}
