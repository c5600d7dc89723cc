//! Damaged journals: no panic, no hang, and never "equal" for less than the whole.

use super::{check, golden, journals};
use std::fs;
use std::path::Path;
use trench_harness::replay::{Report, Verdict, replay};
use trench_journal::{Journal, JournalReader};
use trench_sim::Random;

fn events(path: &Path) -> u64 {
    replay(&JournalReader::open(path).unwrap()).unwrap().events
}

/// What damage may lead to: an error, a stop that is told, or everything, where the damage is in what repeats.
fn assert_honest(path: &Path, whole: u64, what: &str) -> bool {
    let Ok(journal) = JournalReader::open(path) else { return true };
    match replay(&journal).unwrap() {
        Report { verdict: Verdict::Equal, events, .. } => {
            assert_eq!(events, whole, "{what}: equal, but not all of it");
            false
        }
        Report { verdict: Verdict::NotReplayable { reason, .. }, .. } => {
            assert!(!reason.is_empty(), "{what}");
            true
        }
        Report { verdict: Verdict::Differs(first), .. } => {
            panic!("{what}: altered bytes passed off as intact: {first}")
        }
    }
}

#[test]
fn bit_flips_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flipped.mcap");
    let mut random = Random::new(1, 5);
    for name in ["obstacle_mapper.mcap", "rf_bridge.mcap"] {
        let original = golden("triangle").join(name);
        let (intact, whole) = (fs::read(&original).unwrap(), events(&original));
        let mut told = 0;
        for _ in 0..300 {
            let mut bytes = intact.clone();
            let bit = random.between(0.0, bytes.len() as f64 * 8.0) as usize;
            bytes[bit / 8] ^= 1 << (bit % 8);
            fs::write(&path, bytes).unwrap();
            told += u32::from(assert_honest(&path, whole, &format!("{name}: bit {bit}")));
        }
        assert!(told > 150, "{name}: {told} of 300");
    }
}

#[test]
fn truncations_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.mcap");
    let original = golden("triangle").join("obstacle_mapper.mcap");
    let (intact, whole) = (fs::read(&original).unwrap(), events(&original));
    for length in (0..intact.len()).step_by(13) {
        fs::write(&path, &intact[..length]).unwrap();
        assert_honest(&path, whole, &format!("{length} bytes"));
    }
    fs::write(&path, &intact[..intact.len() / 2]).unwrap();
    let (code, said) = check(&[], &path);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("is lost") || said.contains("was killed"), "{said}");
}

#[test]
fn a_sound_container_with_senseless_steps_does_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("senseless.mcap");
    let mut random = Random::new(2, 5);
    for original in journals(&golden("triangle")) {
        let journal = JournalReader::open(&original).unwrap();
        let mut written = Journal::replace(&path, journal.start()).unwrap();
        for step in journal.steps() {
            let step = step.unwrap();
            let records = step.records();
            let mut bytes = step.with_outputs(&records, records.rest());
            for _ in 0..2 {
                let bit = random.between(0.0, bytes.len() as f64 * 8.0) as usize;
                bytes[bit / 8] ^= 1 << (bit % 8);
            }
            written.append(step.at, bytes).unwrap();
        }
        written.finish().unwrap();
        let report = replay(&JournalReader::open(&path).unwrap()).unwrap();
        assert_ne!(report.verdict, Verdict::Equal, "{}", original.display());
    }
}
