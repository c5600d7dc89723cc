//! Where the node that listens and the server that shows meet.

use crate::command::web::{Waiters, Waiting};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;
use trench_view::{Snapshot, View};

/// The picture between its two threads. The newest snapshot wins; one is made only while a browser waits for it.
pub(super) struct Hub {
    view: Mutex<View>,
    /// The robots that are listened to.
    robots: Mutex<BTreeSet<String>>,
    newest: watch::Sender<Snapshot>,
    waiting: Waiters,
    /// Whether one of them begins and needs the history.
    newcomer: AtomicBool,
}

impl Hub {
    pub(super) fn new(setup: String) -> Self {
        let mut view = View::default();
        view.put("setup", setup);
        Self {
            view: Mutex::new(view),
            robots: Mutex::default(),
            newest: watch::Sender::new(Snapshot::default()),
            waiting: Waiters::default(),
            newcomer: AtomicBool::new(false),
        }
    }

    /// The state of the picture: the node's thread alone holds it for longer than a moment.
    pub(super) fn view(&self) -> MutexGuard<'_, View> {
        self.view.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn robots(&self) -> MutexGuard<'_, BTreeSet<String>> {
        self.robots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn wait(&self, needs_history: bool) -> Waiting<'_> {
        if needs_history {
            self.newcomer.store(true, Ordering::Relaxed);
        }
        self.waiting.wait()
    }

    pub(super) fn listen(&self) -> watch::Receiver<Snapshot> {
        self.newest.subscribe()
    }

    /// Whether any browser waits.
    pub(super) fn is_watched(&self) -> bool {
        self.waiting.are_there()
    }

    /// Gives all browsers what there is now.
    pub(super) fn publish(&self) {
        let with_history = self.newcomer.swap(false, Ordering::Relaxed);
        let snapshot = self.view().snapshot(with_history);
        self.newest.send_replace(snapshot);
    }
}
