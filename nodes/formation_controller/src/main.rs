//! The controller's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run(formation_controller::description())
}
