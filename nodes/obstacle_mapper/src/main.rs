//! The mapper's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run_alone(obstacle_mapper::description())
}
