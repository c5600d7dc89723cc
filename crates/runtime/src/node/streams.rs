//! Bringing bytes to the core, and streams to life again.

use super::Node;
use crate::stream::Change;
use std::io;
use trench_core::{Event, Level, Sink, Steady};

/// Bytes read from a stream at once.
const CHUNK: usize = 4096;

impl Node {
    /// Opens what is closed and due.
    pub(super) fn open_streams(&mut self, now: Steady) {
        for stream in 0..self.ports.streams.len() {
            if let Some(change) = self.ports.streams[stream].open(now, &self.ports.registry) {
                self.stream_changed(stream, change);
            }
        }
    }

    pub(super) fn take_bytes(&mut self, stream: usize) {
        let mut buffer = [0; CHUNK];
        loop {
            let registry = &self.ports.registry;
            let line = &mut self.ports.streams[stream];
            match line.flush(registry).and_then(|()| line.read(&mut buffer)) {
                Ok(0) => return,
                Ok(count) => self.handle(Event::Bytes { stream, data: &buffer[..count] }),
                Err(error) => {
                    self.ports.broken.push((stream, error));
                    return self.close_broken_streams();
                }
            }
        }
    }

    pub(super) fn close_broken_streams(&mut self) {
        for (stream, error) in std::mem::take(&mut self.ports.broken) {
            self.close_stream(stream, &error);
        }
    }

    fn close_stream(&mut self, stream: usize, error: &io::Error) {
        let now = self.ports.clock.now().steady;
        if let Some(change) = self.ports.streams[stream].close(now, error, &self.ports.registry) {
            self.stream_changed(stream, change);
        }
    }

    fn stream_changed(&mut self, stream: usize, change: Change) {
        match change {
            Change::Opened => self.handle(Event::StreamState { stream, open: true }),
            Change::Broke(reason) => {
                self.ports.log(Level::Error, &reason);
                self.handle(Event::StreamState { stream, open: false });
            }
            Change::Absent(reason) => self.ports.log(Level::Error, &reason),
        }
    }
}
