//! The localizer's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run(overhead_localizer::description())
}
