//! The mapper's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run(obstacle_mapper::description())
}
