//! A Zenoh router for the tests: prints where it listens.

use std::process::ExitCode;

fn main() -> ExitCode {
    let ready = |_: &str, locators: &[String]| println!("{}", locators.join(" "));
    match trench_runtime::route(ready) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
