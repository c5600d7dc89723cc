//! The player core, driven as a process drives it.

use crate::common::{Written, finished};
use std::path::Path;
use trench_bag::player;
use trench_config::{ConfigError, Origin, ParameterValue, Parameters};
use trench_core::{
    Action, Durability, Event, Files, NodeContext, NodeCore, Outbox, RequestId, RosTime, StartError, Steady, Times,
};
use trench_msgs::rosbag2_interfaces::{BurstRequest, BurstResponse, PlayNextResponse};
use trench_msgs::rosgraph_msgs::Clock;
use trench_msgs::{Encode, Message};

struct NoFiles;

impl Files for NoFiles {
    fn read(&self, _: &str, _: &str) -> Result<String, ConfigError> {
        unreachable!("the player reads no files by name")
    }
}

fn build(bag: &Path, set: &[(&'static str, ParameterValue)]) -> Result<Box<dyn NodeCore>, StartError> {
    let description = player::description();
    let mut parameters = Parameters::default();
    for descriptor in (description.parameters)() {
        parameters.insert(descriptor.name, descriptor.default, Origin::default());
    }
    parameters.insert("bag", ParameterValue::String(bag.to_string_lossy().into_owned()), Origin::default());
    for (name, value) in set {
        parameters.insert(*name, value.clone(), Origin::default());
    }
    (description.build)(&NodeContext::default(), &parameters, &NoFiles)
}

fn at(steady: Steady) -> Times {
    Times { ros: RosTime(0), steady }
}

/// A published message: when, on which publication, what.
type Played = (Steady, usize, Vec<u8>);

/// Plays to the end and gives what was published, and the exit code.
fn play(core: &mut dyn NodeCore, start: Steady) -> (Vec<Played>, u8) {
    let mut played = Vec::new();
    let mut sink = Outbox::default();
    let mut now = start;
    core.handle(at(now), Event::Started, &mut sink);
    for _ in 0..10_000 {
        for action in sink.take() {
            match action {
                Action::Publish { port, cdr } => played.push((now, port, cdr)),
                Action::Exit(code) => return (played, code),
                _ => {}
            }
        }
        now = now.max(core.next_wakeup().expect("it plays on"));
        core.handle(at(now), Event::Wakeup, &mut sink);
    }
    panic!("it does not end");
}

fn name(core: &dyn NodeCore, port: usize) -> String {
    core.interface().publications[port].topic.clone()
}

#[test]
fn everything_is_played_as_it_was_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let written = finished(&path, 200).unwrap();
    for rate in [1.0, 2.5] {
        let mut core = build(&path, &[("rate", ParameterValue::Double(rate))]).unwrap();
        let publications = core.interface().publications.iter();
        let mut types: Vec<_> = publications.map(|p| (p.type_info.name, p.qos.durability)).collect();
        types.sort_by_key(|&(name, _)| name);
        let latched = ("trench_test/msg/Nested", Durability::TransientLocal);
        assert_eq!(types, [("std_msgs/msg/Float64", Durability::Volatile), latched]);
        let start = Steady(5_000_000_000);
        let (played, code) = play(&mut *core, start);
        assert_eq!((played.len(), code), (written.len(), 0));
        for ((when, port, cdr), Written { topic, log_time, cdr: expected, .. }) in played.iter().zip(&written) {
            assert_eq!((&name(&*core, *port), cdr), (topic, expected));
            let due = (log_time - written[0].log_time) as f64 / rate;
            assert!((when.0 - start.0) as f64 - due < 1000.0, "spaced as recorded, to the microsecond");
        }
    }
}

#[test]
fn a_part_is_played_with_what_was_latched_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let written = finished(&path, 100).unwrap();
    let set = [("start_offset", ParameterValue::Double(0.5)), ("playback_duration", ParameterValue::Double(0.2))];
    let mut core = build(&path, &set).unwrap();
    let (played, _) = play(&mut *core, Steady(1));
    // Number 48 was the last latched one before number 50.
    let expected: Vec<_> = [&written[48]].into_iter().chain(&written[50..=70]).map(|m| m.cdr.clone()).collect();
    assert_eq!(played.into_iter().map(|(.., cdr)| cdr).collect::<Vec<_>>(), expected);
}

