//! An open terminal line in the event loop.

use rustdds::mio1::unix::SourceFd;
use rustdds::mio1::{Interest, Registry, Token};
use rustix::io::Errno;
use std::collections::VecDeque;
use std::io;
use std::os::fd::{AsRawFd, OwnedFd};

/// Bytes kept while the line does not take them: more than five seconds of a 115200-baud line.
const KEPT: usize = 65_536;

/// An open descriptor and the bytes it has not yet taken.
pub(super) struct Line {
    descriptor: OwnedFd,
    token: Token,
    unsent: VecDeque<u8>,
}

impl Line {
    pub(super) fn new(descriptor: OwnedFd, registry: &Registry, token: Token) -> io::Result<Self> {
        registry.register(&mut SourceFd(&descriptor.as_raw_fd()), token, Interest::READABLE)?;
        Ok(Self { descriptor, token, unsent: VecDeque::new() })
    }

    /// 0 means "nothing now"; the end of the line is an error.
    pub(super) fn read(&self, buffer: &mut [u8]) -> io::Result<usize> {
        match rustix::io::read(&self.descriptor, buffer) {
            Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(count),
            Err(Errno::AGAIN | Errno::INTR) => Ok(0),
            Err(error) => Err(error.into()),
        }
    }

    /// What exceeds the kept bytes is lost, the newest first: a line that stands still is not made worse by a queue.
    pub(super) fn write(&mut self, bytes: &[u8], registry: &Registry) -> io::Result<()> {
        let room = KEPT - self.unsent.len().min(KEPT);
        let waiting = !self.unsent.is_empty();
        self.unsent.extend(&bytes[..bytes.len().min(room)]);
        if waiting { Ok(()) } else { self.flush(registry) }
    }

    pub(super) fn flush(&mut self, registry: &Registry) -> io::Result<()> {
        while !self.unsent.is_empty() {
            let (front, _) = self.unsent.as_slices();
            match rustix::io::write(&self.descriptor, front) {
                Ok(count) => drop(self.unsent.drain(..count)),
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN) => return self.listen(registry, Interest::READABLE | Interest::WRITABLE),
                Err(error) => return Err(error.into()),
            }
        }
        self.listen(registry, Interest::READABLE)
    }

    pub(super) fn is_sent(&self) -> bool {
        self.unsent.is_empty()
    }

    pub(super) fn deregister(self, registry: &Registry) {
        // A device that vanished may be gone from the loop already.
        let _gone = registry.deregister(&mut SourceFd(&self.descriptor.as_raw_fd()));
    }

    fn listen(&self, registry: &Registry, interest: Interest) -> io::Result<()> {
        registry.reregister(&mut SourceFd(&self.descriptor.as_raw_fd()), self.token, interest)
    }
}
