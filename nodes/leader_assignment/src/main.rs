//! The process of leader_assignment.

fn main() -> std::process::ExitCode {
    trench_runtime::run(leader_assignment::description())
}
