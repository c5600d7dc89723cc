//! The test bed's process.

fn main() -> std::process::ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::World);
    trench_runtime::run_alone(testbed::description())
}
