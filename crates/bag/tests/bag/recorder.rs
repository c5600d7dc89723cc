//! The recorder core, driven as a process drives it.

use std::collections::BTreeMap;
use trench_bag::{BagReader, recorder};
use trench_config::{ConfigError, Origin, ParameterValue, Parameters};
use trench_core::arguments::process_parameters;
use trench_core::{Action, Event, Files, NodeContext, NodeCore, Outbox, RosTime, Source, StartError, Steady, Times};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::RunState;
use trench_msgs::{Encode, std_msgs};

struct NoFiles;

impl Files for NoFiles {
    fn read(&self, _: &str, _: &str) -> Result<String, ConfigError> {
        unreachable!("the recorder reads no files")
    }
}

fn build(output: &str, topics: &[&str]) -> Result<Box<dyn NodeCore>, StartError> {
    let description = recorder::description();
    let mut parameters = Parameters::default();
    for descriptor in (description.parameters)().into_iter().chain(process_parameters()) {
        parameters.insert(descriptor.name, descriptor.default, Origin::default());
    }
    parameters.insert("output", ParameterValue::String(output.to_owned()), Origin::default());
    let topics = topics.iter().map(|&topic| topic.to_owned()).collect();
    parameters.insert("topics", ParameterValue::StringArray(topics), Origin::default());
    let context = NodeContext { namespace: "/".to_owned(), name: "recorder".to_owned(), ..NodeContext::default() };
    (description.build)(&context, &parameters, &NoFiles)
}

fn at(milliseconds: u64) -> Times {
    let nanoseconds = milliseconds * 1_000_000;
    Times { ros: RosTime(1_000_000_000 + nanoseconds as i64), steady: Steady(nanoseconds) }
}

#[test]
fn what_is_heard_is_in_the_bag() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("heard");
    let mut core = build(path.to_str().unwrap(), &["/run_state", "/stop:std_msgs/msg/Bool", "/goals"]).unwrap();
    let mut sink = Outbox::default();
    core.handle(at(0), Event::Started, &mut sink);
    let state = RunState { reason: "test".to_owned(), ..RunState::default() }.to_cdr();
    let stop = std_msgs::Bool { data: true }.to_cdr();
    let source = |sequence| Source { gid: [1; 16], sequence };
    core.handle(at(5), Event::Message { port: 0, source: source(1), cdr: &state, arrived: None }, &mut sink);
    // Handed over late, by a recorder that need not wake for it.
    let arrived = Some(at(3).steady);
    core.handle(at(10), Event::Message { port: 1, source: source(41), cdr: &stop, arrived }, &mut sink);
    core.handle(at(50), Event::Wakeup, &mut sink);
    // The open chunk is closed by time alone.
    std::thread::sleep(std::time::Duration::from_millis(600));
    core.handle(at(700), Event::Wakeup, &mut sink);
    assert_eq!(BagReader::open(&path).unwrap().message_count(), 2, "a killed recorder loses no more than a second");
    core.handle(at(800), Event::Shutdown, &mut sink);
    assert!(!sink.actions.iter().any(|action| matches!(action, Action::Exit(_))), "{:?}", sink.actions);
    let bag = BagReader::open(&path).unwrap();
    assert_eq!(bag.damage(), []);
    let read: Vec<_> = bag.messages().map(Result::unwrap).collect();
    let found: BTreeMap<_, _> = read.iter().map(|m| (bag.topics()[m.topic].name.as_str(), m)).collect();
    assert_eq!(found.len(), 2, "a topic that was never heard is not in the bag");
    assert_eq!(&found["/run_state"][..], state);
    assert_eq!((found["/stop"].log_time, found["/stop"].sequence), (1_003_000_000, 41));
    assert_eq!(found["/run_state"].log_time, 1_005_000_000);
    assert!(read.is_sorted_by_key(|message| message.log_time));
}

#[test]
fn a_recording_that_cannot_go_on_is_told_with_its_bag_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gone");
    let mut core = build(path.to_str().unwrap(), &["/goals"]).unwrap();
    let mut sink = Outbox::default();
    core.handle(at(0), Event::Started, &mut sink);
    core.handle(at(50), Event::Wakeup, &mut sink);
    assert!(sink.published::<DiagnosticArray>(0).is_empty(), "while all is well it says nothing");
    std::fs::remove_dir_all(&path).unwrap();
    core.handle(at(100), Event::Wakeup, &mut sink);
    let told = sink.published::<DiagnosticArray>(0).pop().unwrap().status.pop().unwrap();
    assert_eq!((told.level, told.name.as_str()), (2, "/recorder: recording"));
    assert!(told.message.starts_with(&format!("{}: ", path.display())), "{}", told.message);
    assert!(sink.actions.iter().any(|action| matches!(action, Action::Exit(1))), "{:?}", sink.actions);
}

#[test]
fn wrong_parameters_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let taken = folder.path().to_str().unwrap().to_owned();
    let check = |output: &str, topics: &[&str], expected: &str| {
        let error = build(output, topics).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{error:?} does not say {expected:?}");
    };
    check("", &[], "name the new bag's folder");
    check(&taken, &["/goals"], "exists already");
    check(&format!("{taken}/new"), &["/unknown:no/msg/Type"], "no message type of this stack");
    assert!(!folder.path().join("new").exists(), "nothing is left behind");
}
