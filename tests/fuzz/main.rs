//! Parsers meet bytes that nobody meant: corpora of real files and frames, mutated at random, for a bounded time.
//!
//! `TRENCH_FUZZ_SECONDS` sets how long each target runs (2; scripts/acceptance takes longer), `TRENCH_FUZZ_SEED` where chance
//! begins (1). What made a target panic is left in `target/fuzz/<target>`, what ended the process in `<target>.trying`; inputs in
//! `tests/fuzz/found/<target>` are those that once did, and are tried first.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod corpus;
mod mutate;
mod seal;

use corpus::{root, texts};
use mutate::Mutator;
use std::collections::BTreeMap;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::time::{Duration, Instant};
use trench_bag::BagReader;
use trench_bag::run::RunBuilder;
use trench_config::params::{Source, resolve};
use trench_launch::Request;
use trench_msgs::dynamic::Schema;
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goals, LeaderState, LinkStatus, RunState, TeamState,
};
use trench_msgs::{Message, diagnostic_msgs, geometry_msgs, nav_msgs, sensor_msgs, visualization_msgs};
use trench_radio::{Key, LinkFrame, Packet, StreamDecoder};

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// A folder for inputs that are read from files: a disk would be most of an attempt.
fn in_memory() -> tempfile::TempDir {
    let memory = Path::new("/dev/shm");
    if memory.is_dir() { tempfile::tempdir_in(memory).unwrap() } else { tempfile::tempdir().unwrap() }
}

/// Runs `target` on what was found before, on the corpus, and on mutations of it until time is up.
fn fuzz(name: &str, corpus: &[Vec<u8>], target: impl FnMut(&[u8])) {
    fuzz_sealed(name, corpus, <[u8]>::to_vec, target);
}

/// As [`fuzz`]; every second mutation has its checksums made right by `seal`.
fn fuzz_sealed(name: &str, corpus: &[Vec<u8>], seal: fn(&[u8]) -> Vec<u8>, mut target: impl FnMut(&[u8])) {
    let folder = root().join("target/fuzz");
    std::fs::create_dir_all(&folder).unwrap();
    let (kept, trying) = (folder.join(name), folder.join(format!("{name}.trying")));
    // What ends the process at once, as memory that nobody has, is not caught below.
    let last = std::fs::File::create(&trying).unwrap();
    let mut attempt = |input: &[u8]| {
        last.set_len(input.len() as u64).unwrap();
        last.write_all_at(input, 0).unwrap();
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| target(input)));
        if let Err(panic) = outcome {
            std::fs::write(&kept, input).unwrap();
            eprintln!("{name}: the input is in {}", kept.display());
            std::panic::resume_unwind(panic);
        }
    };
    assert!(!corpus.is_empty(), "{name} has no corpus");
    let found = corpus::files(&root().join("tests/fuzz/found").join(name), "");
    found.iter().chain(corpus).for_each(|input| attempt(input));
    let end = Instant::now() + Duration::from_secs(setting("TRENCH_FUZZ_SECONDS", 2));
    let mut mutator = Mutator::new(setting("TRENCH_FUZZ_SEED", 1));
    let mut attempts = 0_u64;
    while Instant::now() < end {
        let mutated = mutator.mutate(corpus);
        if attempts.is_multiple_of(2) {
            attempt(&mutated)
        } else {
            attempt(&seal(&mutated))
        }
        attempts += 1;
    }
    // Another process with the same target may have.
    std::fs::remove_file(&trying).ok();
    println!("{name}: {attempts} inputs");
}

#[test]
fn fuzz_radio() {
    let key = Key::new(std::array::from_fn(|index| index as u8));
    let mut packets = 0_u64;
    fuzz_sealed("radio", &corpus::radio(), seal::radio, |bytes| {
        let mut decoder = StreamDecoder::default();
        decoder.push(bytes, |frame| {
            let (LinkFrame::Downlink { packet } | LinkFrame::Uplink { packet, .. }) = frame else { return };
            packets += 1;
            for key in [None, Some(&key)] {
                if let Ok(understood) = Packet::decode(packet, key) {
                    let mut again = Vec::new();
                    understood.encode(key, &mut again);
                    assert_eq!(Packet::decode(&again, key), Ok(understood));
                }
            }
        });
        // However the bytes come in pieces, the same frames come out.
        let mut whole = 0;
        StreamDecoder::default().push(bytes, |_| whole += 1);
        let (mut pieces, mut decoder) = (0, StreamDecoder::default());
        bytes.chunks(7).for_each(|piece| decoder.push(piece, |_| pieces += 1));
        assert_eq!(whole, pieces);
    });
    println!("radio: {packets} packets behind a checksum that was right");
}

/// What decodes is written and read as the same bytes.
fn round_trip<M: Message>(cdr: &[u8]) {
    if let Ok(message) = M::decode(cdr) {
        let written = message.to_cdr();
        let again = M::decode(&written).unwrap();
        assert_eq!(again.to_cdr(), written, "{}", M::TYPE.name);
    }
}

