//! The programs that launches start.

use std::path::{Path, PathBuf};

/// `cargo build --workspace --bins` makes them.
const PROGRAMS: [&str; 8] = [
    "bag_recorder",
    "formation_controller",
    "leader_assignment",
    "obstacle_mapper",
    "operator",
    "overhead_localizer",
    "rf_bridge",
    "testbed",
];

/// The program `trench`, beside which they all are.
pub(crate) fn trench() -> PathBuf {
    let trench = Path::new(env!("CARGO_BIN_EXE_trench"));
    for program in PROGRAMS {
        let path = trench.with_file_name(program);
        assert!(path.exists(), "{} is missing: run cargo build --workspace --bins", path.display());
    }
    trench.to_owned()
}
