//! The bridge's process.

fn main() -> std::process::ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::Bridge);
    trench_runtime::run_alone(rf_bridge::description())
}
