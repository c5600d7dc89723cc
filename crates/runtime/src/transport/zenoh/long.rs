//! Long messages: an image is cut into fragments, which wait for room on each link. A thread of its own waits for it, so
//! that the event loop does not.

use super::writer::Put;
use std::sync::OnceLock;
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};

/// Messages that wait for the thread.
const WAITING: usize = 16;

/// The way to the thread, which is started by the first long message of a process.
#[derive(Default)]
pub(super) struct LongWay(OnceLock<Option<SyncSender<Put>>>);

impl LongWay {
    /// Hands a message over; false if too many wait already.
    pub(super) fn send(&self, put: Put) -> bool {
        match self.0.get_or_init(start) {
            Some(sender) => match sender.try_send(put) {
                Ok(()) => true,
                Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => false,
            },
            // Without a thread, a moment's wait is better than silence.
            None => {
                put.send();
                true
            }
        }
    }
}

fn start() -> Option<SyncSender<Put>> {
    let (sender, receiver) = sync_channel::<Put>(WAITING);
    let thread = std::thread::Builder::new().name("long messages".to_owned());
    thread.spawn(move || receiver.into_iter().for_each(|put| put.send())).ok().map(|_| sender)
}
