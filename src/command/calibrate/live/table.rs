//! Where the node that sees and the server that shows meet.

use super::bench::Bench;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;
use trench_view::colours::Command;

/// What a browser gets at once: see `message.rs`.
pub(super) type Message = Arc<[u8]>;

/// Between the node's thread and the server's.
pub(super) struct Table {
    bench: Mutex<Bench>,
    commands: Mutex<Vec<Command>>,
    newest: watch::Sender<Message>,
    /// Browsers that have drawn what they got and wait for more.
    waiting: AtomicUsize,
}

/// A browser that waits; it does so as long as this lives.
pub(super) struct Waiting<'a>(&'a Table);

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.waiting.fetch_sub(1, Ordering::Relaxed);
    }
}

/// More commands at once are a broken page's.
const MOST: usize = 64;

impl Table {
    pub(super) fn new(bench: Bench) -> Self {
        let newest = watch::Sender::new(bench.message());
        Self { bench: Mutex::new(bench), commands: Mutex::default(), newest, waiting: AtomicUsize::new(0) }
    }

    /// The node's thread alone asks for it.
    pub(super) fn bench(&self) -> MutexGuard<'_, Bench> {
        self.bench.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn queue(&self) -> MutexGuard<'_, Vec<Command>> {
        self.commands.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn ask(&self, command: Command) {
        let mut queue = self.queue();
        if queue.len() < MOST {
            queue.push(command);
        }
    }

    pub(super) fn asked(&self) -> Vec<Command> {
        std::mem::take(&mut *self.queue())
    }

    pub(super) fn wait(&self) -> Waiting<'_> {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        Waiting(self)
    }

    /// Whether any browser waits.
    pub(super) fn is_watched(&self) -> bool {
        self.waiting.load(Ordering::Relaxed) > 0
    }

    /// A browser's ear; the first thing it hears is what there is now.
    pub(super) fn listen(&self) -> watch::Receiver<Message> {
        let mut newest = self.newest.subscribe();
        newest.mark_changed();
        newest
    }

    pub(super) fn publish(&self, message: Message) {
        self.newest.send_replace(message);
    }
}
