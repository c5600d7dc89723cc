//! Byte streams: serial lines, pseudo-terminals and standard input, read and written without ever blocking.

mod keyboard;
mod line;
mod pseudo_terminal;
mod serial;
mod standard_input;

use keyboard::Keyboard;
use line::Line;
use pseudo_terminal::PseudoTerminal;
use rustdds::mio1::{Registry, Token};
use serial::Serial;
use std::io;
use trench_core::{ByteStream, Steady};

/// How often a serial device that is away is looked for.
const RETRY_SECONDS: f64 = 0.2;

/// One byte stream of a node.
pub(crate) struct Stream {
    kind: Kind,
    line: Option<Line>,
    token: Token,
    retry: Option<Steady>,
    last_problem: Option<String>,
}

enum Kind {
    Serial(Serial),
    PseudoTerminal(PseudoTerminal),
    Keyboard(Keyboard),
    StandardInput,
}

/// What a turn of the loop brought.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Bytes can be exchanged from now on.
    Opened,
    /// They no longer can, with the reason.
    Broke(String),
    /// It cannot be opened; said once a reason.
    Absent(String),
}

impl Stream {
    /// Describes a stream without opening it.
    pub(crate) fn new(stream: &ByteStream, token: Token) -> Self {
        let kind = match stream {
            ByteStream::Serial { path, baud } => Kind::Serial(Serial::new(path, *baud)),
            ByteStream::PseudoTerminal { link } => Kind::PseudoTerminal(PseudoTerminal::new(link)),
            ByteStream::Keyboard => Kind::Keyboard(Keyboard::default()),
            ByteStream::StandardInput => Kind::StandardInput,
        };
        Self { kind, line: None, token, retry: Some(Steady(0)), last_problem: None }
    }

    /// When [`Stream::open`] should be called again.
    pub(crate) fn next_retry(&self) -> Option<Steady> {
        self.retry
    }

    /// Tries to open the stream if it is time to.
    pub(crate) fn open(&mut self, now: Steady, registry: &Registry) -> Option<Change> {
        if self.line.is_some() || self.retry.is_none_or(|at| at > now) {
            return None;
        }
        let opened = match &mut self.kind {
            Kind::Serial(serial) => serial.open(),
            Kind::PseudoTerminal(terminal) => terminal.open(),
            Kind::Keyboard(keyboard) => keyboard.open(),
            Kind::StandardInput => standard_input::open(),
        };
        match opened.and_then(|descriptor| Line::new(descriptor, registry, self.token)) {
            Ok(line) => {
                self.line = Some(line);
                self.retry = None;
                self.last_problem = None;
                Some(Change::Opened)
            }
            Err(error) => {
                self.retry = Some(now.plus_seconds(RETRY_SECONDS));
                let problem = format!("cannot open {}: {error}", self.name());
                let news = self.last_problem.as_ref() != Some(&problem);
                self.last_problem = Some(problem.clone());
                news.then_some(Change::Absent(problem))
            }
        }
    }

    /// Reads what is there into `buffer`; 0 when there is nothing (more).
    pub(crate) fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.line.as_mut().map_or(Ok(0), |line| line.read(buffer))
    }

    /// Sends bytes, or keeps them until the line takes them. Bytes to a closed stream are lost.
    pub(crate) fn write(&mut self, bytes: &[u8], registry: &Registry) -> io::Result<()> {
        self.line.as_mut().map_or(Ok(()), |line| line.write(bytes, registry))
    }

    /// Sends what was kept, when the line is writable again.
    pub(crate) fn flush(&mut self, registry: &Registry) -> io::Result<()> {
        self.line.as_mut().map_or(Ok(()), |line| line.flush(registry))
    }

    /// Whether all bytes have left, as far as the line lets them.
    pub(crate) fn is_sent(&mut self, registry: &Registry) -> bool {
        // A line that breaks now has nothing left to wait for.
        self.line.as_mut().is_none_or(|line| line.flush(registry).is_err() || line.is_sent())
    }

    /// Closes after an error; to be opened again a little later.
    pub(crate) fn close(&mut self, now: Steady, reason: &io::Error, registry: &Registry) -> Option<Change> {
        let line = self.line.take()?;
        line.deregister(registry);
        self.retry = Some(now.plus_seconds(RETRY_SECONDS));
        Some(Change::Broke(format!("{} broke: {reason}", self.name())))
    }

    fn name(&self) -> &str {
        match &self.kind {
            Kind::Serial(serial) => serial.path(),
            Kind::PseudoTerminal(terminal) => terminal.link(),
            Kind::Keyboard(_) => keyboard::TERMINAL,
            Kind::StandardInput => standard_input::NAME,
        }
    }
}

#[cfg(test)]
mod tests;
