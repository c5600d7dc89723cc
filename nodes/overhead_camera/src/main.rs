//! The camera's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run_without_journal(overhead_camera::description())
}
