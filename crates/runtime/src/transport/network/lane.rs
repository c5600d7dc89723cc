//! A way beside the event loop for what may be late or lost: images.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// A thread that sends one message after the other, each as slowly as it must. What comes meanwhile takes the place of what
/// waits: who looks at images wants the newest.
pub(crate) struct Lane<M> {
    shared: Arc<Shared<M>>,
}

struct Shared<M> {
    state: Mutex<State<M>>,
    changed: Condvar,
}

struct State<M> {
    waiting: Option<M>,
    open: bool,
}

impl<M> Shared<M> {
    fn lock(&self) -> MutexGuard<'_, State<M>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next message; none when the lane is closed.
    fn next(&self) -> Option<M> {
        let idle = |state: &mut State<M>| state.open && state.waiting.is_none();
        let woken = self.changed.wait_while(self.lock(), idle);
        let mut state = woken.unwrap_or_else(PoisonError::into_inner);
        if state.open { state.waiting.take() } else { None }
    }
}

impl<M: Send + 'static> Lane<M> {
    /// Opens the lane; `send` may take its time.
    pub(crate) fn open(mut send: impl FnMut(M) + Send + 'static) -> std::io::Result<Self> {
        let state = Mutex::new(State { waiting: None, open: true });
        let shared = Arc::new(Shared { state, changed: Condvar::new() });
        let lane = Self { shared: Arc::clone(&shared) };
        let thread = std::thread::Builder::new().name("images".to_owned());
        thread.spawn(move || {
            while let Some(message) = shared.next() {
                send(message);
            }
        })?;
        Ok(lane)
    }

    /// Hands a message over.
    pub(crate) fn put(&self, message: M) {
        self.shared.lock().waiting = Some(message);
        self.shared.changed.notify_one();
    }
}

impl<M> Drop for Lane<M> {
    fn drop(&mut self) {
        self.shared.lock().open = false;
        self.shared.changed.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn the_newest_takes_the_place_of_what_waits() {
        let (begin, begun) = channel();
        let (go, may_go) = channel::<()>();
        let lane = Lane::open(move |number: u32| {
            begin.send(number).unwrap();
            may_go.recv().unwrap();
        });
        let lane = lane.unwrap();
        lane.put(1);
        assert_eq!(begun.recv(), Ok(1));
        for number in 2..=5 {
            lane.put(number);
        }
        go.send(()).unwrap();
        assert_eq!(begun.recv(), Ok(5));
        drop(lane);
        go.send(()).unwrap();
        assert!(begun.recv().is_err(), "the thread outlives its lane");
    }
}
