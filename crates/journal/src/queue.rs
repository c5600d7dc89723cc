//! Writing in a thread of its own, so that a slow disk never holds up the loop that drives robots.

use crate::JournalError;
use crate::file::JournalFile;
use crate::record::End;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use trench_core::Times;

/// The most bytes that wait for the disk.
pub(crate) const LIMIT: usize = 64 << 20;
/// How often the age of the open chunk is looked at.
const LOOK: Duration = Duration::from_millis(100);

type Item = (Times, Vec<u8>);

#[derive(Default)]
struct Shared {
    waiting: AtomicUsize,
    overflowed: AtomicBool,
    problem: Mutex<Option<JournalError>>,
}

/// The way to the thread that writes.
pub(crate) struct Queue {
    sender: Option<Sender<Item>>,
    thread: Option<JoinHandle<()>>,
    shared: Arc<Shared>,
    limit: usize,
}

impl Queue {
    /// Starts the thread; at most `limit` bytes wait for it.
    pub(crate) fn start(file: JournalFile, limit: usize) -> std::io::Result<Self> {
        let (sender, receiver) = channel();
        let shared = Arc::new(Shared::default());
        let theirs = Arc::clone(&shared);
        let thread = thread::Builder::new().name("journal".to_owned()).spawn(move || {
            if let Err(error) = write(file, &receiver, &theirs) {
                *theirs.problem.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            }
        })?;
        Ok(Self { sender: Some(sender), thread: Some(thread), shared, limit })
    }

    /// Hands over a step, or says why the journal ends here. Never waits.
    pub(crate) fn push(&mut self, item: Item) -> Result<(), String> {
        let Some(sender) = &self.sender else { return Ok(()) };
        let length = item.1.len();
        if self.shared.waiting.fetch_add(length, Ordering::Relaxed) + length > self.limit {
            self.shared.overflowed.store(true, Ordering::Release);
            self.sender = None;
            return Err(format!("the disk is too slow: {} bytes wait for it", self.limit));
        }
        if sender.send(item).is_err() {
            self.sender = None;
            let problem = self.shared.problem.lock().unwrap_or_else(PoisonError::into_inner).take();
            return Err(problem.map_or_else(|| "its thread has ended".to_owned(), |problem| problem.to_string()));
        }
        Ok(())
    }
}

impl Drop for Queue {
    fn drop(&mut self) {
        self.sender = None;
        if let Some(thread) = self.thread.take() {
            // The thread catches its errors; there is nobody left to tell of a panic.
            let _ended = thread.join();
        }
    }
}

fn write(mut file: JournalFile, receiver: &Receiver<Item>, shared: &Shared) -> Result<(), JournalError> {
    loop {
        match receiver.recv_timeout(LOOK) {
            Ok((at, step)) => {
                file.append(at, &step)?;
                shared.waiting.fetch_sub(step.len(), Ordering::Relaxed);
                file.flush_if_due()?;
            }
            Err(RecvTimeoutError::Timeout) => file.flush_if_due()?,
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    file.finish(if shared.overflowed.load(Ordering::Acquire) { End::Overflow } else { End::Clean })
}
