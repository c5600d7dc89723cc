//! Hulls, nearest points and assignments, measured and written out for the Python peers: `scripts/bench geometry`, or by itself
//! `cargo bench -p trench_formation --bench peers [-- FOLDER]`. With a folder, what was asked and answered goes there, so that the
//! peers get the same input and their results can be compared.
#![expect(clippy::print_stdout, reason = "the figures are the purpose")]

mod assignments;
mod files;
mod hulls;
mod nearest;
mod output;

use output::Output;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // cargo adds --bench.
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let mut output = Output::new(folder)?;
    hulls::measure(&mut output)?;
    nearest::measure(&mut output)?;
    assignments::measure(&mut output)?;
    output.finish()
}
