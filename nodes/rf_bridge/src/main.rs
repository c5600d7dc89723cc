//! The bridge's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run_alone(rf_bridge::description())
}
