//! What may depend on what (architecture invariant 5), and that cores are pure (invariant 1).
//!
//! Nothing of the project is run: `dependencies` asks Cargo, `purity` reads the sources.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helper functions too")]

mod dependencies;
mod purity;
mod source;

/// The pure libraries: their folders, whose names Cargo knows with the prefix `trench_`.
const PURE_CRATES: [&str; 10] =
    ["check", "config", "core", "expression", "formation", "optics", "plan", "radio", "scenario", "sim"];