#[test]
fn fuzz_cdr() {
    let schemas: Vec<Schema> =
        trench_msgs::types().iter().filter_map(|info| Schema::parse(info.name, info.definition).ok()).collect();
    assert!(!schemas.is_empty());
    let mut turn = 0;
    fuzz("cdr", &corpus::messages(), |cdr| {
        round_trip::<TeamState>(cdr);
        round_trip::<LeaderState>(cdr);
        round_trip::<Goals>(cdr);
        round_trip::<Assignment>(cdr);
        round_trip::<Formation>(cdr);
        round_trip::<RunState>(cdr);
        round_trip::<LinkStatus>(cdr);
        round_trip::<ApparentObstacleArray>(cdr);
        round_trip::<diagnostic_msgs::DiagnosticArray>(cdr);
        round_trip::<geometry_msgs::TwistStamped>(cdr);
        round_trip::<nav_msgs::Odometry>(cdr);
        round_trip::<sensor_msgs::Image>(cdr);
        round_trip::<sensor_msgs::LaserScan>(cdr);
        round_trip::<visualization_msgs::MarkerArray>(cdr);
        turn = (turn + 1) % schemas.len();
        let _ = schemas[turn].decode(cdr);
    });
}

/// A value of an argument that a launch file asks for.
fn given(name: &str) -> &'static str {
    match name {
        "robots" => "[robot1, robot2]",
        "robot" => "robot1",
        "poses" => "[0.5, 0.5, 0.0, 1.0, 1.5, -0.25]",
        "profile" => "tuned",
        _ => "square",
    }
}

/// Among the others, so that what it includes is there, with whatever arguments it asks for.
#[test]
fn fuzz_launch() {
    let folder = in_memory();
    let beside = folder.path().join("launch");
    std::fs::create_dir(&beside).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("launch");
    for entry in std::fs::read_dir(root).unwrap().map(Result::unwrap) {
        std::fs::copy(entry.path(), beside.join(entry.file_name())).unwrap();
    }
    let file = beside.join("fuzz.launch.yaml");
    let environment: BTreeMap<String, String> = BTreeMap::new();
    let mut resolved = 0_u64;
    fuzz("launch", &texts("launch", ".launch.yaml"), |text| {
        std::fs::write(&file, text).unwrap();
        let asked = trench_launch::arguments(&file).unwrap_or_default();
        let needed = asked.into_iter().filter(|argument| argument.default.is_none());
        let arguments = needed.map(|argument| (argument.name.clone(), given(&argument.name).to_owned())).collect();
        let request = Request {
            file: &file,
            arguments: &arguments,
            environment: &environment,
            additions: &BTreeMap::new(),
            parameter_folder: Path::new("parameters"),
        };
        resolved += u64::from(trench_launch::resolve(&request).is_ok_and(|plan| !plan.processes.is_empty()));
    });
    assert!(resolved > 10, "{resolved} files became processes: what they include was not found");
}

#[test]
fn fuzz_configuration() {
    let mut corpus = texts("config", ".yaml");
    corpus.extend(texts("tests/launch", ".yaml"));
    let descriptors: Vec<_> = [formation_controller_parameters(), rf_bridge_parameters()].concat();
    fuzz("configuration", &corpus, |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let _ = resolve(&[Source::File { name: "f", text: &text }], "/robot1", "formation_controller", &descriptors);
        let _ = trench_plan::parse("f", &text);
        let _ = trench_optics::CameraInfo::parse("f", &text);
        let _ = trench_scenario::parse("f", &text);
        let line = text.lines().next().unwrap_or_default();
        let _ = resolve(&[Source::Override { node: None, name: "law", value: line }], "/", "n", &descriptors);
    });
}

fn formation_controller_parameters() -> Vec<trench_config::ParameterDescriptor> {
    trench_harness::catalog::node("formation_controller").map(|node| (node.parameters)()).unwrap_or_default()
}

fn rf_bridge_parameters() -> Vec<trench_config::ParameterDescriptor> {
    trench_harness::catalog::node("rf_bridge").map(|node| (node.parameters)()).unwrap_or_default()
}

#[test]
fn fuzz_mcap() {
    let folder = in_memory();
    let file = folder.path().join("fuzz.mcap");
    let corpus = [corpus::bags(), corpus::open_bags()].concat();
    let mut messages = 0_u64;
    fuzz_sealed("mcap", &corpus, seal::mcap, |bytes| {
        std::fs::write(&file, bytes).unwrap();
        let Ok(bag) = BagReader::open(&file) else { return };
        let mut run = RunBuilder::default();
        for message in bag.messages().flatten() {
            messages += 1;
            let topic = &bag.topics()[message.topic];
            run.take(&topic.name, &topic.type_name, &message);
        }
        let _ = run.finish();
    });
    println!("mcap: {messages} messages out of changed bags");
}
