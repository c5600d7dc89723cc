//! Journals written and read back.

use crate::file::JournalFile;
use crate::queue::Queue;
use crate::record::Payload;
use crate::{End, Input, Journal, JournalReader, Journalled, Output, Pace, Parameter, Ports, Record, Start};
use std::path::Path;
use trench_config::{ConfigError, Origin, ParameterValue, Parameters};
use trench_core::{Event, Interface, Level, NodeCore, Outbox, RosTime, Sink, Source, Steady, Times};

fn start() -> Start {
    Start {
        version: "0".to_owned(),
        description: "echo".to_owned(),
        namespace: "/robot1".to_owned(),
        name: "echo".to_owned(),
        checkpoint: Some(vec![1, 2]),
        seed: 7,
        wall: 7,
        parameters: Vec::new(),
        files: Vec::new(),
        ports: Ports::default(),
        keeps_large: false,
    }
}

fn at(seconds: u64) -> Times {
    Times { ros: RosTime(-5), steady: Steady(seconds * 1_000_000_000) }
}

/// Publishes what it hears, wakes once a second, refuses `gain` below 0.
struct Echo {
    interface: Interface,
    next: Steady,
}

impl NodeCore for Echo {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        self.next = at.steady.plus_seconds(1.0);
        if let Event::Message { port, cdr, .. } = event {
            assert!(!cdr.is_empty(), "a core with a defect");
            sink.publish_with(port, cdr.len(), &mut |out| {
                out.copy_from_slice(cdr);
                cdr.len()
            });
            sink.log(Level::Info, "heard");
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        Some(self.next)
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        if parameters.f64("gain")? < 0.0 { Err(parameters.error("gain", "is negative", "")) } else { Ok(()) }
    }
}

/// A transport without room: it asks for no message.
struct Congested;

impl Sink for Congested {
    fn publish_with(&mut self, _: usize, _: usize, _: &mut dyn FnMut(&mut [u8]) -> usize) {}
    fn respond(&mut self, _: usize, _: trench_core::RequestId, _: &dyn trench_msgs::Encode) {}
    fn call(&mut self, _: usize, _: &dyn trench_msgs::Encode) {}
    fn write_bytes(&mut self, _: usize, _: &[u8]) {}
    fn log(&mut self, _: Level, _: &str) {}
    fn checkpoint(&mut self, _: &[u8]) {}
    fn exit(&mut self, _: u8) {}
}

fn echo(folder: &Path, pace: Pace) -> Journalled {
    let journal = Journal::create(folder, &start(), pace).unwrap();
    Journalled::new(Box::new(Echo { interface: Interface::default(), next: Steady(0) }), journal)
}

fn message(cdr: &[u8]) -> Event<'_> {
    Event::Message { port: 3, source: Source { gid: [9; 16], sequence: 4 }, cdr, arrived: None }
}

fn read(folder: &Path, name: &str) -> JournalReader {
    JournalReader::open(&folder.join(name)).unwrap()
}

