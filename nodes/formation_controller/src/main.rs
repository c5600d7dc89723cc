//! The controller's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run_alone(formation_controller::description())
}
