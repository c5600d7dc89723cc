//! Where the node that sees and the server that shows meet.

use super::bench::Bench;
use crate::command::web::{Waiters, Waiting};
use axum::body::Bytes;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;
use trench_view::colours::Command;

/// What a browser gets at once: see [`Bench::message`].
pub(super) type Message = Bytes;

/// Between the node's thread and the server's.
pub(super) struct Table {
    bench: Mutex<Bench>,
    commands: Mutex<Vec<Command>>,
    newest: watch::Sender<Message>,
    waiting: Waiters,
}

/// More commands at once are a broken page's.
const MOST: usize = 64;

impl Table {
    pub(super) fn new(bench: Bench) -> Self {
        let newest = watch::Sender::new(bench.message());
        Self { bench: Mutex::new(bench), commands: Mutex::default(), newest, waiting: Waiters::default() }
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
        self.waiting.wait()
    }

    /// Whether any browser waits.
    pub(super) fn is_watched(&self) -> bool {
        self.waiting.are_there()
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
