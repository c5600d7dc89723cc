//! `trench ssl log` as people call it.

use std::process::Command;
use trench_ssl::{Seen, Team, VISION, packet_of};

#[test]
fn a_log_is_summed_up_and_damage_is_told() {
    let mut log = [&b"SSL_LOG_FILE"[..], &1_i32.to_be_bytes()].concat();
    for frame in 0..100_u32 {
        let team = if frame.is_multiple_of(2) { Team::Yellow } else { Team::Blue };
        let seen = Seen { id: frame % 6, x: 0.1, y: 0.2, theta: 0.3, confidence: 1.0 };
        let packet = packet_of(&[seen], team, frame, [0.0, 0.01]);
        log.extend((1_000_000_000 + 10_000_000 * i64::from(frame)).to_be_bytes());
        log.extend(VISION.to_be_bytes());
        log.extend((packet.len() as i32).to_be_bytes());
        log.extend(packet);
    }
    let folder = tempfile::tempdir().unwrap();
    let summed_up = |bytes: &[u8]| {
        let path = folder.path().join("game.log");
        std::fs::write(&path, bytes).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_trench")).args(["ssl", "log"]).arg(path).output().unwrap();
        (output.status.code(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
    };
    let expected = "100 records over 0.990 s\n100 frames of 1 cameras, 0 refused\nyellow {0, 2, 4}\nblue {1, 3, 5}\n";
    assert_eq!(summed_up(&log), (Some(0), expected.to_owned()));
    let (code, said) = summed_up(&log[..log.len() - 3]);
    assert!(code == Some(1) && said.starts_with("99 records") && said.contains("record 100 is cut off"), "{said}");
    let (code, said) = summed_up(b"PNG");
    assert!(code == Some(2) && said.contains("does not begin with SSL_LOG_FILE"), "{said}");
}
