//! The controller's process.

fn main() -> std::process::ExitCode {
    trench_runtime::wait_turn(trench_runtime::Turn::Controller);
    trench_runtime::run_alone(formation_controller::description())
}
