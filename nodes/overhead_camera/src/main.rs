//! The camera's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run(overhead_camera::description())
}