#[test]
fn events_and_outputs_come_back_in_order() {
    for pace in [Pace::LockStep, Pace::RealTime] {
        let folder = tempfile::tempdir().unwrap();
        let mut core = echo(folder.path(), pace);
        let mut outbox = Outbox::default();
        core.handle(at(1), Event::Started, &mut outbox);
        core.handle(at(2), message(b"small"), &mut outbox);
        core.handle(at(2), message(&[7; 100_000]), &mut Congested);
        let mut parameters = Parameters::default();
        parameters.insert("gain", ParameterValue::Double(-0.1), Origin::new("a.yaml", 3));
        assert!(core.set_parameters(&parameters).is_err());
        drop(core);
        assert_eq!(outbox.actions.len(), 2, "the core's sink gets everything too");

        let journal = read(folder.path(), "robot1.echo.mcap");
        assert_eq!(*journal.start(), start());
        let steps: Vec<_> = journal.steps().map(|step| step.unwrap()).collect();
        assert_eq!(steps.iter().map(|step| step.at).collect::<Vec<_>>(), [at(1), at(2), at(2), at(2)]);
        let records: Vec<Vec<Record<'_>>> = steps.iter().map(|step| step.records().collect()).collect();
        let wakeup = |seconds: u64| Record::Output(Output::NextWakeup(Some(seconds * 1_000_000_000)));
        let heard = Record::Output(Output::Log { level: 20, text: "heard" });
        assert_eq!(records[0], [Record::Input(Input::Started), wakeup(2)]);
        let published = Record::Output(Output::Publish { port: 3, payload: Payload::Value(b"small") });
        let input = Record::Input(Input::of(message(b"small"), false));
        assert_eq!(records[1], [input, published, heard.clone(), wakeup(3)]);
        // What is large stands there by hash, also where the transport had no room for it.
        let payload = Payload::of(&[7; 100_000], false);
        assert!(matches!(payload, Payload::Reference { length: 100_000, .. }));
        assert_eq!(records[2][1..], [Record::Output(Output::Publish { port: 3, payload }), heard]);
        let value = ParameterValue::Double(-0.1);
        let changed = Parameter { name: "gain".to_owned(), value, file: "a.yaml".to_owned(), line: 3 };
        assert_eq!(records[3][0], Record::Input(Input::SetParameters(vec![changed])));
        let reason = "a.yaml:3: gain = -0.1: is negative";
        assert_eq!(records[3][1..], [Record::Output(Output::Refused(reason))]);
    }
}

#[test]
fn the_event_that_made_a_core_panic_is_the_last() {
    let folder = tempfile::tempdir().unwrap();
    let mut core = echo(folder.path(), Pace::RealTime);
    core.handle(at(1), Event::Started, &mut Congested);
    let panicked = std::thread::spawn(move || core.handle(at(2), message(b""), &mut Congested)).join();
    assert!(panicked.is_err());
    let journal = read(folder.path(), "robot1.echo.mcap");
    let last = journal.steps().last().unwrap().unwrap();
    assert_eq!(last.records().collect::<Vec<_>>(), [Record::Input(Input::of(message(b""), false))]);
}

#[test]
fn a_node_that_starts_again_begins_another_journal() {
    let folder = tempfile::tempdir().unwrap();
    drop(echo(folder.path(), Pace::LockStep));
    drop(echo(folder.path(), Pace::LockStep));
    assert_eq!(read(folder.path(), "robot1.echo.2.mcap").steps().count(), 0);
}

#[test]
fn what_the_disk_cannot_take_ends_the_journal_with_a_mark() {
    let folder = tempfile::tempdir().unwrap();
    let file = JournalFile::create(folder.path(), "slow", &start(), Pace::RealTime).unwrap();
    let mut queue = Queue::start(file, 1000).unwrap();
    let mut step = Vec::new();
    Record::Input(Input::Wakeup).append_to(&mut step);
    queue.push((at(1), step.clone())).unwrap();
    let problem = queue.push((at(2), vec![0; 2000])).unwrap_err();
    assert!(problem.contains("too slow"), "{problem}");
    queue.push((at(3), step)).expect("told once");
    drop(queue);
    let journal = read(folder.path(), "slow.mcap");
    let steps: Vec<_> = journal.steps().collect();
    assert_eq!(steps.len(), 2);
    let reason = &steps[1].as_ref().err().unwrap().reason;
    assert!(reason.contains("too slow for the journal"), "{reason}");
}

#[test]
fn bytes_that_are_no_records_end_quietly() {
    let mut step = Vec::new();
    for record in [
        Record::Input(Input::Response { client: 1, cdr: Some(b"abc") }),
        Record::Output(Output::Write { stream: 0, bytes: &[1, 2, 3] }),
        Record::Output(Output::NextWakeup(None)),
        Record::End(End::Clean),
    ] {
        record.append_to(&mut step);
    }
    assert_eq!(crate::Records::new(&step).count(), 4);
    for bit in 0..step.len() * 8 {
        let mut flipped = step.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(crate::Records::new(&flipped).count() <= flipped.len());
    }
    for length in 0..step.len() {
        assert!(crate::Records::new(&step[..length]).count() <= 4);
    }
}
