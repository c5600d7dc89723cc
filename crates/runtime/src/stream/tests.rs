use super::*;
use rustdds::mio1::{Events, Poll};
use std::path::PathBuf;
use std::time::Duration;

struct Bench {
    poll: Poll,
    folder: PathBuf,
    terminal: Stream,
    serial: Stream,
}

impl Bench {
    /// A pseudo-terminal, open, and a serial stream on its link, not yet open.
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("trench-stream-{test}-{}", std::process::id()));
        let link = folder.join("radio").display().to_string();
        let terminal = Stream::new(&ByteStream::PseudoTerminal { link: link.clone() }, Token(1));
        let serial = Stream::new(&ByteStream::Serial { path: link, baud: 115_200 }, Token(2));
        Self { poll: Poll::new().unwrap(), folder, terminal, serial }
    }

    fn open_both(&mut self) {
        assert_eq!(self.terminal.open(Steady(0), self.poll.registry()), Some(Change::Opened));
        assert_eq!(self.serial.open(Steady(0), self.poll.registry()), Some(Change::Opened));
    }

    fn wait_for(&mut self, token: Token) {
        let mut events = Events::with_capacity(4);
        self.poll.poll(&mut events, Some(Duration::from_secs(5))).unwrap();
        assert!(events.iter().any(|event| event.token() == token));
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _already_gone = std::fs::remove_dir_all(&self.folder);
    }
}

fn read_all(stream: &mut Stream) -> Vec<u8> {
    let mut buffer = [0; 512];
    let mut bytes = Vec::new();
    while let count @ 1.. = stream.read(&mut buffer).unwrap() {
        bytes.extend_from_slice(&buffer[..count]);
    }
    bytes
}

#[test]
fn every_byte_value_passes_both_ways_unchanged() {
    let mut bench = Bench::new("raw");
    bench.open_both();
    let bytes: Vec<u8> = (0..=255).collect();
    bench.serial.write(&bytes, bench.poll.registry()).unwrap();
    bench.wait_for(Token(1));
    assert_eq!(read_all(&mut bench.terminal), bytes);
    bench.terminal.write(&bytes, bench.poll.registry()).unwrap();
    bench.wait_for(Token(2));
    assert_eq!(read_all(&mut bench.serial), bytes);
}

#[test]
fn a_line_that_nobody_reads_keeps_its_bytes_and_does_not_block() {
    let mut bench = Bench::new("full");
    bench.open_both();
    let bytes: Vec<u8> = (0..40_000_u32).map(|number| number as u8).collect();
    bench.serial.write(&bytes, bench.poll.registry()).unwrap();
    assert!(!bench.serial.is_sent(bench.poll.registry()), "more than the kernel takes");
    let mut received = Vec::new();
    while received.len() < bytes.len() {
        bench.wait_for(Token(1));
        received.extend(read_all(&mut bench.terminal));
        bench.serial.flush(bench.poll.registry()).unwrap();
    }
    assert_eq!(received, bytes);
}

#[test]
fn a_device_that_vanishes_is_reopened_when_it_returns() {
    let mut bench = Bench::new("vanish");
    bench.open_both();
    let link = bench.folder.join("radio").display().to_string();
    bench.terminal = Stream::new(&ByteStream::PseudoTerminal { link }, Token(1));
    assert!(!bench.folder.join("radio").exists(), "the link goes with its terminal");
    bench.wait_for(Token(2));
    let error = bench.serial.read(&mut [0; 8]).unwrap_err();
    let broke = bench.serial.close(Steady(0), &error, bench.poll.registry());
    assert!(matches!(broke, Some(Change::Broke(_))), "{broke:?}");

    let (early, later) = (Steady(1), bench.serial.next_retry().unwrap());
    assert_eq!(later.seconds_since(Steady(0)), RETRY_SECONDS);
    assert_eq!(bench.serial.open(early, bench.poll.registry()), None);
    let absent = bench.serial.open(later, bench.poll.registry());
    assert!(matches!(absent, Some(Change::Absent(_))), "{absent:?}");
    let again = bench.serial.next_retry().unwrap();
    assert_eq!(bench.serial.open(again, bench.poll.registry()), None, "an absence is told once");

    assert_eq!(bench.terminal.open(Steady(0), bench.poll.registry()), Some(Change::Opened));
    let back = bench.serial.next_retry().unwrap();
    assert_eq!(bench.serial.open(back, bench.poll.registry()), Some(Change::Opened));
    bench.terminal.write(b"hello", bench.poll.registry()).unwrap();
    bench.wait_for(Token(2));
    assert_eq!(read_all(&mut bench.serial), b"hello");
}

#[test]
fn a_serial_port_belongs_to_one_process_and_must_be_one() {
    let mut bench = Bench::new("lock");
    bench.open_both();
    let check = |path: PathBuf, expected: &str| {
        let mut second = Stream::new(&ByteStream::Serial { path: path.display().to_string(), baud: 9600 }, Token(3));
        let Some(Change::Absent(reason)) = second.open(Steady(0), bench.poll.registry()) else { panic!("opened") };
        assert!(reason.contains(expected), "{reason}");
    };
    check(bench.folder.join("radio"), "another process uses it; stop that one first");
    let file = bench.folder.join("file");
    std::fs::write(&file, "").unwrap();
    check(file, "not a serial device");
}

#[test]
fn a_terminal_does_not_replace_a_file() {
    let bench = Bench::new("file");
    std::fs::create_dir_all(&bench.folder).unwrap();
    let file = bench.folder.join("file");
    std::fs::write(&file, "precious").unwrap();
    let mut terminal = Stream::new(&ByteStream::PseudoTerminal { link: file.display().to_string() }, Token(1));
    let refused = terminal.open(Steady(0), bench.poll.registry());
    assert!(matches!(&refused, Some(Change::Absent(reason)) if reason.contains("is no link")), "{refused:?}");
    drop(terminal);
    assert_eq!(std::fs::read_to_string(file).unwrap(), "precious");
}
