//! The process of leader_assignment.

fn main() -> std::process::ExitCode {
    trench_runtime::run_alone(leader_assignment::description())
}
