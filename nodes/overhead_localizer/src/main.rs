//! The localizer's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run_alone(overhead_localizer::description())
}
