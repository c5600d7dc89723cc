//! One transport a pair: the network rests while shared memory reaches every reader, goes on for those whom it does not
//! reach or no longer reaches, and always under the same count.

#[cfg(test)]
mod common;

use common::{Island, Running};
use rustix::process::{Pid, Resource, Rlimit, prlimit};

const RESTS: &str = "/chatter: the network rests, 1 reader(s) share memory";
const GOES_ON: &str = "/chatter: over the network too";

/// Slow enough for shared memory alone.
const TALKER: &str = "--ros-args --log-level debug -p rate:=40.0";

/// With what the names of shared memory of processes on an island begin.
fn prefix(island: &Island) -> String {
    let command = island.command("talker", "");
    let own = command.get_envs().find(|(name, _)| *name == "TRENCH_SHM_PREFIX").and_then(|(_, prefix)| prefix);
    own.unwrap_or_default().display().to_string()
}

/// Starts an example as if on another host: it has the network alone in common with the others.
fn start_apart(island: &Island, example: &str, arguments: &str) -> Running {
    let mut command = island.command(example, arguments);
    command.env("TRENCH_SHM_PREFIX", prefix(island) + "_apart");
    Island::run(command)
}

/// The count of the next message. The talker says the count too, so both ways must agree on it.
#[expect(clippy::unwrap_used, reason = "a test helper")]
fn next(listener: &Running) -> u64 {
    let line = listener.line();
    let (sequence, text) = line.split_once(' ').unwrap();
    assert_eq!(sequence, text, "the way it came changes nothing");
    text.parse().unwrap()
}

/// Reads until the message `last`, each once and in order.
fn read_to(listener: &Running, last: u64) {
    let mut before = next(listener);
    while before < last {
        let count = next(listener);
        assert_eq!(count, before + 1, "a message is missing or came twice");
        before = count;
    }
}

#[test]
fn the_network_rests_until_somebody_needs_it() {
    let island = Island::new(20);
    let listener = island.start("listener", "");
    let talker = island.start("talker", TALKER);
    talker.wait_for_log(RESTS);
    let reached = next(&listener);
    // Somebody comes whom shared memory does not reach, and goes again.
    let apart = start_apart(&island, "listener", "");
    talker.wait_for_log(GOES_ON);
    let first = next(&apart);
    assert!(first > reached, "a new reader of a topic that is not latched gets no past");
    read_to(&apart, first + 40);
    apart.signal("INT");
    assert_eq!(apart.end().0, 0);
    talker.wait_for_log(RESTS);
    let resumed = start_apart(&island, "listener", "");
    let last = next(&resumed);
    read_to(&listener, last);
}

#[test]
fn a_service_that_dies_under_its_writer_and_reader_loses_nothing() {
    let island = Island::new(21);
    let listener = island.start("listener", "");
    let talker = island.start("talker", TALKER);
    talker.wait_for_log(RESTS);
    let first = next(&listener);
    island.remove_shared_memory();
    read_to(&listener, first + 80);
    // A newcomer finds no service; the network has it all, under the same count.
    let late = island.start("listener", "");
    let last = next(&late) + 40;
    read_to(&late, last);
    read_to(&listener, last);
}

#[test]
fn a_reader_that_loses_shared_memory_goes_on_over_the_network() {
    let island = Island::new(22);
    let listener = island.start("listener", "--ros-args --log-level debug");
    let talker = island.start("talker", TALKER);
    talker.wait_for_log(RESTS);
    let first = 100;
    read_to(&listener, first);
    // No file may be opened any more: the memory of a second writer cannot be mapped, and the reader lets go of all.
    let none = Rlimit { current: Some(0), maximum: Some(4096) };
    let process = Pid::from_raw(i32::try_from(listener.child.id()).unwrap()).unwrap();
    prlimit(Some(process), Resource::Nofile, none).unwrap();
    let second = island.start("talker", "--ros-args -r __node:=second -p rate:=2.0");
    talker.wait_for_log(GOES_ON);
    let mut last = first;
    // Two writers count each for itself: the second is far behind.
    let mut of_second = 0;
    while last < first + 120 || of_second < 3 {
        let count = next(&listener);
        if count > last {
            assert_eq!(count, last + 1, "a message is missing");
            last = count;
        } else {
            assert!(of_second == 0 || count == of_second + 1, "a message came twice or is missing");
            of_second = count;
        }
    }
    drop(second);
}

