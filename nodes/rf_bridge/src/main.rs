//! The bridge's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run(rf_bridge::description())
}
