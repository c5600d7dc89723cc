//! From Zenoh's threads to the event loop: a bounded queue that makes a file descriptor readable.

use rustdds::mio1::unix::SourceFd;
use rustdds::mio1::{Interest, Registry, Token, event};
use rustix::event::{EventfdFlags, eventfd};
use std::collections::VecDeque;
use std::io;
use std::os::fd::{AsRawFd, OwnedFd};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The loop's end. Beyond its capacity the oldest are forgotten: whoever counts sees the gap.
pub(super) struct Inbox<T>(Arc<Shared<T>>);

/// The callbacks' end.
pub(super) struct Outlet<T>(Arc<Shared<T>>);

struct Shared<T> {
    queue: Mutex<VecDeque<T>>,
    capacity: usize,
    wakeup: OwnedFd,
}

impl<T> Inbox<T> {
    /// For `capacity` things that wait.
    pub(super) fn new(capacity: usize) -> io::Result<(Self, Outlet<T>)> {
        let wakeup = eventfd(0, EventfdFlags::NONBLOCK | EventfdFlags::CLOEXEC)?;
        let shared = Arc::new(Shared { queue: Mutex::default(), capacity, wakeup });
        Ok((Self(Arc::clone(&shared)), Outlet(shared)))
    }

    /// Acknowledges the wake-up; to be called before taking, or a later arrival may go unnoticed.
    pub(super) fn clear_wakeup(&self) {
        let mut count = [0; 8];
        // Nothing to read means that nothing woke the loop.
        let _wakeups = rustix::io::read(&self.0.wakeup, &mut count);
    }

    /// The oldest thing that waits.
    pub(super) fn take(&self) -> Option<T> {
        self.0.lock().pop_front()
    }
}

impl<T> Outlet<T> {
    /// Puts something in, and wakes the loop.
    pub(super) fn put(&self, thing: T) {
        let mut queue = self.0.lock();
        let forgotten = if queue.len() < self.0.capacity { None } else { queue.pop_front() };
        queue.push_back(thing);
        drop(queue);
        drop(forgotten);
        // It fails only where the descriptor is readable anyway.
        let _readable = rustix::io::write(&self.0.wakeup, &1_u64.to_ne_bytes());
    }
}

impl<T> Clone for Outlet<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Shared<T> {
    fn lock(&self) -> MutexGuard<'_, VecDeque<T>> {
        // A queue is whole between any two operations.
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> event::Source for Inbox<T> {
    fn register(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        SourceFd(&self.0.wakeup.as_raw_fd()).register(registry, token, interests)
    }

    fn reregister(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        SourceFd(&self.0.wakeup.as_raw_fd()).reregister(registry, token, interests)
    }

    fn deregister(&mut self, registry: &Registry) -> io::Result<()> {
        SourceFd(&self.0.wakeup.as_raw_fd()).deregister(registry)
    }
}

/// Lets a structure with an [`Inbox`] stand in the event loop in its place.
macro_rules! wakes_by {
    ($type:ty, $field:ident) => {
        impl rustdds::mio1::event::Source for $type {
            fn register(
                &mut self,
                registry: &rustdds::mio1::Registry,
                token: rustdds::mio1::Token,
                interests: rustdds::mio1::Interest,
            ) -> std::io::Result<()> {
                self.$field.register(registry, token, interests)
            }

            fn reregister(
                &mut self,
                registry: &rustdds::mio1::Registry,
                token: rustdds::mio1::Token,
                interests: rustdds::mio1::Interest,
            ) -> std::io::Result<()> {
                self.$field.reregister(registry, token, interests)
            }

            fn deregister(&mut self, registry: &rustdds::mio1::Registry) -> std::io::Result<()> {
                self.$field.deregister(registry)
            }
        }
    };
}
pub(super) use wakes_by;

#[cfg(test)]
mod tests {
    use super::*;
    use rustdds::mio1::{Events, Poll};
    use std::time::Duration;

    #[test]
    fn what_another_thread_puts_in_wakes_the_loop_once_cleared_again() {
        let (mut inbox, outlet) = Inbox::new(2).unwrap();
        let mut poll = Poll::new().unwrap();
        event::Source::register(&mut inbox, poll.registry(), Token(0), Interest::READABLE).unwrap();
        let mut events = Events::with_capacity(4);
        for round in 0..3 {
            let outlet = outlet.clone();
            std::thread::spawn(move || (0..5).for_each(|number| outlet.put(10 * round + number))).join().unwrap();
            poll.poll(&mut events, Some(Duration::from_secs(10))).unwrap();
            assert_eq!(events.iter().count(), 1);
            inbox.clear_wakeup();
            let taken: Vec<i32> = std::iter::from_fn(|| inbox.take()).collect();
            assert_eq!(taken, [10 * round + 3, 10 * round + 4], "the newest, in order");
        }
        poll.poll(&mut events, Some(Duration::ZERO)).unwrap();
        assert!(events.is_empty());
    }
}