#[test]
fn frames_go_over_the_network_on_demand() {
    let island = Island::new(23);
    let frames = "--ros-args --log-level debug -p rate:=10.0 -p padding:=100000 -p local:=shared_memory_only";
    let near = island.start("listener", "");
    let far = start_apart(&island, "listener", "");
    let private = island.start("talker", frames);
    read_to(&near, 20);
    private.signal("INT");
    let (_, _, said) = private.end();
    assert!(!said.iter().any(|line| line.contains("network")), "{said:?}");
    far.signal("INT");
    let (_, heard, _) = far.end();
    assert_eq!(heard, Vec::<String>::new(), "frames that nobody asked for");

    // With the parameter, a viewer that comes late gets them.
    let public = island.start("talker", &format!("{frames} -p publish_over_network:=[\"/chatter\"]"));
    let reached = loop {
        // What the first talker said last may still come.
        let count = next(&near);
        if count < 10 {
            break count;
        }
    };
    let viewer = start_apart(&island, "listener", "");
    let first = next(&viewer);
    assert!(first > reached, "a new reader of a topic that is not latched gets no past");
    read_to(&viewer, first + 5);
    read_to(&near, first + 5);
    drop(public);
}

/// How many writers are killed; scripts/acceptance takes 1000.
fn kills() -> usize {
    std::env::var("TRENCH_KILLS").ok().and_then(|kills| kills.parse().ok()).unwrap_or(20)
}

/// How many files of shared memory there are.
#[expect(clippy::unwrap_used, reason = "a test helper")]
fn shared_files(island: &Island) -> usize {
    let (prefix, files) = (prefix(island), std::fs::read_dir("/dev/shm").unwrap());
    files.filter(|file| file.as_ref().is_ok_and(|file| file.file_name().to_string_lossy().starts_with(&prefix))).count()
}

/// Files that this process has open, and the kilobytes of memory that are its own.
#[expect(clippy::unwrap_used, reason = "a test helper")]
fn holds(listener: &Running) -> (usize, usize) {
    let process = std::path::PathBuf::from(format!("/proc/{}", listener.child.id()));
    let status = std::fs::read_to_string(process.join("status")).unwrap();
    let anonymous = status.lines().find_map(|line| line.strip_prefix("RssAnon:")).unwrap();
    let kilobytes = anonymous.trim().trim_end_matches(" kB").parse().unwrap();
    (std::fs::read_dir(process.join("fd")).unwrap().count(), kilobytes)
}

#[test]
fn writers_that_are_killed_leave_nothing_behind() {
    let island = Island::new(24);
    let listener = island.start("listener", "");
    let mut first = None;
    for kill in 0..kills() {
        let talker = island.start("talker", "--ros-args --log-level debug -p rate:=100.0");
        talker.wait_for_log(RESTS);
        talker.signal("KILL");
        assert_eq!(talker.end().0, 137);
        if kill == 5 {
            first = Some((shared_files(&island), holds(&listener)));
        }
    }
    // Another one is heard as ever: none of those before came so far.
    let last = island.start("talker", "--ros-args -p rate:=100.0");
    while next(&listener) < 300 {}
    drop(last);
    let (files, (open, kilobytes)) = first.unwrap();
    let (files_now, (open_now, kilobytes_now)) = (shared_files(&island), holds(&listener));
    println!("files {files} to {files_now}, open {open} to {open_now}, own memory {kilobytes} to {kilobytes_now} kB");
    // The last one's remains are found by the next one.
    assert!(files_now <= files + 4 && open_now <= open + 4, "files {files} to {files_now}, open {open} to {open_now}");
    assert!(kilobytes_now < kilobytes + 10_000, "own memory {kilobytes} to {kilobytes_now} kB");
}
