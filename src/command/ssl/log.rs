//! `trench ssl log`

use super::super::say;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;
use std::process::ExitCode;
use trench_ssl::{LogError, LogReader, Team, VISION, frame_of};

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The log, unpacked (.log).
    file: PathBuf,
}

/// What a log holds.
#[derive(Default)]
struct Summary {
    records: u64,
    frames: u64,
    refused: u64,
    cameras: BTreeSet<u32>,
    robots: [BTreeSet<u32>; 2],
    first: Option<i64>,
    last: i64,
}

pub(super) fn run(arguments: &Arguments) -> ExitCode {
    let path = arguments.file.display();
    let opened =
        File::open(&arguments.file).map_err(LogError::Io).and_then(|file| LogReader::new(BufReader::new(file)));
    let reader = match opened {
        Ok(reader) => reader,
        Err(error) => {
            eprintln!("trench ssl log: {path}: {error}");
            return ExitCode::from(2);
        }
    };
    let mut summary = Summary::default();
    let mut damage = None;
    for record in reader {
        match record {
            Ok(record) => summary.take(record.heard, record.kind, &record.bytes),
            Err(error) => damage = Some(error),
        }
    }
    say(&summary);
    match damage {
        Some(error) => {
            eprintln!("trench ssl log: {path}: {error}");
            ExitCode::FAILURE
        }
        None => ExitCode::SUCCESS,
    }
}

impl Summary {
    fn take(&mut self, heard: i64, kind: i32, bytes: &[u8]) {
        self.records += 1;
        self.first.get_or_insert(heard);
        self.last = heard;
        if kind != VISION {
            return;
        }
        for (team, robots) in [Team::Yellow, Team::Blue].into_iter().zip(&mut self.robots) {
            match frame_of(bytes, team) {
                Ok(Some((frame, seen))) => {
                    self.frames += u64::from(team == Team::Yellow);
                    self.cameras.insert(frame.camera_id);
                    robots.extend(seen.iter().map(|robot| robot.id));
                }
                Ok(None) => {}
                Err(_) => self.refused += u64::from(team == Team::Yellow),
            }
        }
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let seconds = 1e-9 * (self.last - self.first.unwrap_or(self.last)) as f64;
        writeln!(formatter, "{} records over {seconds:.3} s", self.records)?;
        writeln!(formatter, "{} frames of {} cameras, {} refused", self.frames, self.cameras.len(), self.refused)?;
        writeln!(formatter, "yellow {:?}", self.robots[0])?;
        writeln!(formatter, "blue {:?}", self.robots[1])
    }
}
