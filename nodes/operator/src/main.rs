//! The operator's process.

fn main() -> std::process::ExitCode {
    trench_runtime::run(operator::description())
}
