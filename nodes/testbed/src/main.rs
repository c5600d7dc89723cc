//! The test bed's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run_alone(testbed::description())
}
