//! The localizer's process.

fn main() -> std::process::ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::Localizer);
    trench_runtime::run_alone(overhead_localizer::description())
}