#[test]
fn topics_are_chosen_and_time_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let written = finished(&path, 100).unwrap();
    let exclude = ParameterValue::StringArray(vec!["/value".to_owned()]);
    let set = [("exclude_topics", exclude), ("clock", ParameterValue::Double(100.0))];
    let mut core = build(&path, &set).unwrap();
    let (played, _) = play(&mut *core, Steady(1));
    let (clock, others): (Vec<_>, Vec<_>) = played.iter().partition(|(_, port, _)| name(&*core, *port) == "/clock");
    assert!(others.iter().all(|(_, port, _)| name(&*core, *port) == "/robot1/nested") && others.len() == 34);
    let times: Vec<i64> = clock.iter().map(|(.., cdr)| RosTime::from(&Clock::decode(cdr).unwrap().clock).0).collect();
    assert_eq!(times[0], written[0].log_time as i64);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && times.len() >= 98, "{}", times.len());
    let nothing = [("regex", ParameterValue::String("^/nothing".to_owned()))];
    let error = build(&path, &nothing).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("holds no message of the topics"), "{error}");
}

#[test]
fn a_pause_is_stepped_through_and_ended_by_key_and_service() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    finished(&path, 100).unwrap();
    let mut core = build(&path, &[("start_paused", ParameterValue::Bool(true))]).unwrap();
    let mut sink = Outbox::default();
    core.handle(at(Steady(1)), Event::Started, &mut sink);
    assert_eq!(core.next_wakeup(), None, "nothing is due while paused");
    let service = |end: &str| core.interface().services.iter().position(|s| s.name.ends_with(end)).unwrap();
    let (next, burst, resume) = (service("play_next"), service("burst"), service("resume"));
    let mut ask = |service: usize, cdr: &[u8]| {
        sink.take();
        core.handle(at(Steady(9)), Event::Request { service, id: RequestId(1), cdr }, &mut sink);
        let published = sink.actions.iter().filter(|action| matches!(action, Action::Publish { .. })).count();
        let response = sink.actions.iter().find_map(|action| match action {
            Action::Respond { cdr, .. } => Some(cdr.clone()),
            _ => None,
        });
        (published, response.unwrap())
    };
    let (published, response) = ask(next, &[]);
    assert!(published == 1 && PlayNextResponse::decode(&response).unwrap().success);
    let (published, response) = ask(burst, &BurstRequest { num_messages: 5 }.to_cdr());
    assert_eq!((published, BurstResponse::decode(&response).unwrap().actually_burst), (5, 5));
    let (published, response) = ask(burst, &BurstRequest { num_messages: u64::MAX }.to_cdr());
    assert_eq!((published, BurstResponse::decode(&response).unwrap().actually_burst), (94, 94));
    let _ = ask(resume, &[]);

    let mut core = build(&path, &[("keyboard", ParameterValue::Bool(true))]).unwrap();
    let mut sink = Outbox::default();
    core.handle(at(Steady(1)), Event::Started, &mut sink);
    core.handle(at(Steady(2)), Event::Bytes { stream: 0, data: b" " }, &mut sink);
    assert_eq!(core.next_wakeup(), None);
    core.handle(at(Steady(3)), Event::Bytes { stream: 0, data: b"\x1b[C" }, &mut sink);
    assert_eq!(sink.actions.iter().filter(|action| matches!(action, Action::Publish { .. })).count(), 1);
    core.handle(at(Steady(4)), Event::Bytes { stream: 0, data: b" " }, &mut sink);
    assert!(core.next_wakeup().is_some());
}
