//! The operator's process.

fn main() -> std::process::ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::Watcher);
    trench_runtime::run(operator::description())
}
